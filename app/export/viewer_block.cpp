// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/export/viewer_block.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

namespace arris {
namespace {

constexpr double kLevels = 65535.0;  // steps of a 16-bit number

/// Zigzag code of a signed difference: 0, -1, 1, -2, ... become 0, 1, 2, 3, ...
std::uint32_t zigzag(std::int32_t difference)
{
    return (static_cast<std::uint32_t>(difference) << 1) ^ static_cast<std::uint32_t>(difference >> 31);
}

}  // namespace

Bytes deflated(const Bytes& raw)
{
    uLongf size = compressBound(raw.size());
    Bytes result(size);
    if (compress2(result.data(), &size, raw.data(), raw.size(), Z_DEFAULT_COMPRESSION) != Z_OK)
        throw std::runtime_error("viewer.html: zlib ran out of memory");
    result.resize(size);
    result.shrink_to_fit();  // many blocks are kept, so do not keep the capacity of the upper bound
    return result;
}

void append_planes(const std::vector<std::uint16_t>& numbers, Bytes& out)
{
    for (const int shift : {8, 0}) {
        unsigned previous = 0;
        for (const unsigned number : numbers) {
            out.push_back(static_cast<std::uint8_t>((number - previous) >> shift));
            previous = number;
        }
    }
}

ViewerBox find_box(const std::vector<Vec3>& points)
{
    ViewerBox box{points.front(), points.front()};
    for (const Vec3& point : points) {
        box.least = box.least.cwiseMin(point);
        box.greatest = box.greatest.cwiseMax(point);
    }
    return box;
}

std::uint16_t to_level(double value, double least, double range)
{
    if (!(range > 0.0)) return 0;
    return static_cast<std::uint16_t>(std::lround(std::clamp((value - least) / range, 0.0, 1.0) * kLevels));
}

void append_points(const std::vector<Vec3>& points, const ViewerBox& box, Bytes& out)
{
    const Vec3 size = box.size();
    std::vector<std::uint16_t> levels;
    for (int axis = 0; axis < 3; ++axis) {
        levels.clear();
        for (const Vec3& x : points) levels.push_back(to_level(x[axis], box.least[axis], size[axis]));
        append_planes(levels, out);
    }
}

void append_planes(const std::vector<std::uint32_t>& numbers, Bytes& out)
{
    for (int shift = 24; shift >= 0; shift -= 8)
        for (const std::uint32_t number : numbers) out.push_back(static_cast<std::uint8_t>(number >> shift));
}

void append_indices(const std::vector<Face>& faces, const std::vector<std::array<int, 2>>& pairs,
                    const std::vector<int>& points, Bytes& out)
{
    std::vector<std::uint32_t> numbers;
    std::int32_t previous = 0;
    const auto append = [&](int vertex) {
        numbers.push_back(zigzag(vertex - previous));
        previous = vertex;
    };
    for (const Face& face : faces) std::for_each(face.begin(), face.end(), append);
    for (const auto& pair : pairs) std::for_each(pair.begin(), pair.end(), append);
    std::for_each(points.begin(), points.end(), append);
    append_planes(numbers, out);
}

std::string base64(const Bytes& bytes)
{
    static constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string result;
    result.reserve(4 * ((bytes.size() + 2) / 3));
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            result.push_back(k <= count ? kDigits[group >> (18 - 6 * k) & 63U] : '=');
    }
    return result;
}

}  // namespace arris
