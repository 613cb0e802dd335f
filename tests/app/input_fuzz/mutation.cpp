// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/app/input_fuzz/mutation.h"

#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <limits>

namespace arris {
namespace {

using Change = void (*)(std::string&, std::mt19937&);

std::size_t below(std::size_t end, std::mt19937& random)
{
    return end == 0 ? 0 : std::uniform_int_distribution<std::size_t>(0, end - 1)(random);
}

/// Length of a range that begins at `first`: mostly short.
std::size_t short_length(const std::string& bytes, std::size_t first, std::mt19937& random)
{
    constexpr std::size_t kShort = 16;
    const std::size_t left = bytes.size() - first;
    return below(below(10, random) == 0 ? left : std::min(left, kShort), random) + (left > 0 ? 1 : 0);
}

void cut_off(std::string& bytes, std::mt19937& random)
{
    bytes.resize(below(bytes.size(), random));
}

void flip_bit(std::string& bytes, std::mt19937& random)
{
    if (bytes.empty()) return;
    char& byte = bytes[below(bytes.size(), random)];
    byte = static_cast<char>(byte ^ (1 << below(8, random)));
}

void replace_byte(std::string& bytes, std::mt19937& random)
{
    constexpr std::array<char, 16> kBytes = {'\0', '\xff', '\x7f', '\x80', '\n', ' ', '"', '<',
                                             '>',  '{',    '[',    '/',    '-',  'e', '9', '.'};
    if (!bytes.empty()) bytes[below(bytes.size(), random)] = kBytes[below(kBytes.size(), random)];
}

/// Overwrites bytes with those of a number.
template <class Number, std::size_t size>
void overwrite(const std::array<Number, size>& numbers, std::string& bytes, std::mt19937& random)
{
    const Number number = numbers[below(size, random)];
    if (bytes.size() < sizeof number) return;
    std::memcpy(bytes.data() + below(bytes.size() - sizeof number + 1, random), &number, sizeof number);
}

void overwrite_number(std::string& bytes, std::mt19937& random)
{
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    switch (below(4, random)) {
        case 0:
            return overwrite(std::array<std::uint16_t, 3>{0, 0xffff, 0x8000}, bytes, random);
        case 1:
            return overwrite(std::array<std::uint32_t, 5>{0, 1, 0xffffffff, 0x7fffffff, 0x80000000}, bytes,
                             random);
        case 2:
            return overwrite(std::array<float, 4>{kNan, -1e38f, 1e-40f, 0.0f}, bytes, random);
        default:
            return overwrite(std::array<double, 4>{kInfinity, -1e308, 5e-324, 1e17}, bytes, random);
    }
}

/// Replaces a number of a text by another spelling. None asks for a large mesh, which would be valid.
void replace_digits(std::string& bytes, std::mt19937& random)
{
    constexpr std::array<const char*, 14> kNumbers = {
        "",    "-1",  "0", "1e999",      "-1e308",     "nan",   "inf",
        "1e-", "0x7", "1", "4294967295", "2147483648", "1/0/9", "99999999999999999999"};
    const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
    std::size_t first = below(bytes.size(), random);
    while (first < bytes.size() && !is_digit(bytes[first])) ++first;
    std::size_t last = first;
    while (last < bytes.size() && is_digit(bytes[last])) ++last;
    if (last > first) bytes.replace(first, last - first, kNumbers[below(kNumbers.size(), random)]);
}

/// Replaces a digit of a text by another one: the file mostly stays sound, with another meaning.
void replace_digit(std::string& bytes, std::mt19937& random)
{
    const std::size_t digit = bytes.find_first_of("0123456789", below(bytes.size(), random));
    if (digit != std::string::npos) bytes[digit] = static_cast<char>('0' + below(10, random));
}

void remove_range(std::string& bytes, std::mt19937& random)
{
    const std::size_t first = below(bytes.size(), random);
    bytes.erase(first, short_length(bytes, first, random));
}

void repeat_range(std::string& bytes, std::mt19937& random)
{
    const std::size_t first = below(bytes.size(), random);
    const std::string range = bytes.substr(first, short_length(bytes, first, random));
    bytes.insert(below(bytes.size() + 1, random), range);
}

void move_range(std::string& bytes, std::mt19937& random)
{
    const std::size_t first = below(bytes.size(), random);
    const std::string range = bytes.substr(first, short_length(bytes, first, random));
    bytes.erase(first, range.size());
    bytes.insert(below(bytes.size() + 1, random), range);
}

}  // namespace

std::string mutate(std::string bytes, std::mt19937& random)
{
    constexpr std::array<Change, 9> kChanges = {cut_off,          flip_bit,       replace_byte,
                                                overwrite_number, replace_digits, replace_digit,
                                                remove_range,     repeat_range,   move_range};
    const std::size_t count = 1 + below(1 + below(4, random), random);
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t change = below(kChanges.size(), random);
        // A file that is cut off is mostly refused for that alone.
        if (kChanges[change] != &cut_off || below(4, random) == 0) kChanges[change](bytes, random);
    }
    return bytes;
}

}  // namespace arris
