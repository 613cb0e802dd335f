// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/study/fingerprint.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <string_view>

namespace arris {
namespace {

/// The FNV-1a hash with 64 bits (Fowler, Noll, Vo).
class Hash {
  public:
    void add(std::string_view bytes)
    {
        constexpr std::uint64_t kPrime = 1099511628211u;
        for (const char c : bytes) value_ = (value_ ^ static_cast<unsigned char>(c)) * kPrime;
    }
    std::string text() const { return fmt::format("{:016x}", value_); }

  private:
    std::uint64_t value_ = 14695981039346656037u;
};

}  // namespace

std::string fingerprint(const std::vector<std::string>& texts)
{
    Hash hash;
    for (const std::string& text : texts) {
        hash.add(fmt::format("{}:", text.size()));  // so that {"ab", "c"} differs from {"a", "bc"}
        hash.add(text);
    }
    return hash.text();
}

std::string file_fingerprint(const std::string& path)
{
    std::ifstream in(path, std::ios::binary);
    if (!in) return "absent";
    Hash hash;
    std::array<char, 1 << 16> buffer;
    while (in.read(buffer.data(), buffer.size()) || in.gcount() > 0)
        hash.add({buffer.data(), static_cast<std::size_t>(in.gcount())});
    return hash.text();
}

}  // namespace arris
