// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/warnings/cloth_poses.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "geometry/cloth/material_region.h"
#include "geometry/cloth/mesh_pieces.h"

namespace arris {
namespace {

Vec3 doubled_area(const ClothMesh& cloth, const Face& face)
{
    const Vec3 &a = cloth.world[face[0]], &b = cloth.world[face[1]], &c = cloth.world[face[2]];
    return (b - a).cross(c - a);
}

/// Means of the vertices of a pin at time 0.
struct PinCentre {
    Vec2 material = Vec2::Zero();
    Vec3 world = Vec3::Zero();
};

PinCentre find_centre(const ClothMesh& cloth, const Pin& pin)
{
    PinCentre centre;
    const std::vector<int> vertices = vertices_inside(cloth, pin.material);
    for (const int v : vertices) {
        centre.material += cloth.material[v] / static_cast<double>(vertices.size());
        centre.world += cloth.world[v] / static_cast<double>(vertices.size());
    }
    return centre;
}

double diagonal(const Eigen::AlignedBox2d& box)
{
    return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

}  // namespace

int count_pieces(const ClothMesh& cloth)
{
    const std::vector<int> piece = label_pieces(cloth.vertex_count(), cloth.faces);
    int pieces = 0;
    for (int v = 0; v < cloth.vertex_count(); ++v) pieces += piece[v] == v ? 1 : 0;
    return pieces;
}

double greatest_turn(const ClothMesh& cloth)
{
    constexpr double kCell = 0.1;  // of the unit sphere: one normal a cell stands for all
    std::map<std::array<int, 3>, Vec3> normals;
    for (const Face& face : cloth.faces) {
        const Vec3 normal = doubled_area(cloth, face).stableNormalized();
        std::array<int, 3> cell;
        for (int d = 0; d < 3; ++d) cell[d] = static_cast<int>(std::lround(normal[d] / kCell));
        normals.emplace(cell, normal);
    }
    double least = 1.0;
    for (auto a = normals.begin(); a != normals.end(); ++a)
        for (auto b = std::next(a); b != normals.end(); ++b)
            least = std::min(least, a->second.dot(b->second));
    return std::acos(std::clamp(least, -1.0, 1.0));
}

double mean_slope(const ClothMesh& cloth, const Vec3& up)
{
    double area = 0.0, upright = 0.0;
    for (const Face& face : cloth.faces) {
        const Vec3 doubled = doubled_area(cloth, face);
        area += doubled.norm();
        upright += std::abs(doubled.dot(up));
    }
    return area > 0.0 ? std::acos(std::min(upright / area, 1.0)) : 0.0;
}

std::optional<PinMeeting> find_nearest_pins(const RunConfig& config)
{
    constexpr int kSamples = 64;
    const std::vector<Pin>& pins = config.scene.pins;
    std::vector<PinCentre> centres;
    for (const Pin& pin : pins) centres.push_back(find_centre(config.cloth, pin));
    std::vector<SurfacePlace> on;
    for (std::size_t p = 0; p < pins.size(); ++p)
        on.push_back(pin_surface(config.scene, pins[p], 0.0, centres[p].world));
    std::optional<PinMeeting> nearest;
    for (int k = 0; k <= kSamples; ++k) {
        const double time = config.duration * k / kSamples;
        std::vector<Vec3> places;
        for (std::size_t p = 0; p < pins.size(); ++p)
            places.push_back(pin_placement(config.scene, pins[p], on[p], time)(centres[p].world));
        for (std::size_t p = 0; p < pins.size(); ++p)
            for (std::size_t q = 0; q < p; ++q) {
                const double apart = (centres[p].material - centres[q].material).norm();
                const Materials& materials = config.scene.materials;
                if (materials.piece_at(centres[p].material) != materials.piece_at(centres[q].material))
                    continue;
                if (!(apart > 0.0) || !pins[p].holds(0.0, time) || !pins[q].holds(0.0, time)) continue;
                const double share = (places[p] - places[q]).norm() / apart;
                if (!nearest || share < nearest->share) nearest = {{q, p}, time, share};
            }
    }
    return nearest;
}

double spread_of_pins(const RunConfig& config)
{
    std::vector<Eigen::AlignedBox2d> cloth(config.pieces.size()), held(config.pieces.size());
    for (const Vec2& X : config.cloth.material) cloth[config.scene.materials.piece_at(X)].extend(X);
    for (const Pin& pin : config.scene.pins)
        if (pin.holds(pin.start, config.duration))
            for (const int v : vertices_inside(config.cloth, pin.material))
                held[piece_of(config.scene, config.cloth, v)].extend(config.cloth.material[v]);
    double greatest = 0.0;
    for (std::size_t p = 0; p < cloth.size(); ++p)
        greatest = std::max(greatest, diagonal(held[p]) / diagonal(cloth[p]));
    return greatest;
}

}  // namespace arris
