// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/formats/xml_elements.h"

#include <expat.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <new>

#include "geometry/input_error.h"

namespace arris {
namespace {

constexpr XML_Char kSeparator = '|';  // between a namespace and a name; no name has one
constexpr std::size_t kBlock = std::size_t{1} << 24;

struct Walk {
    const XmlVisitor& visitor;
    XML_Parser parser = nullptr;
    XmlElement element;
    std::exception_ptr error;
};

XmlName split(std::string_view name)
{
    const std::size_t at = name.rfind(kSeparator);
    if (at == std::string_view::npos) return {{}, name};
    return {name.substr(0, at), name.substr(at + 1)};
}

// Exceptions must not pass through the parser, which is written in C.
template <class Action>
void guarded(Walk& walk, Action action)
{
    if (walk.error) return;
    try {
        action();
    } catch (...) {
        walk.error = std::current_exception();
        XML_StopParser(walk.parser, XML_FALSE);
    }
}

void XMLCALL on_begin(void* data, const XML_Char* name, const XML_Char** attributes)
{
    Walk& walk = *static_cast<Walk*>(data);
    guarded(walk, [&] {
        walk.element.name = split(name);
        walk.element.attributes.clear();
        walk.element.line = XML_GetCurrentLineNumber(walk.parser);
        for (; attributes[0] != nullptr; attributes += 2)
            walk.element.attributes.emplace_back(split(attributes[0]), attributes[1]);
        walk.visitor.begin(walk.element);
    });
}

void XMLCALL on_end(void* data, const XML_Char* name)
{
    Walk& walk = *static_cast<Walk*>(data);
    guarded(walk, [&] { walk.visitor.end(split(name)); });
}

void XMLCALL on_text(void* data, const XML_Char* text, int length)
{
    Walk& walk = *static_cast<Walk*>(data);
    guarded(walk, [&] { walk.visitor.text({text, static_cast<std::size_t>(length)}); });
}

void XMLCALL on_declare(void* data, const XML_Char* prefix, const XML_Char* uri)
{
    Walk& walk = *static_cast<Walk*>(data);
    guarded(walk, [&] { walk.visitor.declare(prefix == nullptr ? "" : prefix, uri == nullptr ? "" : uri); });
}

}  // namespace

std::optional<std::string_view> XmlElement::find(std::string_view local, std::string_view space) const
{
    for (const auto& [attribute, value] : attributes)
        if (attribute.local == local && attribute.space == space) return value;
    return std::nullopt;
}

void visit_xml(std::string_view text, const XmlVisitor& visitor)
{
    const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(
        XML_ParserCreateNS(nullptr, kSeparator), XML_ParserFree);
    if (parser == nullptr) throw std::bad_alloc();
    Walk walk{visitor, parser.get(), {}, {}};
    XML_SetUserData(parser.get(), &walk);
    XML_SetElementHandler(parser.get(), on_begin, on_end);
    XML_SetCharacterDataHandler(parser.get(), on_text);
    XML_SetStartNamespaceDeclHandler(parser.get(), on_declare);
    for (bool is_last = false; !is_last;) {
        const std::string_view block = text.substr(0, kBlock);
        text.remove_prefix(block.size());
        is_last = text.empty();
        const XML_Status status = XML_Parse(parser.get(), block.data(), static_cast<int>(block.size()),
                                            is_last ? XML_TRUE : XML_FALSE);
        if (walk.error) std::rethrow_exception(walk.error);
        if (status != XML_STATUS_OK)
            throw InputError(fmt::format("line {}: no well-formed XML: {}",
                                         XML_GetCurrentLineNumber(parser.get()),
                                         XML_ErrorString(XML_GetErrorCode(parser.get()))));
    }
}

}  // namespace arris
