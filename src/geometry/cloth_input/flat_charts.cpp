// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/flat_charts.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/cloth/mesh_pieces.h"
#include "geometry/tolerances.h"

namespace arris {
namespace {

constexpr double kGap = 0.1;  // between charts, relative to the widest: small, and easy to reckon with

/// A part of the mesh: vertices and faces, both ascending.
struct Part {
    std::vector<int> vertices, faces;
};

/// The plane of a part, as axes of its chart, and the vertex that is farthest from the plane.
struct Plane {
    Vec3 along_u, along_v;
    int farthest;
    double off;  ///< m, distance of `farthest`
    bool is_flat;
};

std::vector<Part> find_parts(const std::vector<int>& label, const std::vector<Face>& faces)
{
    std::vector<Part> parts;
    std::vector<int> place(label.size(), -1);
    for (int v = 0; v < static_cast<int>(label.size()); ++v) {
        if (label[v] == v) {
            place[v] = static_cast<int>(parts.size());
            parts.emplace_back();
        }
        parts[place[label[v]]].vertices.push_back(v);
    }
    for (int f = 0; f < static_cast<int>(faces.size()); ++f)
        parts[place[label[faces[f][0]]]].faces.push_back(f);
    return parts;
}

/// Twice the area vector of the part's largest face.
Vec3 largest_area(const std::vector<Vec3>& world, const std::vector<Face>& faces, const Part& part)
{
    Vec3 largest = Vec3::Zero();
    for (const int f : part.faces) {
        const auto& [a, b, c] = faces[f];
        const Vec3 area = (world[b] - world[a]).cross(world[c] - world[a]);
        if (area.norm() > largest.norm()) largest = area;
    }
    return largest;
}

Plane find_plane(const std::vector<Vec3>& world, const std::vector<Face>& faces, const Part& part)
{
    const Vec3 normal = largest_area(world, faces, part).stableNormalized();
    const Vec3 guide = std::abs(normal.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
    Plane plane;
    plane.along_u = (guide - guide.dot(normal) * normal).normalized();
    plane.along_v = normal.cross(plane.along_u);
    plane.farthest = part.vertices.front();
    plane.off = 0.0;
    const Vec3& origin = world[part.vertices.front()];
    Eigen::AlignedBox3d box;
    for (const int v : part.vertices) {
        box.extend(world[v]);
        const double off = std::abs((world[v] - origin).dot(normal));
        if (!(off > plane.off)) continue;
        plane.off = off;
        plane.farthest = v;
    }
    plane.is_flat = plane.off <= kSinglePrecision * box.sizes().maxCoeff();
    return plane;
}

void lay_out(const std::vector<Vec3>& world, const Part& part, const Plane& plane,
             std::vector<Vec2>& material)
{
    for (const int v : part.vertices)
        material[v] = Vec2(world[v].dot(plane.along_u), world[v].dot(plane.along_v));
}

/// Moves the charts of the parts along u until they lie side by side.
std::vector<FlatChart> lay_side_by_side(const std::vector<Part>& parts, std::vector<Vec2>& material)
{
    std::vector<FlatChart> charts;
    double widest = 0.0;
    for (const Part& part : parts) {
        FlatChart chart{part.faces.front(), std::numeric_limits<double>::infinity(),
                        -std::numeric_limits<double>::infinity()};
        for (const int v : part.vertices) {
            chart.least_u = std::min(chart.least_u, material[v].x());
            chart.greatest_u = std::max(chart.greatest_u, material[v].x());
        }
        widest = std::max(widest, chart.greatest_u - chart.least_u);
        charts.push_back(chart);
    }
    for (std::size_t k = 1; k < charts.size(); ++k) {
        const double shift = charts[k - 1].greatest_u + kGap * widest - charts[k].least_u;
        for (const int v : parts[k].vertices) material[v].x() += shift;
        charts[k].least_u += shift;
        charts[k].greatest_u += shift;
    }
    return charts;
}

}  // namespace

FlatCharts lay_flat(const std::vector<Vec3>& world, const std::vector<Face>& faces)
{
    const int n = static_cast<int>(world.size());
    FlatCharts charts;
    charts.material.resize(world.size());
    const Part whole = find_parts(std::vector<int>(world.size(), 0), faces).front();
    if (const Plane plane = find_plane(world, faces, whole); plane.is_flat) {
        lay_out(world, whole, plane, charts.material);
        return charts;
    }
    const std::vector<Part> parts = find_parts(label_pieces(n, faces), faces);
    for (const Part& part : parts) {
        const Plane plane = find_plane(world, faces, part);
        if (!plane.is_flat) {
            charts.curved_at = plane.farthest;
            charts.off_plane = plane.off;
            return charts;
        }
        lay_out(world, part, plane, charts.material);
    }
    charts.pieces = lay_side_by_side(parts, charts.material);
    return charts;
}

}  // namespace arris
