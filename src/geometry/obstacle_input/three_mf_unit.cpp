// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/three_mf_unit.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>

#include "geometry/input_error.h"

// A ZIP archive ends with a directory (PKWARE's APPNOTE 6.3). Its end record comes last; before it, one entry
// per file names the position of the file's local header and data.
namespace arris {
namespace {

constexpr std::size_t kEndRecord = 22;
constexpr std::size_t kLongestComment = 0xffff;
constexpr std::size_t kEntry = 46;
constexpr std::size_t kLocalHeader = 30;

// The tag <model ...> is in the first lines.
constexpr std::size_t kModelStart = 1 << 16;

[[noreturn]] void refuse_truncated()
{
    throw InputError("truncated, or not a 3MF file: no whole ZIP archive");
}

template <class Number>
std::size_t number_at(std::string_view bytes, std::size_t offset)
{
    if (offset > bytes.size() || bytes.size() - offset < sizeof(Number)) refuse_truncated();
    Number number;
    std::memcpy(&number, bytes.data() + offset, sizeof number);
    return number;
}

bool is_model(std::string_view name)
{
    constexpr std::string_view kEnding = ".model";
    if (name.size() < kEnding.size()) return false;
    const std::string_view tail = name.substr(name.size() - kEnding.size());
    return std::equal(tail.begin(), tail.end(), kEnding.begin(), [](char a, char b) {
        return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
    });
}

// The first bytes of the unpacked data.
std::string inflate_start(std::string_view packed)
{
    std::string text(kModelStart, '\0');
    z_stream stream{};
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.avail_in = static_cast<uInt>(std::min<std::size_t>(packed.size(), kModelStart));
    stream.next_out = reinterpret_cast<Bytef*>(text.data());
    stream.avail_out = static_cast<uInt>(text.size());
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw InputError("its model cannot be unpacked");
    const int status = inflate(&stream, Z_SYNC_FLUSH);
    text.resize(stream.total_out);
    inflateEnd(&stream);
    if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR)
        throw InputError("its model cannot be unpacked");
    return text;
}

std::string start_of_model(std::string_view bytes)
{
    if (bytes.size() < kEndRecord) refuse_truncated();
    const std::size_t tail = bytes.size() - std::min(bytes.size(), kEndRecord + kLongestComment);
    const std::size_t end = bytes.rfind("PK\x05\x06");
    if (end == std::string_view::npos || end < tail) refuse_truncated();
    std::size_t at = number_at<std::uint32_t>(bytes, end + 16);
    const std::size_t count = number_at<std::uint16_t>(bytes, end + 10);
    for (std::size_t i = 0; i < count; ++i) {
        if (number_at<std::uint32_t>(bytes, at) != 0x02014b50) refuse_truncated();
        const std::size_t method = number_at<std::uint16_t>(bytes, at + 10);
        const std::size_t packed = number_at<std::uint32_t>(bytes, at + 20);
        const std::size_t name_length = number_at<std::uint16_t>(bytes, at + 28);
        const std::size_t extra = number_at<std::uint16_t>(bytes, at + 30);
        const std::size_t comment = number_at<std::uint16_t>(bytes, at + 32);
        const std::size_t local = number_at<std::uint32_t>(bytes, at + 42);
        if (bytes.size() - at < kEntry + name_length) refuse_truncated();
        const std::string_view name = bytes.substr(at + kEntry, name_length);
        at += kEntry + name_length + extra + comment;
        if (!is_model(name)) continue;

        const std::size_t data = local + kLocalHeader + number_at<std::uint16_t>(bytes, local + 26) +
                                 number_at<std::uint16_t>(bytes, local + 28);
        if (data > bytes.size() || packed > bytes.size() - data) refuse_truncated();
        const std::string_view content = bytes.substr(data, packed);
        if (method == 0) return std::string(content.substr(0, kModelStart));
        return inflate_start(content);
    }
    throw InputError("its archive holds no model");
}

// The value of attribute `unit` in the tag <model ...>; empty if the attribute is absent.
std::string unit_attribute(std::string_view xml)
{
    std::size_t at = xml.find("<model");
    if (at == std::string_view::npos) throw InputError("its model part has no <model>");
    const std::string_view tag = xml.substr(at, xml.find('>', at) - at);
    for (at = tag.find("unit"); at != std::string_view::npos; at = tag.find("unit", at + 1)) {
        const std::size_t open = tag.find_first_not_of(" \t\r\n=", at + 4);
        const bool is_name = at > 0 && std::strchr(" \t\r\n", tag[at - 1]) != nullptr;
        if (!is_name || open == std::string_view::npos || (tag[open] != '"' && tag[open] != '\'')) continue;
        const std::size_t close = tag.find(tag[open], open + 1);
        if (close == std::string_view::npos) break;
        return std::string(tag.substr(open + 1, close - open - 1));
    }
    return {};
}

}  // namespace

double three_mf_unit(std::string_view bytes)
{
    constexpr std::array<std::pair<std::string_view, double>, 6> kUnits = {{{"micron", 1e-6},
                                                                            {"millimeter", 1e-3},
                                                                            {"centimeter", 1e-2},
                                                                            {"inch", 0.0254},
                                                                            {"foot", 0.3048},
                                                                            {"meter", 1.0}}};
    const std::string unit = unit_attribute(start_of_model(bytes));
    if (unit.empty()) return 1e-3;
    for (const auto& [name, metres] : kUnits)
        if (unit == name) return metres;
    throw InputError(fmt::format("its unit '{}' is none of micron, millimeter, centimeter, inch, foot, meter",
                                 unit.substr(0, 40)));
}

}  // namespace arris
