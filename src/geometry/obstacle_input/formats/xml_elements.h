// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace arris {

/// White space that XML lets stand around a number.
inline constexpr std::string_view kXmlSpace = " \t\r\n";

/// A name and the URI of its namespace (empty: none).
struct XmlName {
    std::string_view space;
    std::string_view local;
};

struct XmlElement {
    XmlName name;
    std::vector<std::pair<XmlName, std::string_view>> attributes;
    unsigned long line = 0;  ///< of its beginning, counted from 1

    /// The value of an attribute; `space` is empty for an attribute without a prefix.
    std::optional<std::string_view> find(std::string_view local, std::string_view space = {}) const;
};

/// Functions to be called for an XML document, in its order. They may throw.
struct XmlVisitor {
    std::function<void(const XmlElement&)> begin;
    std::function<void(const XmlName&)> end = [](const XmlName&) {};
    /// A piece of the text in an element; pieces may end inside a word.
    std::function<void(std::string_view)> text = [](std::string_view) {};
    /// A prefix and the URI that it stands for; called before the element that declares it.
    std::function<void(std::string_view, std::string_view)> declare = [](std::string_view, std::string_view) {
    };
};

/// Walks through a document. Throws InputError, without the document's name, if it is not well formed.
void visit_xml(std::string_view text, const XmlVisitor& visitor);

}  // namespace arris
