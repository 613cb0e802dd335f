// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/obj_numbers.h"

#include <algorithm>

namespace arris {

std::string spell_out_numbers(std::string_view obj)
{
    constexpr std::string_view kBlank = " \t\r\v\f";
    std::string text;
    text.reserve(obj.size());
    bool is_of_vertex = false, is_continued = false;
    while (!obj.empty()) {
        const std::string_view line = obj.substr(0, std::min(obj.find('\n'), obj.size() - 1) + 1);
        obj.remove_prefix(line.size());
        const std::size_t first = line.find_first_not_of(kBlank);
        if (!is_continued) is_of_vertex = first != std::string_view::npos && line[first] == 'v';
        const std::size_t comment = std::min(line.find('#'), line.size());
        for (std::size_t i = 0; i < line.size(); ++i) {
            const bool begins_word = i == 0 || kBlank.find(line[i - 1]) != std::string_view::npos;
            if (is_of_vertex && i < comment && line[i] == '.' && begins_word) text += '0';
            text += line[i];
        }
        const std::size_t last = line.find_last_not_of("\r\n");
        is_continued = last != std::string_view::npos && line[last] == '\\';
    }
    return text;
}

}  // namespace arris
