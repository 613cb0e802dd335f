// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

static_assert(std::endian::native == std::endian::little, "numbers are stored as they are in memory");

/// Appends numbers, texts and arrays to a string of bytes, little-endian. A text or array is a 64-bit count
/// followed by the elements.
class BinaryWriter {
  public:
    template <typename Number>
    void number(Number value)
    {
        static_assert(std::is_arithmetic_v<Number>);
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    void text(std::string_view value);
    template <typename Item, typename Write>
    void list(const std::vector<Item>& items, const Write& write)
    {
        number(static_cast<std::uint64_t>(items.size()));
        for (const Item& item : items) write(item);
    }
    void vector(const Vec3& value);
    void vectors(const std::vector<Vec3>& values);
    const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
};

/// Reads bytes of a BinaryWriter from the file `path`. The bytes are untrusted: lengths are checked before
/// memory is allocated. Throws InputError naming the file where a length is too large.
class BinaryReader {
  public:
    /// `bytes` are not copied and must outlive the reader.
    BinaryReader(std::string_view bytes, const std::string& path) : left_(bytes), path_(path) {}

    template <typename Number>
    Number number()
    {
        Number value;
        const std::string_view bytes = take(sizeof value);
        std::memcpy(&value, bytes.data(), sizeof value);
        return value;
    }
    std::string text() { return std::string(take(number<std::uint64_t>())); }

    /// `item_size`: bytes of the smallest item that `read` consumes.
    template <typename Item, typename Read>
    std::vector<Item> list(std::size_t item_size, const Read& read)
    {
        const std::uint64_t count = number<std::uint64_t>();
        if (count > left_.size() / item_size) fail("is truncated or damaged");
        std::vector<Item> items;
        items.reserve(count);
        for (std::uint64_t k = 0; k < count; ++k) items.push_back(read());
        return items;
    }
    Vec3 vector();
    std::vector<Vec3> vectors();
    std::string_view take(std::uint64_t size);
    bool is_at_end() const { return left_.empty(); }
    [[noreturn]] void fail(std::string_view what) const;

  private:
    std::string_view left_;
    std::string path_;
};

/// CRC-32.
std::uint32_t checksum(std::string_view bytes);

/// Identification of a kind of binary file of this program, with its error messages.
struct FileKind {
    std::string_view magic;                 ///< its first bytes
    std::string_view version;               ///< the version written; others are refused
    std::string_view missing;               ///< "there is no checkpoint to resume from"
    std::string_view other;                 ///< "is not a checkpoint of arris"
    std::string_view earlier_version = {};  ///< one more version that is read
};

/// Magic, version, body and CRC-32 of the body.
std::string seal(const FileKind& kind, const std::string& body);

/// Writes a sealed file, atomically. Throws std::system_error naming the path if writing fails.
void write_sealed(const std::string& path, const FileKind& kind, const std::string& body);

struct SealedFile {
    std::string version;
    std::string body;
};

/// Reads what `seal` has made. Throws InputError naming the file `path` that it comes from if it is of
/// another kind or version, or damaged.
SealedFile unseal(std::string_view bytes, const std::string& path, const FileKind& kind);

/// Reads a file of write_sealed. Throws InputError naming the file if it is missing, or as `unseal`.
SealedFile read_sealed(const std::string& path, const FileKind& kind);

}  // namespace arris
