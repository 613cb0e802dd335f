// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/untangle/contours.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <optional>

#include "geometry/cgal.h"
#include "geometry/self_contact/self_intersection.h"
#include "geometry/sort_unique.h"
#include "geometry/untangle/sheet_place.h"

namespace arris {

namespace {

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
    return static_cast<int>(CGAL::orientation(to_cgal(a), to_cgal(b), to_cgal(c), to_cgal(d)));
}

std::optional<Piercing> find_piercing(const CollisionMesh& mesh, int edge, int face)
{
    const std::vector<Vec3>& x = mesh.positions;
    const MeshEdge& e = mesh.surface().edges[edge];
    const Face& f = mesh.surface().faces[face];
    const Vec3 &a = x[e.a], &b = x[e.b];
    const int side = orientation(x[f[0]], x[f[1]], x[f[2]], a);
    if (side == 0 || side != -orientation(x[f[0]], x[f[1]], x[f[2]], b)) return std::nullopt;
    for (int k = 0; k < 3; ++k)
        if (orientation(a, b, x[f[k]], x[f[(k + 1) % 3]]) != -side) return std::nullopt;

    // The edge is inside the face's prism, so all volumes have one sign; only rounding makes a sum of 0.
    Piercing piercing{edge, face, 0.5, {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}};
    const Vec3 normal = (x[f[1]] - x[f[0]]).cross(x[f[2]] - x[f[0]]);
    const double from = std::abs(normal.dot(a - x[f[0]])), to = std::abs(normal.dot(b - x[f[0]]));
    if (from + to > 0.0) piercing.along = from / (from + to);
    std::array<double, 3> volumes;
    for (int k = 0; k < 3; ++k) {
        const Vec3 p = x[f[(k + 1) % 3]] - a, q = x[f[(k + 2) % 3]] - a;
        volumes[k] = std::abs((b - a).dot(p.cross(q)));
    }
    const double sum = volumes[0] + volumes[1] + volumes[2];
    for (int k = 0; k < 3 && sum > 0.0; ++k) piercing.weights[k] = volumes[k] / sum;
    return piercing;
}

/// An end of the segment in which two faces meet.
struct SegmentEnd {
    Vec3 place;
    const Piercing* piercing;  ///< null at a common vertex
    int sheet;                 ///< of the edge that pierces
};

/// Cotangent of the angle between an edge and a face from which on their meeting point slips no faster along
/// the edge: 6 degrees. Limits how much a grazing edge counts against all others.
constexpr double kMostSlip = 10.0;

/// Derivative of `direction . end` as sheet 0 moves. The end moves with the edge's sheet, and slips along the
/// edge so that it stays in the face:
///     d end = d edge - edge (normal . (d edge - d face)) / (normal . edge)
Vec3 pull_at(const CollisionMesh& mesh, const SegmentEnd& end, const Vec3& direction)
{
    if (!end.piercing) return Vec3::Zero();  // a common vertex belongs to both sheets
    const MeshEdge& e = mesh.surface().edges[end.piercing->edge];
    const Vec3 edge = (mesh.positions[e.b] - mesh.positions[e.a]).stableNormalized();
    const Vec3 normal = normal_of(mesh, end.piercing->face);
    const double rise = normal.dot(edge), run = direction.dot(edge);
    const Vec3 slip =
        rise != 0.0 ? Vec3(std::clamp(run / rise, -kMostSlip, kMostSlip) * normal) : Vec3(Vec3::Zero());
    return end.sheet == 0 ? Vec3(direction - slip) : slip;
}

/// Adds what the faces of a pair have of the contour.
void add_pair(const CollisionMesh& mesh, const std::array<int, 2>& pair, Contour& contour)
{
    const std::vector<Vec3>& x = mesh.positions;
    std::array<std::vector<Piercing>, 2> found;
    for (int sheet = 0; sheet < 2; ++sheet)
        for (const int edge : mesh.surface().edges_of[pair[sheet]])
            if (const auto piercing = find_piercing(mesh, edge, pair[1 - sheet]))
                found[sheet].push_back(*piercing);
    std::vector<SegmentEnd> ends;
    for (int sheet = 0; sheet < 2; ++sheet)
        for (const Piercing& piercing : found[sheet]) {
            const MeshEdge& e = mesh.surface().edges[piercing.edge];
            ends.push_back({x[e.a] + piercing.along * (x[e.b] - x[e.a]), &piercing, sheet});
        }
    const Face &first = mesh.surface().faces[pair[0]], &second = mesh.surface().faces[pair[1]];
    for (const int v : first)
        if (std::find(second.begin(), second.end(), v) != second.end()) ends.push_back({x[v], nullptr, 0});
    if (ends.size() == 2 && ends[0].piercing) {
        const Vec3 way = ends[1].place - ends[0].place;
        contour.length += way.norm();
        const Vec3 direction = way.stableNormalized();
        contour.pull += pull_at(mesh, ends[1], direction) - pull_at(mesh, ends[0], direction);
    }
    for (int sheet = 0; sheet < 2; ++sheet)
        contour.piercings[sheet].insert(contour.piercings[sheet].end(), found[sheet].begin(),
                                        found[sheet].end());
}

}  // namespace

std::vector<int> Contour::faces(int sheet) const
{
    std::vector<int> crossing;
    for (const std::array<int, 2>& pair : pairs) crossing.push_back(pair[sheet]);
    sort_unique(crossing);
    return crossing;
}

Crossings find_crossings(const CollisionMesh& mesh, const std::vector<Vec3>& positions)
{
    std::vector<int> cloth(mesh.cloth_faces());
    std::iota(cloth.begin(), cloth.end(), 0);
    Crossings crossings;
    for (const auto& pair : find_self_intersections(positions, mesh.surface().faces, cloth)) {
        const StartRule rule = mesh.rule(pair[0], pair[1]);
        if (rule == StartRule::Untangle) crossings.to_untangle.push_back(pair);
        if (rule == StartRule::KeepApart) crossings.kept.push_back(pair);
    }
    return crossings;
}

std::vector<Contour> find_contours(const CollisionMesh& mesh, const std::vector<std::array<int, 2>>& pairs)
{
    const auto index_of = [&](int f, int g) {
        const std::array<int, 2> pair{std::min(f, g), std::max(f, g)};
        const auto at = std::lower_bound(pairs.begin(), pairs.end(), pair);
        return at != pairs.end() && *at == pair ? static_cast<int>(at - pairs.begin()) : -1;
    };
    std::vector<char> is_taken(pairs.size(), 0);
    std::vector<Contour> contours;
    for (std::size_t first = 0; first < pairs.size(); ++first) {
        if (is_taken[first]) continue;
        is_taken[first] = 1;
        Contour contour;
        contour.pairs.push_back(pairs[first]);
        for (std::size_t i = 0; i < contour.pairs.size(); ++i)
            for (int sheet = 0; sheet < 2; ++sheet) {
                const std::array<int, 2> pair = contour.pairs[i];
                for (const int e : mesh.surface().edges_of[pair[sheet]]) {
                    const MeshEdge& edge = mesh.surface().edges[e];
                    const int across = edge.face_left == pair[sheet] ? edge.face_right : edge.face_left;
                    const int found = across < 0 ? -1 : index_of(across, pair[1 - sheet]);
                    if (found < 0 || is_taken[found]) continue;
                    is_taken[found] = 1;
                    contour.pairs.push_back(sheet == 0 ? std::array{across, pair[1]}
                                                       : std::array{pair[0], across});
                }
            }
        for (const std::array<int, 2>& pair : contour.pairs) add_pair(mesh, pair, contour);
        for (std::vector<Piercing>& piercings : contour.piercings) {
            std::sort(piercings.begin(), piercings.end(),
                      [](const Piercing& a, const Piercing& b) { return a.key() < b.key(); });
            piercings.erase(
                std::unique(piercings.begin(), piercings.end(),
                            [](const Piercing& a, const Piercing& b) { return a.key() == b.key(); }),
                piercings.end());
        }
        contours.push_back(std::move(contour));
    }
    return contours;
}

}  // namespace arris
