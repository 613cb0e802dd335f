// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where the cloth bends over a sharp edge, a frame's mesh has EOL vertices on that edge, and the constant
// mesh has a face that bridges it. Moving vertices of the constant mesh onto the edge would shorten that
// bridge, but they would then slide over the material, and textures with them. So every vertex stays on its
// material point.
#include "app/export/resampled_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <unordered_map>

#include "geometry/cloth/material_box.h"
#include "geometry/cloth/material_locator.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

constexpr int kMostCells = 10000;             // along a side; 2e8 faces are more than any reader takes
constexpr double kRectangleTolerance = 1e-6;  // relative, of area and border length

double twice_area_of(const std::vector<Vec2>& material, const Face& face)
{
    return twice_area(material[face[0]], material[face[1]], material[face[2]]);
}

Vec2 centroid(const std::vector<Vec2>& material, const Face& face)
{
    return (material[face[0]] + material[face[1]] + material[face[2]]) / 3.0;
}

/// Border edges, each with its face: the directed edges without an opposite.
std::map<std::array<int, 2>, int> find_border(const std::vector<Face>& faces)
{
    std::map<std::array<int, 2>, int> border;
    for (int f = 0; f < static_cast<int>(faces.size()); ++f)
        for (int k = 0; k < 3; ++k) {
            const int a = faces[f][k], b = faces[f][(k + 1) % 3];
            if (border.erase({b, a}) == 0) border.emplace(std::array<int, 2>{a, b}, f);
        }
    return border;
}

bool is_near(double value, double wanted)
{
    return std::abs(value - wanted) <= kRectangleTolerance * wanted;
}

/// The box around the cloth. Throws unless the cloth fills it, without slits and holes.
MaterialBox require_rectangle(const Frame& first)
{
    Eigen::AlignedBox2d box;
    for (const Vec2& X : first.material) box.extend(X);
    double area = 0.0, length = 0.0;
    for (const Face& face : first.corners()) area += 0.5 * twice_area_of(first.material, face);
    for (const auto& [edge, face] : find_border(first.corners()))
        length += (first.material[edge[1]] - first.material[edge[0]]).norm();
    if (first.faces.empty() || !is_near(area, box.volume()) || !is_near(length, 2.0 * box.sizes().sum()))
        throw InputError(
            "--grid: the cloth is not one whole rectangle in material space; allowed: --topology constant "
            "without --grid, which takes the first frame's mesh");
    return {box.min(), box.max()};
}

ConstantMesh make_grid(const MaterialBox& box, const GridSize& grid)
{
    ConstantMesh mesh;
    const auto at = [&](double low, double high, int i, int n) {
        return i == n ? high : low + (high - low) * i / n;  // the last one exactly on the border
    };
    for (int j = 0; j <= grid.v; ++j)
        for (int i = 0; i <= grid.u; ++i) {
            mesh.ids.push_back(static_cast<std::uint32_t>(mesh.material.size()));
            mesh.material.emplace_back(at(box.min.x(), box.max.x(), i, grid.u),
                                       at(box.min.y(), box.max.y(), j, grid.v));
        }
    for (int j = 0; j < grid.v; ++j)
        for (int i = 0; i < grid.u; ++i) {
            const int a = j * (grid.u + 1) + i, b = a + 1, d = a + grid.u + 1, c = d + 1;
            // Diagonals alternate, so that the grid prefers no direction of folds.
            if ((i + j) % 2 == 0)
                mesh.faces.insert(mesh.faces.end(), {Face{a, b, c}, Face{a, c, d}});
            else
                mesh.faces.insert(mesh.faces.end(), {Face{a, b, d}, Face{b, c, d}});
        }
    return mesh;
}

/// What does not change from frame to frame.
struct Sampling {
    FrameSource frames;
    ConstantMesh mesh;
    std::vector<int> border_faces;  ///< a border face of each vertex on the border, else -1
    double tolerance = 0.0;         ///< m, to which a point may lie outside the cloth
};

Sampling make_sampling(const FrameSource& frames, const ConstantMesh& mesh)
{
    Sampling sampling{frames, mesh, std::vector<int>(mesh.material.size(), -1),
                      kMaterialTolerance * material_size(mesh.material)};
    for (const auto& [edge, face] : find_border(mesh.faces))
        for (const int v : edge) sampling.border_faces[v] = face;
    return sampling;
}

[[noreturn]] void refuse_hole(std::size_t i, const Vec2& X)
{
    throw InputError(
        fmt::format("frame {}: the cloth has no material point ({}, {}) m, which the constant mesh needs", i,
                    X[0], X[1]));
}

/// Finds vertices of the constant mesh in one frame.
class FramePoints {
  public:
    FramePoints(const Sampling& sampling, const Frame& frame, std::size_t i)
        : sampling_(sampling),
          frame_(frame),
          i_(i),
          locator_(frame.material, frame.corners()),
          corners_(frame.world.size(), {-1, Vec3::Zero()})
    {
        for (std::size_t v = 0; v < frame.ids.size(); ++v) by_id_.emplace(frame.ids[v], v);
        for (int f = 0; f < static_cast<int>(frame.faces.size()); ++f)
            for (int k = 0; k < 3; ++k) corners_[frame.faces[f][k]] = {f, Vec3::Unit(k)};
    }

    MaterialLocation vertex(std::size_t v) const
    {
        const Vec2& X = sampling_.mesh.material[v];
        // The frame's own vertex, if there is one at this point: also right where two borders touch.
        const auto own = by_id_.find(sampling_.mesh.ids[v]);
        if (own != by_id_.end() && frame_.material[own->second] == X && corners_[own->second].face >= 0)
            return corners_[own->second];
        const int f = sampling_.border_faces[v];
        const Vec2 inside = f < 0 ? X : centroid(sampling_.mesh.material, sampling_.mesh.corners()[f]);
        return require(f < 0 ? locator_.locate(X, sampling_.tolerance)
                             : locator_.locate_on_border(X, inside, sampling_.tolerance),
                       X);
    }

    int face_at(const Vec2& X) const { return require(locator_.locate(X, sampling_.tolerance), X).face; }

  private:
    MaterialLocation require(const MaterialLocation& found, const Vec2& X) const
    {
        if (found.face < 0) refuse_hole(i_, X);
        return found;
    }

    const Sampling& sampling_;
    const Frame& frame_;
    std::size_t i_;
    MaterialLocator locator_;
    std::vector<MaterialLocation> corners_;
    std::unordered_map<std::uint32_t, std::size_t> by_id_;
};

Vec3 interpolate(const std::vector<Vec3>& values, const Face& face, const Vec3& weights)
{
    return weights[0] * values[face[0]] + weights[1] * values[face[1]] + weights[2] * values[face[2]];
}

void sample_vertices(const Sampling& sampling, const Frame& frame, const FramePoints& points, Frame& result)
{
    const std::size_t count = sampling.mesh.ids.size();
    result.material = sampling.mesh.material;
    result.ids = sampling.mesh.ids;
    result.eol.assign(count, 0);
    for (std::size_t v = 0; v < count; ++v) {
        const MaterialLocation at = points.vertex(v);
        const Face& face = frame.faces[at.face];
        result.world.push_back(interpolate(frame.world, face, at.weights));
        result.material_velocity.push_back(interpolate(frame.material_velocity, face, at.weights));
        int nearest = 0;
        at.weights.maxCoeff(&nearest);
        result.contact.push_back(frame.contact[face[nearest]]);
    }
    result.vertex_velocity = result.material_velocity;
}

void sample_faces(const Sampling& sampling, const Frame& frame, const FramePoints& points, Frame& result)
{
    result.faces = sampling.mesh.faces;
    result.pieces = sampling.mesh.pieces;
    result.face_points = sampling.mesh.face_points;
    result.seam_vertices = sampling.mesh.seam_vertices;
    for (const Face& face : sampling.mesh.corners()) {
        const int f = points.face_at(centroid(sampling.mesh.material, face));
        const double share =
            twice_area_of(sampling.mesh.material, face) / twice_area_of(frame.material, frame.corners()[f]);
        result.strain.push_back(frame.strain[f]);
        result.stretch_energy.push_back(share * frame.stretch_energy[f]);
        result.bending_energy.push_back(share * frame.bending_energy[f]);
    }
}

}  // namespace

GridSize parse_grid(const std::string& text)
{
    GridSize grid;
    const char* const end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, grid.u);
    const bool has_both = first.ec == std::errc() && first.ptr != end && *first.ptr == 'x';
    const auto second = has_both ? std::from_chars(first.ptr + 1, end, grid.v) : first;
    const auto is_allowed = [](int cells) { return cells >= 1 && cells <= kMostCells; };
    if (!has_both || second.ec != std::errc() || second.ptr != end || !is_allowed(grid.u) ||
        !is_allowed(grid.v))
        throw InputError(fmt::format(
            "--grid: \"{}\" is no grid; allowed: cells along u and v, 1 to {}, as 40x30", text, kMostCells));
    return grid;
}

ConstantMesh make_constant_mesh(const Frame& first, const std::optional<GridSize>& grid)
{
    if (grid) return make_grid(require_rectangle(first), *grid);
    return {first.material, first.faces, first.ids, first.pieces, first.face_points, first.seam_vertices};
}

FrameSource resampled_frames(const FrameSource& frames, const ConstantMesh& mesh)
{
    const auto sampling = std::make_shared<const Sampling>(make_sampling(frames, mesh));
    return {frames.count, [sampling](std::size_t i) {
                const Frame frame = sampling->frames.read(i);
                const FramePoints points(*sampling, frame, i);
                Frame result;
                sample_vertices(*sampling, frame, points, result);
                sample_faces(*sampling, frame, points, result);
                return result;
            }};
}

}  // namespace arris
