// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

using Colour = std::array<std::uint8_t, 3>;  ///< red, green, blue

/// An image with a depth buffer: of what covers a pixel, the nearest stays. Work and memory are bounded by
/// the image, whatever the coordinates. x runs right, y up, and z towards the viewer, all in pixels.
class Raster {
  public:
    Raster(int width, int height);

    void draw_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Colour& colour);
    /// A round line of this radius, drawn as if `lift` nearer; also a dot, where a = b.
    void draw_line(const Vec3& a, const Vec3& b, double radius, double lift, const Colour& colour);

    /// Number of pixels of this colour.
    std::size_t count(const Colour& colour) const;

    /// A PNG file of half the width and height, so that edges are smooth; empty pixels are transparent.
    std::string to_png() const;

  private:
    void set(int x, int y, double z, const Colour& colour);

    int width_, height_;
    std::vector<float> depth_;
    std::vector<Colour> colours_;
};

}  // namespace arris
