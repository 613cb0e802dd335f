// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/report/page_template.h"

#include <cassert>

namespace arris {

std::string fill_template(std::string_view page, const std::map<std::string_view, std::string>& parts)
{
    std::string filled;
    for (;;) {
        const std::size_t open = page.find("{{");
        filled += page.substr(0, open);
        if (open == std::string_view::npos) return filled;
        const std::size_t close = page.find("}}", open);
        assert(close != std::string_view::npos && "the page has an unclosed {{");
        const auto part = parts.find(page.substr(open + 2, close - open - 2));
        assert(part != parts.end() && "the page names a part that is not made");
        filled += part->second;
        page.remove_prefix(close + 2);
    }
}

}  // namespace arris
