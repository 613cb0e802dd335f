// SPDX-License-Identifier: GPL-3.0-or-later
// Statics of hanging cloth: its elongation, and the catenary.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "cloth_run.h"
#include "refinement.h"

namespace arris {
namespace {

constexpr double kG = 9.81;

/// Elongation, over rho g L^2 / (2 E), of a sheet of 1 m that hangs from its edge u = 0. With nu = 0 the
/// membrane is linear in the stretch, so the closed form holds for any strain and the held edge prevents no
/// contraction.
double relative_elongation(GridPattern pattern, int cells, double modulus)
{
    const double density = 0.1;
    Scene scene;
    scene.materials[0] = {density, modulus, 0.0, 1e-6, 0.0, 1e-3};
    scene.gravity = Gravity{Vec3(0.0, 0.0, -kG)};
    scene.pins.push_back({{Vec2(0.0, 0.0), Vec2(0.0, 0.5)}, {}, {true, true, true}});
    ClothMesh mesh = make_sheet(Vec2(1.0, 0.5), {cells, cells / 2}, pattern);
    for (std::size_t v = 0; v < mesh.world.size(); ++v)
        mesh.world[v] = Vec3(0.0, mesh.material[v].y(), -mesh.material[v].x());
    ClothRun run(scene, mesh);
    settle(run);
    const std::vector<int> hem = vertices_inside(mesh, {Vec2(1.0, 0.0), Vec2(1.0, 0.5)});
    double length = 0.0;
    for (const int v : hem) length -= run.state.mesh.world[v].z() / static_cast<double>(hem.size());
    return (length - 1.0) / (density * kG / (2.0 * modulus));
}

TEST(HangingSheet, IsLongerByItsWeightTimesHalfItsLengthOverE)
{
    Table table("hanging", {"pattern", "E", "4 cells", "8", "16", "32", "order"});
    for (const auto& [pattern, name] :
         {std::pair{GridPattern::Diagonal, "diagonal"}, std::pair{GridPattern::Alternating, "alternating"},
          std::pair{GridPattern::Cross, "cross"}, std::pair{GridPattern::Unstructured, "unstructured"}})
        for (const double modulus : {10.0, 1000.0}) {  // strains up to 10 % and 0.1 %
            std::vector<double> sizes, errors;
            std::vector<std::string> row = {name, fmt::format("{:g} N/m", modulus)};
            for (const int cells : {4, 8, 16, 32}) {
                sizes.push_back(1.0 / cells);
                const double error = relative_elongation(pattern, cells, modulus) - 1.0;
                ASSERT_FALSE(HasFailure());
                errors.push_back(std::abs(error));
                row.push_back(fmt::format("{:+.1e}", error));
            }
            const double order = order_of(sizes, errors);
            row.push_back(fmt::format("{:.2f}", order));
            table.add(row);
            EXPECT_LT(errors.back(), 1e-4) << name;
            EXPECT_GT(order, 1.7) << name;
        }
}

struct Catenary {
    double tension;  ///< horizontal, N/m
    double sag;      ///< m
};

/// The elastic catenary: x = H s / E + H / w asinh(w s / H), y = w s^2 / (2 E) + H / w (sqrt(1 + (w s / H)^2)
/// - 1), s the material length from the lowest point, w the weight per length. Length L, supports `span`
/// apart.
Catenary solve_catenary(double length, double span, double weight, double modulus)
{
    const double s = 0.5 * length;
    const auto half_span = [&](double H) {
        return H * s / modulus + H / weight * std::asinh(weight * s / H);
    };
    double low = 0.0, high = modulus;
    for (int k = 0; k < 200; ++k) {
        const double middle = 0.5 * (low + high);
        (half_span(middle) < 0.5 * span ? low : high) = middle;
    }
    const double H = 0.5 * (low + high);
    return {H, weight * s * s / (2.0 * modulus) + H / weight * (std::hypot(1.0, weight * s / H) - 1.0)};
}

TEST(Catenary, OfANearlyInextensibleStrip)
{
    const double length = 1.0, span = 0.8, weight = 0.1 * kG, modulus = 1e4;
    const Catenary exact = solve_catenary(length, span, weight, modulus);
    const Catenary inextensible = solve_catenary(length, span, weight, 1e12);
    EXPECT_NEAR(exact.sag / inextensible.sag, 1.0, 1e-3) << "the strip hardly stretches";
    Table table("catenary", {"cells", "sag", "error"});
    std::vector<double> sizes, errors;
    for (const int cells : {8, 16, 32, 64}) {
        Scene scene;
        scene.materials[0] = {0.1, modulus, 0.0, 1e-9, 0.0, 1e-3};
        scene.gravity = Gravity{Vec3(0.0, 0.0, -kG)};
        const double width = length / cells;
        for (const double u : {0.0, length})
            scene.pins.push_back({{Vec2(u, 0.0), Vec2(u, width)}, {}, {true, true, true}});
        ClothMesh mesh = make_sheet(Vec2(length, width), {cells, 1}, GridPattern::Alternating);
        // The strip starts as a V of its material length.
        const double depth = std::sqrt(0.25 * (length * length - span * span));
        for (std::size_t v = 0; v < mesh.world.size(); ++v) {
            const double u = mesh.material[v].x(), from_end = std::min(u, length - u);
            mesh.world[v] = Vec3(span * u / length, mesh.material[v].y(), -depth * from_end / (0.5 * length));
        }
        ClothRun run(scene, mesh);
        settle(run);
        ASSERT_FALSE(HasFailure());
        double sag = 0.0;
        for (const Vec3& x : run.state.mesh.world) sag = std::max(sag, -x.z());
        sizes.push_back(width);
        errors.push_back(std::abs(sag - exact.sag));
        table.add({fmt::to_string(cells), fmt::format("{:.6f} m", sag),
                   fmt::format("{:+.2e}", sag / exact.sag - 1.0)});
    }
    const double order = order_of(sizes, errors);
    table.add({"exact", fmt::format("{:.6f} m", exact.sag), fmt::format("order {:.2f}", order)});
    EXPECT_GT(order, 1.85);
    EXPECT_LT(order, 2.2);
    EXPECT_LT(errors.back() / exact.sag, 1e-3);
}

}  // namespace
}  // namespace arris
