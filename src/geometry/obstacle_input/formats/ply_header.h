// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace arris {

/// A type of numbers; size 0 stands for none.
struct PlyType {
    std::string_view name;
    int size = 0;  ///< bytes
    bool is_signed = false;
    bool is_float = false;
};

struct PlyProperty {
    std::string name;  ///< in lower case
    PlyType count;     ///< of a list's length; size 0 for a property that is no list
    PlyType value;

    bool is_list() const { return count.size > 0; }
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;

    /// Position of the first property with one of these names; -1 without one.
    int find(std::initializer_list<std::string_view> names) const;
};

enum class PlyFormat { Text, LittleEndian, BigEndian };

struct PlyHeader {
    PlyFormat format = PlyFormat::Text;
    std::vector<PlyElement> elements;
    std::size_t size = 0;  ///< bytes, the line 'end_header' included
    int lines = 0;
};

/// Reads the header of a PLY file (Turk's format). Its lines may end with a line feed, a carriage return or
/// both. Throws InputError, without the file's name, for an invalid header. Counts are at most the file's
/// length in bytes, as each element takes at least one.
PlyHeader read_ply_header(std::string_view bytes);

}  // namespace arris
