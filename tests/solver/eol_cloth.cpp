// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/solver/eol_cloth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "physics/forces/energies.h"
#include "physics/forces/inertia.h"
#include "physics/forces/make_terms.h"
#include "solver/eol/eol_coordinates.h"
#include "solver/mesh_change/mesh_transfer.h"
#include "solver/step.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris::testing {
namespace {

constexpr double kWidth = 0.4;  // m

double half_angle(double degrees)
{
    return 0.5 * degrees * std::numbers::pi / 180.0;
}

ClothElements elements_of(const ClothMesh& mesh)
{
    return make_elements(mesh, make_topology(mesh.vertex_count(), mesh.faces));
}

CornerVelocities corners_of(const State& state, const ClothElements& elements)
{
    return compute_corner_velocities(elements, state.mesh.world, state.velocity, state.material_velocity);
}

}  // namespace

MovingObstacle make_ridge(double tip_degrees, double half_length)
{
    constexpr double kHeight = 0.3;
    const double base = 2.0 * kHeight * std::tan(half_angle(tip_degrees));
    ObstacleMesh mesh = make_teeth({1, std::max(1.0, 1.1 * base), kHeight, 2.0 * half_length, tip_degrees});
    for (Vec3& p : mesh.points) p.z() -= kHeight;
    return MovingObstacle("ridge", std::move(mesh), {}, {}, 30.0);
}

int tip_of(const Obstacle& ridge)
{
    const auto& edges = ridge.features().edges;
    const auto found = std::find_if(edges.begin(), edges.end(), [&](const FeatureEdge& edge) {
        const auto& [a, b] = ridge.topology().edges[edge.edge].points;
        return ridge.mesh().points[a].z() > -1e-9 && ridge.mesh().points[b].z() > -1e-9;
    });
    return static_cast<int>(found - edges.begin());
}

int end_of(const Obstacle& ridge)
{
    const auto& corners = ridge.features().corners;
    const auto found = std::find_if(corners.begin(), corners.end(), [&](const FeatureCorner& corner) {
        const Vec3& point = ridge.mesh().points[corner.point];
        return point.z() > -1e-9 && point.y() > 0.0;
    });
    return static_cast<int>(found - corners.begin());
}

ClothMesh make_draped(const Drape& shape)
{
    ClothGrid grid;
    grid.size = {kWidth, kWidth};
    grid.resolution = {shape.cells, shape.cells};
    grid.pattern = GridPattern::Diagonal;
    ClothMesh mesh = make_cloth_grid(grid);
    const double turn = shape.turn_degrees * std::numbers::pi / 180.0, half = half_angle(shape.fold_degrees);
    for (std::size_t v = 0; v < mesh.world.size(); ++v) {
        const Vec2 X = mesh.material[v] - Vec2::Constant(0.5 * kWidth);
        const double across = std::cos(turn) * X.x() - std::sin(turn) * X.y();
        const double along = std::sin(turn) * X.x() + std::cos(turn) * X.y();
        mesh.world[v] = {across * std::sin(half), shape.stretch * along, -std::abs(across) * std::cos(half)};
    }
    return mesh;
}

EolCloth::EolCloth(MovingObstacle obstacle, ClothMesh mesh)
{
    scene.materials[0] = {0.2, 50.0, 0.3, 1e-5, 0.0, 1e-3};
    scene.obstacles.push_back(std::move(obstacle));
    scene.eol = uniform_target(0.05, 10.0);
    state = make_state(scene, std::move(mesh), Vec3::Zero());
}

int EolCloth::vertex_at(double u, double v) const
{
    const auto& X = state.mesh.material;
    const auto nearest = std::min_element(X.begin(), X.end(), [&](const Vec2& a, const Vec2& b) {
        return (a - Vec2(u, v)).squaredNorm() < (b - Vec2(u, v)).squaredNorm();
    });
    return static_cast<int>(nearest - X.begin());
}

int EolCloth::add_eol(int vertex, bool is_corner, int feature)
{
    const FeatureId on = is_corner ? FeatureId::corner(0, feature) : FeatureId::edge(0, feature);
    state.eol.push_back({state.ids[vertex], on, Vec3::UnitZ(), 0});
    std::sort(state.eol.begin(), state.eol.end(),
              [](const EolVertex& a, const EolVertex& b) { return a.vertex_id < b.vertex_id; });
    return state.eol_entry(state.ids[vertex]);
}

ClothStars stars_of(const ClothMesh& mesh)
{
    return make_stars(mesh);
}

ClothStars EolCloth::stars() const
{
    return stars_of(state.mesh);
}

EolPlacing EolCloth::place(int vertex, const Placement& end) const
{
    return place_eol_vertex(scene.obstacles[0].shape(), scene.materials.thickness(), state,
                            state.eol_entry(state.ids[vertex]), stars(), state.mesh.world, end);
}

EolCloth lying(double turn, double shift, double half_length)
{
    EolCloth cloth(make_ridge(60.0, half_length), make_draped({7, turn, 180.0}));
    cloth.scene.eol = uniform_target(kLyingCell, 10.0);
    for (Vec3& x : cloth.state.mesh.world) x += Vec3(shift, 0.0, kThickness);
    return cloth;
}

void press_edges(EolCloth& cloth)
{
    const Obstacle& ridge = cloth.scene.obstacles[0].shape();
    const FeatureEdge& tip = ridge.features().edges[tip_of(ridge)];
    const double end = std::abs(ridge.mesh().points[ridge.topology().edges[tip.edge].points[0]].y());
    const State& state = cloth.state;
    for (const MeshEdge& edge : edges_of(state)) {
        const Vec3 &a = state.mesh.world[edge.a], &b = state.mesh.world[edge.b];
        if (!(a.x() * b.x() < 0.0)) continue;
        const double s = a.x() / (a.x() - b.x());
        if (std::abs((1.0 - s) * a.y() + s * b.y()) > end) continue;
        ContactVertexIds ids = {state.ids[edge.a], state.ids[edge.b]};
        std::sort(ids.begin(), ids.end());
        cloth.state.active.push_back({ids, ContactKind::Edge, 0, tip.edge, Vec3::UnitZ(), 1e-6});
    }
}

std::vector<MeshEdge> edges_of(const State& state)
{
    return make_topology(state.mesh.vertex_count(), state.mesh.faces).edges;
}

EolCloth make_disk_cloth(double height)
{
    const auto shrink = [](const Vec3& p) { return Vec3(0.1 * p - 0.1 * Vec3::UnitZ()); };
    EolCloth cloth(MovingObstacle("disk", samples::moved(samples::cylinder(16), shrink), {}, {}, 30.0),
                   make_draped({7, 17.0, 180.0}));
    for (Vec3& x : cloth.state.mesh.world) x.z() = height * kThickness;
    return cloth;
}

void press_faces_on(int point, State& state)
{
    state.active.clear();
    for (const Face& face : state.mesh.faces) {
        ContactVertexIds ids;
        for (int k = 0; k < 3; ++k) ids[k] = state.ids[face[k]];
        std::sort(ids.begin(), ids.end());
        state.active.push_back({ids, ContactKind::Triangle, 0, point, Vec3::UnitZ(), 1e-6});
    }
    std::sort(state.active.begin(), state.active.end(),
              [](const auto& a, const auto& b) { return a.vertex_ids < b.vertex_ids; });
}

ConformOutcome conform_cloth(const EolCloth& cloth, const FailedFlow& failed, const ConformLimits& limits)
{
    RelaxationMemo relaxations;
    const ClothStars stars = cloth.stars();
    return conform_mesh(cloth.scene, kStep, cloth.state, stars,
                        find_mesh_changes(cloth.scene, cloth.state, stars), failed, limits, relaxations);
}

ConformedMesh take(EolCloth& cloth)
{
    std::optional<ConformedMesh> made = conform_cloth(cloth).mesh;
    EXPECT_TRUE(made);
    TransferReport report;
    if (made)
        cloth.state =
            transfer(cloth.scene, cloth.state, cloth.stars(), *made, stars_of(made->surgery.mesh), report);
    return made ? *made : ConformedMesh{};
}

double kinetic_energy_of(const Scene& scene, const State& state)
{
    const ClothElements elements = elements_of(state.mesh);
    return kinetic_energy(scene.materials, elements, corners_of(state, elements));
}

Vec3 momentum_of(const Scene& scene, const State& state)
{
    const ClothElements elements = elements_of(state.mesh);
    return linear_momentum(scene.materials, elements, corners_of(state, elements));
}

double elastic_energy_of(const Scene& scene, const ClothMesh& mesh)
{
    const Terms terms = make_terms(scene.materials, {}, {}, {});
    const Energies energies = compute_energies(elements_of(mesh), terms, mesh.world);
    return energies.stretch + energies.bending;
}

}  // namespace arris::testing
