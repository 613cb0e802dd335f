// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/remesh/wanted_lengths.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "geometry/cloth/material_grid.h"
#include "geometry/cloth/mesh_topology.h"
#include "physics/elements/deformation_gradient.h"
#include "physics/elements/hinge_angle.h"
#include "solver/eol/eol_features.h"
#include "solver/model/target_length.h"

namespace arris {

namespace {

/// Greatest difference of target lengths for each metre between their places.
constexpr double kGradation = 0.5;

/// Share of the hinges' sizes that counts where their signs cancel.
constexpr double kUnsigned = 0.5;

/// Symmetric 2x2 matrix as xx, xy, yy.
using Sym2 = Eigen::Vector3d;

double largest_eigenvalue(const Sym2& S)
{
    const double mean = 0.5 * (S[0] + S[2]), half = 0.5 * (S[0] - S[2]);
    return std::abs(mean) + std::sqrt(half * half + S[1] * S[1]);
}

/// Sums over the material: area, curvature with and without sign, compression, squared gradient of
/// velocity. All but the first are weighted by area.
enum Channel { kArea = 0, kSigned = 1, kSizes = 4, kCompression = 7, kVelocity = 8, kChannels };
using Measures = Eigen::Matrix<double, kChannels, 1>;

/// Signed angle, rad, by which the surface turns over a hinge. 0 where a face has collapsed.
double turn(const std::vector<Vec3>& x, const Hinge& hinge)
{
    const std::array<Vec3, 4> corners = {x[hinge.a], x[hinge.b], x[hinge.c], x[hinge.d]};
    const std::optional<HingeAngle> angle = find_hinge_angle(corners);
    if (!angle) return 0.0;
    return std::atan2(sine_of_angle(*angle, corners), angle->normal_c.dot(angle->normal_d));
}

/// Adds half of each hinge's second fundamental form to the two faces beside it.
void add_curvature(const Scene& scene, const State& state, const ClothStars& stars,
                   std::vector<Measures>& faces)
{
    std::set<std::array<int, 2>> folds;
    for (const auto& [a, b] : find_trace_edges(scene.obstacles, state, stars)) {
        const auto [first, second] =
            std::minmax({state.index_of(state.eol[a].vertex_id), state.index_of(state.eol[b].vertex_id)});
        folds.insert({first, second});
    }
    for (const Hinge& hinge : stars.topology.hinges) {
        if (folds.contains({hinge.a, hinge.b})) continue;
        const double theta = turn(state.mesh.world, hinge);
        for (const int f : {hinge.face_c, hinge.face_d}) {
            const Vec2 edge = state.mesh.material[state.mesh.point_of(hinge.b, f)] -
                              state.mesh.material[state.mesh.point_of(hinge.a, f)];
            const Sym2 form = 0.5 * theta / edge.norm() *
                              Sym2(edge.y() * edge.y(), -edge.x() * edge.y(), edge.x() * edge.x());
            faces[f].segment<3>(kSigned) += form;
            faces[f].segment<3>(kSizes) += theta < 0.0 ? Sym2(-form) : form;
        }
    }
}

/// Measures of each face, times its area.
std::vector<Measures> measure_faces(const Scene& scene, const State& state, const ClothStars& stars)
{
    std::vector<Measures> faces(state.mesh.faces.size(), Measures::Zero());
    add_curvature(scene, state, stars, faces);
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const Face& face = state.mesh.faces[f];
        const std::array<Vec2, 3> X = state.mesh.corners(static_cast<int>(f));
        std::array<Vec3, 3> x, w;
        for (int i = 0; i < 3; ++i) x[i] = state.mesh.world[face[i]];
        const Mat32 F = deformation_gradient(X, x);
        const Face& points = state.mesh.points_of(static_cast<int>(f));
        for (int i = 0; i < 3; ++i) w[i] = state.velocity[face[i]] - F * state.material_velocity[points[i]];
        const Mat32 gradient = deformation_gradient(X, w);
        const double area = 0.5 * twice_area(X[0], X[1], X[2]);
        const Mat2 C = F.transpose() * F, D = gradient.transpose() * gradient;
        const double least = C.trace() - largest_eigenvalue({C(0, 0), C(0, 1), C(1, 1)});
        faces[f][kArea] = area;
        faces[f][kCompression] = area * std::max(0.0, 1.0 - std::sqrt(std::max(least, 0.0)));
        faces[f][kVelocity] = area * largest_eigenvalue({D(0, 0), D(0, 1), D(1, 1)});
    }
    return faces;
}

/// Spreads each face over the nodes beneath it, in equal parts at most as long as the grid's spacing.
std::vector<Measures> spread(const MaterialGrid& grid, const ClothMesh& mesh,
                             const std::vector<Measures>& faces)
{
    std::vector<Measures> nodes(static_cast<std::size_t>(grid.size()), Measures::Zero());
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const std::array<Vec2, 3> X = mesh.corners(static_cast<int>(f));
        double longest = 0.0;
        for (int i = 0; i < 3; ++i) longest = std::max(longest, (X[i] - X[(i + 1) % 3]).norm());
        const int n = std::max(1, static_cast<int>(std::ceil(longest / grid.spacing)));
        const auto add = [&](double s, double t) {
            const GridPlace place = find_place(grid, X[0] + s * (X[1] - X[0]) + t * (X[2] - X[0]));
            for (int k = 0; k < 4; ++k) nodes[place.node[k]] += place.weight[k] / (double(n) * n) * faces[f];
        };
        // The centres of the n^2 triangles that lines parallel to the sides make.
        for (int i = 0; i < n; ++i)
            for (int j = 0; i + j < n; ++j) {
                add((i + 1.0 / 3.0) / n, (j + 1.0 / 3.0) / n);
                if (i + j + 1 < n) add((i + 2.0 / 3.0) / n, (j + 2.0 / 3.0) / n);
            }
    }
    return nodes;
}

/// Edge length, m, that the sums over a box around X ask for. `present`: the edge length now.
double find_length(const Scene& scene, const Vec2& X, const Measures& sum, double present)
{
    const Remeshing& remesh = *scene.remesh;
    double length = remesh.longest;
    if (!(sum[kArea] > 0.0)) return length;
    const Measures mean = sum / sum[kArea];
    const double curvature = std::max(largest_eigenvalue(mean.segment<3>(kSigned)),
                                      kUnsigned * largest_eigenvalue(mean.segment<3>(kSizes)));
    if (length * curvature > remesh.angle) length = remesh.angle / curvature;
    if (const double gradient = std::sqrt(mean[kVelocity]); length * gradient > remesh.velocity)
        length = remesh.velocity / gradient;
    if (const double strain = mean[kCompression]; strain > remesh.compression) {
        // A quarter of the wave length at which cloth under this strain buckles: 2 pi sqrt(D / (E strain)).
        const Material& material = scene.materials.at(X);
        const double quarter =
            0.5 * M_PI * std::sqrt(plate_rigidity(material) / (material.youngs_modulus * strain));
        length = std::min(length, std::max(quarter, 0.5 * present));
    }
    return std::max(length, remesh.shortest);
}

/// Vertices that a mesh of these lengths needs, relative to `present` ones.
double count_ratio(const std::vector<Measures>& nodes, const std::vector<float>& wanted,
                   const std::vector<float>& present, double factor, double longest)
{
    double then = 0.0, now = 0.0;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        const double length = std::min(factor * wanted[k], longest);
        then += nodes[k][kArea] / (length * length);
        now += nodes[k][kArea] / (double(present[k]) * present[k]);
    }
    return then / now;
}

/// Makes all lengths longer by one factor where the mesh would have too many vertices.
void keep_budget(const Scene& scene, const State& state, const std::vector<Measures>& nodes,
                 std::vector<float>& wanted)
{
    constexpr int kBisections = 30;
    const double longest = longest_cell(scene);
    const double most = double(scene.remesh->most_vertices) / state.mesh.vertex_count();
    const auto is_within = [&](double factor) {
        return count_ratio(nodes, wanted, state.sizing_field, factor, longest) <= most;
    };
    if (is_within(1.0)) return;
    double low = 1.0, high = scene.remesh->longest / scene.remesh->shortest;
    for (int k = 0; k < kBisections; ++k) {
        const double middle = std::sqrt(low * high);
        (is_within(middle) ? high : low) = middle;
    }
    for (float& length : wanted) length = static_cast<float>(std::min(high * length, longest));
}

/// Least edge lengths at some places, which grow less than kGradation allows away from them.
class LeastLengths {
  public:
    explicit LeastLengths(const MaterialGrid& grid)
        : grid_(grid), negative_(static_cast<std::size_t>(grid.size()), 0.0f)
    {
    }

    void require(const Vec2& X, double length)
    {
        for (const int k : find_place(grid_, X).node)
            negative_[k] = std::min(negative_[k], static_cast<float>(-length));
        is_any_ = true;
    }

    void apply(std::vector<float>& wanted)
    {
        if (!is_any_) return;
        limit_slope(grid_, kGradation, negative_);
        for (std::size_t k = 0; k < wanted.size(); ++k) wanted[k] = std::max(wanted[k], -negative_[k]);
    }

  private:
    const MaterialGrid& grid_;
    std::vector<float> negative_;  ///< m, with the opposite sign, so that the slope can be limited
    bool is_any_ = false;
};

/// Cells along sliding folds are so long that a step takes at most half of one. A fixed EOL vertex, at a
/// corner or a nail, needs fine cells more than long steps.
void require_room_for_flow(const Scene& scene, const State& state, LeastLengths& least)
{
    constexpr double kCellsPerStep = 0.5;
    for (const EolVertex& eol : state.eol) {
        if (eol.on.is_fixed()) continue;
        const int v = state.index_of(eol.vertex_id);
        const double way = scene.remesh->step * state.material_velocity[v].norm();
        const double cell = std::min(way / kCellsPerStep, longest_cell(scene));
        if (cell > shortest_cell(scene)) least.require(state.mesh.material[v], cell);
    }
}

/// A load on a point bends and stretches cloth without limit as cells become finer: there, the cells of the
/// first mesh say how wide the support is.
void require_width_of_points(const Scene& scene, const State& state, LeastLengths& least)
{
    const auto require = [&](const MaterialBox& box) {
        const Vec2 middle = 0.5 * (box.min + box.max);
        const double cell = scene.remesh->initial.length(middle);
        if ((box.max - box.min).maxCoeff() < cell) least.require(middle, std::min(cell, longest_cell(scene)));
    };
    for (const Pin& pin : scene.pins)
        if (pin.holds(state.time, state.time))
            for (const MaterialBox& part : pin.material.parts()) require(part);
    for (const Pull& pull : scene.pulls)
        if (pull.acts_between(state.time, state.time)) require(pull.material);
}

}  // namespace

std::vector<float> find_wanted_lengths(const Scene& scene, const State& state, const ClothStars& stars)
{
    const MaterialGrid& grid = scene.remesh->grid;
    const std::vector<Measures> nodes = spread(grid, state.mesh, measure_faces(scene, state, stars));
    const GridSums<kChannels> sums(grid, nodes);
    std::vector<float> wanted(nodes.size());
    for (int i = 0; i < grid.count[0]; ++i)
        for (int j = 0; j < grid.count[1]; ++j) {
            const int k = grid.index(i, j);
            const double cell = state.sizing_field[k];
            const int reach = static_cast<int>(std::lround(cell / grid.spacing));
            const Measures sum = sums.over({i - reach, j - reach}, {i + reach, j + reach});
            wanted[k] =
                static_cast<float>(kMeanEdge * find_length(scene, grid.node(i, j), sum, cell / kMeanEdge));
        }
    limit_slope(grid, kGradation, wanted);
    LeastLengths least(grid);
    require_room_for_flow(scene, state, least);
    require_width_of_points(scene, state, least);
    least.apply(wanted);
    keep_budget(scene, state, nodes, wanted);
    return wanted;
}

}  // namespace arris
