// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/warnings/layer_warnings.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <set>

#include "geometry/self_contact/self_contact_search.h"

namespace arris {
namespace {

/// Mean over the faces of their least height in the material, m.
double mean_height(const ClothMesh& cloth)
{
    double sum = 0.0;
    for (int f = 0; f < cloth.face_count(); ++f) {
        const auto [a, b, c] = cloth.corners(f);
        const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
        const Vec2 first = b - a, second = c - a;
        sum += std::abs(first.x() * second.y() - first.y() * second.x()) / longest;
    }
    return sum / static_cast<double>(cloth.face_count());
}

const char* thickness_key(const Warnings& warnings)
{
    return warnings.is_written("self_contact.thickness") ? "self_contact.thickness" : "self_contact";
}

void check_height(const RunConfig& config, Warnings& warnings)
{
    constexpr double kMost = 0.2, kLeast = 1e-4;
    const double thickness = config.scene.self_contact->thickness, height = mean_height(config.cloth);
    if (thickness < kLeast * height)
        warnings.note(
            thickness_key(warnings),
            fmt::format("layers keep only {:g} m apart, which is below a ten-thousandth of the mean "
                        "height of the cloth's triangles, {:.3g} m: steps are halved often and take "
                        "long; use a greater self_contact.thickness",
                        thickness, height));
    if (thickness <= kMost * height) return;
    warnings.note(thickness_key(warnings),
                  fmt::format("layers keep {:g} m apart, which is above a fifth of the mean height of the "
                              "cloth's triangles, {:.3g} m: pleats may jam, and steps take long; use a "
                              "smaller self_contact.thickness or larger cells",
                              thickness, height));
}

void check_distance(const RunConfig& config, const MeshTopology& topology, Warnings& warnings)
{
    constexpr double kMany = 0.1;    // of the vertices: fewer are near a fold
    constexpr double kTouch = 1e-3;  // of the thickness: so near that it may be unable to move at all
    const ClothMesh& cloth = config.cloth;
    const double thickness = config.scene.self_contact->thickness;
    std::set<int> near;
    double least = thickness;
    for (const SelfContact& contact :
         find_self_contacts(SelfSurface(cloth.vertex_count(), cloth.faces, topology),
                            {cloth.world, cloth.world}, thickness)) {
        constexpr double kRoundOff = 1e-9;
        const double distance = contact.difference(cloth.world).norm();
        if (distance >= (1.0 - kRoundOff) * thickness) continue;
        near.insert(contact.vertices[0]);
        least = std::min(least, distance);
    }
    if (static_cast<double>(near.size()) <= kMany * cloth.vertex_count() && least >= kTouch * thickness)
        return;
    warnings.note(thickness_key(warnings),
                  fmt::format("{} of {} vertices start nearer to another layer than the {:g} m that layers "
                              "keep apart, the nearest {:.3g} m, and are moved apart in the first steps: "
                              "start them farther apart, or use a smaller self_contact.thickness",
                              near.size(), cloth.vertex_count(), thickness, least));
}

}  // namespace

void check_layers(const RunConfig& config, const MeshTopology& topology, Warnings& warnings)
{
    if (!config.scene.self_contact || config.cloth.faces.empty()) return;
    check_height(config, warnings);
    check_distance(config, topology, warnings);
}

}  // namespace arris
