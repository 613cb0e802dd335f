// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/report/raster.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace arris {
namespace {

constexpr float kEmpty = -std::numeric_limits<float>::infinity();

void append_number(std::uint32_t number, std::string& out)
{
    for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(number >> shift & 0xff);
}

/// A chunk of a PNG file: length, name, data, checksum of name and data.
std::string chunk(const std::string& name, const std::string& data)
{
    std::string out;
    append_number(static_cast<std::uint32_t>(data.size()), out);
    const std::string body = name + data;
    const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
    out += body;
    append_number(static_cast<std::uint32_t>(sum), out);
    return out;
}

std::string deflate(const std::string& raw)
{
    uLongf size = compressBound(raw.size());
    std::string out(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(raw.data()),
                  raw.size(), Z_DEFAULT_COMPRESSION) != Z_OK)
        throw std::runtime_error("report.html: too little memory for the picture");
    out.resize(size);
    return out;
}

/// A pixel number from a coordinate, which may be far outside the image or not a number.
int clamped(double value, int least, int greatest)
{
    if (!(value > least)) return least;
    return static_cast<int>(std::min(value, static_cast<double>(greatest)));
}

/// Narrows [first, last] to where start + x * slope >= 0.
void narrow(double slope, double start, double& first, double& last)
{
    if (slope > 0.0) first = std::max(first, -start / slope);
    if (slope < 0.0) last = std::min(last, -start / slope);
    if (!(slope > 0.0) && !(slope < 0.0) && start < 0.0) last = first - 1.0;
}

}  // namespace

Raster::Raster(int width, int height)
    : width_(width),
      height_(height),
      depth_(static_cast<std::size_t>(width) * height, kEmpty),
      colours_(depth_.size())
{
}

void Raster::set(int x, int y, double z, const Colour& colour)
{
    const std::size_t at = static_cast<std::size_t>(height_ - 1 - y) * width_ + x;
    if (!(static_cast<float>(z) > depth_[at])) return;
    depth_[at] = static_cast<float>(z);
    colours_[at] = colour;
}

void Raster::draw_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Colour& colour)
{
    // Area of (p, q, r), twice. Shares of a vertex in a point are such areas, linear in the point.
    const auto area = [](const Vec3& p, const Vec3& q, double x, double y) {
        return (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
    };
    const double whole = area(a, b, c[0], c[1]);
    if (!(std::abs(whole) > 0.0)) return;
    const double sign = whole > 0.0 ? 1.0 : -1.0;
    const std::array<std::array<const Vec3*, 2>, 3> edges = {{{&b, &c}, {&c, &a}, {&a, &b}}};
    const int low = clamped(std::ceil(std::min({a[1], b[1], c[1]})), 0, height_);
    const int high = clamped(std::floor(std::max({a[1], b[1], c[1]})), -1, height_ - 1);
    for (int y = low; y <= high; ++y) {
        double first = 0.0, last = width_ - 1.0;
        for (const auto& [p, q] : edges)
            narrow(-sign * ((*q)[1] - (*p)[1]), sign * area(*p, *q, 0.0, y), first, last);
        if (!(first <= last)) continue;
        for (int x = static_cast<int>(std::ceil(first)); x <= static_cast<int>(std::floor(last)); ++x)
            set(x, y, (area(b, c, x, y) * a[2] + area(c, a, x, y) * b[2] + area(a, b, x, y) * c[2]) / whole,
                colour);
    }
}

void Raster::draw_line(const Vec3& a, const Vec3& b, double radius, double lift, const Colour& colour)
{
    // The part of the line near the image.
    double first = 0.0, last = 1.0;
    for (int d = 0; d < 2; ++d) {
        const double size = d == 0 ? width_ : height_;
        narrow(b[d] - a[d], a[d] + radius, first, last);
        narrow(a[d] - b[d], size + radius - a[d], first, last);
    }
    if (!(first <= last)) return;
    const double length = (last - first) * (b - a).head<2>().norm();
    if (!(length >= 0.0)) return;  // not a number
    const int steps = 1 + static_cast<int>(std::min(std::ceil(length), 2.0 * (width_ + height_)));
    for (int k = 0; k <= steps; ++k) {
        const Vec3 p = a + (first + (last - first) * k / steps) * (b - a);
        for (int y = clamped(std::ceil(p[1] - radius), 0, height_);
             y <= clamped(std::floor(p[1] + radius), -1, height_ - 1); ++y) {
            const double half = std::sqrt(std::max(0.0, radius * radius - (y - p[1]) * (y - p[1])));
            for (int x = clamped(std::ceil(p[0] - half), 0, width_);
                 x <= clamped(std::floor(p[0] + half), -1, width_ - 1); ++x)
                set(x, y, p[2] + lift, colour);
        }
    }
}

std::size_t Raster::count(const Colour& colour) const
{
    return static_cast<std::size_t>(std::count(colours_.begin(), colours_.end(), colour));
}

std::string Raster::to_png() const
{
    const int width = width_ / 2, height = height_ / 2;
    std::string rows;
    for (int y = 0; y < height; ++y) {
        rows += '\0';  // no filter
        for (int x = 0; x < width; ++x) {
            int covered = 0;
            std::array<int, 3> sum = {};
            for (int k = 0; k < 4; ++k) {
                const std::size_t at = static_cast<std::size_t>(2 * y + k / 2) * width_ + 2 * x + k % 2;
                if (depth_[at] == kEmpty) continue;
                ++covered;
                for (int d = 0; d < 3; ++d) sum[d] += colours_[at][d];
            }
            for (int d = 0; d < 3; ++d) rows += static_cast<char>(covered ? sum[d] / covered : 0);
            rows += static_cast<char>(covered * 255 / 4);
        }
    }
    std::string header;
    append_number(static_cast<std::uint32_t>(width), header);
    append_number(static_cast<std::uint32_t>(height), header);
    header += {8, 6, 0, 0, 0};  // 8 bits, red green blue alpha, deflate, no interlacing
    return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + chunk("IDAT", deflate(rows)) + chunk("IEND", "");
}

}  // namespace arris
