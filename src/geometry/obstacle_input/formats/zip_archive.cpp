// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/formats/zip_archive.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <cstring>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle_input/formats/mesh_file_limits.h"

// A ZIP archive ends with a directory. Its end record comes last; before it, one entry per file names the
// position of the file's local header and data.
namespace arris {
namespace {

constexpr std::size_t kEndRecord = 22;
constexpr std::size_t kLongestComment = 0xffff;
constexpr std::size_t kEntry = 46;
constexpr std::size_t kLocalHeader = 30;
constexpr std::size_t kLocator64 = 20;
constexpr std::uint64_t kIn64Bits = 0xffffffff;  // the number stands in a 64-bit field

[[noreturn]] void refuse_truncated()
{
    throw InputError("truncated, or not a 3MF file: no whole ZIP archive");
}

template <class Number>
std::uint64_t number_at(std::string_view bytes, std::uint64_t offset)
{
    if (offset > bytes.size() || bytes.size() - offset < sizeof(Number)) refuse_truncated();
    Number number;
    std::memcpy(&number, bytes.data() + offset, sizeof number);
    return number;
}

std::string key_of(std::string_view name)
{
    std::string key(name);
    // Some writers separate folders by a backslash, which the format does not have.
    std::transform(key.begin(), key.end(), key.begin(),
                   [](unsigned char c) { return c == '\\' ? '/' : static_cast<char>(std::tolower(c)); });
    return key;
}

struct Directory {
    std::uint64_t start = 0;
    std::uint64_t count = 0;
};

// The end record, after which only its comment comes. The comment may hold the record's mark; and some
// writers leave bytes behind the comment.
std::size_t find_end_record(std::string_view bytes)
{
    if (bytes.size() < kEndRecord) refuse_truncated();
    const std::size_t tail = bytes.size() - std::min(bytes.size(), kEndRecord + kLongestComment);
    std::size_t found = bytes.npos;
    for (std::size_t end = bytes.rfind("PK\x05\x06"); end != bytes.npos && end >= tail;
         end = end == 0 ? bytes.npos : bytes.rfind("PK\x05\x06", end - 1)) {
        if (bytes.size() - end < kEndRecord) continue;
        const std::size_t stop = end + kEndRecord + number_at<std::uint16_t>(bytes, end + 20);
        if (stop == bytes.size()) return end;
        const bool has_directory = number_at<std::uint32_t>(bytes, end + 16) < end;
        if (found == bytes.npos && stop < bytes.size() && has_directory) found = end;
    }
    if (found == bytes.npos) refuse_truncated();
    return found;
}

Directory find_directory(std::string_view bytes)
{
    const std::size_t end = find_end_record(bytes);
    if (end < kLocator64 || bytes.substr(end - kLocator64, 4) != "PK\x06\x07")
        return {number_at<std::uint32_t>(bytes, end + 16), number_at<std::uint16_t>(bytes, end + 10)};
    const std::uint64_t record = number_at<std::uint64_t>(bytes, end - kLocator64 + 8);
    if (number_at<std::uint32_t>(bytes, record) != 0x06064b50) refuse_truncated();
    return {number_at<std::uint64_t>(bytes, record + 48), number_at<std::uint64_t>(bytes, record + 32)};
}

std::string inflate_all(std::string_view packed, std::uint64_t size, const std::string& name)
{
    std::string text(size, '\0');
    z_stream stream{};
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.avail_in = static_cast<uInt>(packed.size());
    stream.next_out = reinterpret_cast<Bytef*>(text.data());
    stream.avail_out = static_cast<uInt>(text.size());
    int status = inflateInit2(&stream, -MAX_WBITS);
    if (status == Z_OK) {
        status = inflate(&stream, Z_FINISH);
        inflateEnd(&stream);
    }
    if (status != Z_STREAM_END || stream.total_out != size)
        throw InputError(fmt::format("damaged: '{}' of its archive cannot be unpacked", name));
    return text;
}

}  // namespace

ZipArchive::ZipArchive(std::string_view bytes) : bytes_(bytes)
{
    const Directory directory = find_directory(bytes);
    std::uint64_t at = directory.start;
    for (std::uint64_t i = 0; i < directory.count; ++i) at = read_entry(at);
}

// Returns the position of the next entry.
std::uint64_t ZipArchive::read_entry(std::uint64_t at)
{
    if (number_at<std::uint32_t>(bytes_, at) != 0x02014b50) refuse_truncated();
    Entry entry;
    entry.is_encrypted = (number_at<std::uint16_t>(bytes_, at + 8) & 1u) != 0;
    entry.method = number_at<std::uint16_t>(bytes_, at + 10);
    entry.checksum = number_at<std::uint32_t>(bytes_, at + 16);
    entry.packed_size = number_at<std::uint32_t>(bytes_, at + 20);
    entry.size = number_at<std::uint32_t>(bytes_, at + 24);
    entry.header = number_at<std::uint32_t>(bytes_, at + 42);
    const std::uint64_t name_length = number_at<std::uint16_t>(bytes_, at + 28);
    const std::uint64_t extra_length = number_at<std::uint16_t>(bytes_, at + 30);
    const std::uint64_t comment_length = number_at<std::uint16_t>(bytes_, at + 32);
    if (bytes_.size() - at < kEntry + name_length + extra_length) refuse_truncated();
    const std::string_view name = bytes_.substr(at + kEntry, name_length);
    std::string_view extra = bytes_.substr(at + kEntry + name_length, extra_length);
    while (extra.size() >= 4) {
        const std::uint64_t id = number_at<std::uint16_t>(extra, 0);
        const std::uint64_t length = number_at<std::uint16_t>(extra, 2);
        std::string_view field = extra.substr(4, length);
        extra.remove_prefix(std::min<std::size_t>(extra.size(), 4 + length));
        if (id != 1) continue;
        for (std::uint64_t* number : {&entry.size, &entry.packed_size, &entry.header}) {
            if (*number != kIn64Bits) continue;
            *number = number_at<std::uint64_t>(field, 0);
            field.remove_prefix(8);
        }
    }
    const auto [place, is_new] = entries_.emplace(key_of(name), entry);
    place->second.is_double |= !is_new;
    return at + kEntry + name_length + extra_length + comment_length;
}

bool ZipArchive::contains(const std::string& name) const
{
    return entries_.contains(key_of(name));
}

std::string_view ZipArchive::packed(const Entry& entry) const
{
    const std::uint64_t name_length = number_at<std::uint16_t>(bytes_, entry.header + 26);
    const std::uint64_t data =
        entry.header + kLocalHeader + name_length + number_at<std::uint16_t>(bytes_, entry.header + 28);
    if (data > bytes_.size() || entry.packed_size > bytes_.size() - data) refuse_truncated();
    return bytes_.substr(data, entry.packed_size);
}

std::string ZipArchive::read(const std::string& name) const
{
    const auto found = entries_.find(key_of(name));
    const std::string shown = one_line(name);
    if (found == entries_.end()) throw InputError(fmt::format("its archive has no '{}'", shown));
    const Entry& entry = found->second;
    if (entry.is_double) throw InputError(fmt::format("its archive has two files named '{}'", shown));
    if (entry.is_encrypted) throw InputError(fmt::format("'{}' of its archive is encrypted", shown));
    if (entry.method != 0 && entry.method != Z_DEFLATED)
        throw InputError(
            fmt::format("'{}' of its archive has compression method {}; allowed: 0 (stored), 8 "
                        "(deflated)",
                        shown, entry.method));
    if (entry.size > kLargestFile)
        throw InputError(fmt::format("'{}' of its archive has {} bytes; allowed are at most {}", shown,
                                     entry.size, kLargestFile));
    const std::string_view content = packed(entry);
    std::string text = entry.method == 0 ? std::string(content) : inflate_all(content, entry.size, shown);
    const auto* data = reinterpret_cast<const Bytef*>(text.data());
    if (crc32_z(0, data, text.size()) != entry.checksum)
        throw InputError(fmt::format("damaged: '{}' of its archive does not have its checksum", shown));
    return text;
}

}  // namespace arris
