// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/face_faults.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "geometry/cloth/euler_characteristic.h"
#include "geometry/sort_unique.h"
#include "geometry/tolerances.h"

namespace arris {
namespace {

constexpr const char* kStartApart = "start them apart, by the cloth's thickness or more";

/// One side of a face, from corner `corner` to the next.
struct Side {
    int low, high;  // places
    int face, corner;
    bool is_forward;  // runs from `low` to `high`
};

/// The sides of all faces, those of one edge together.
std::vector<Side> sorted_sides(const PlacedFaces& mesh)
{
    std::vector<Side> sides;
    for (int f = 0; f < static_cast<int>(mesh.faces.size()); ++f)
        for (int k = 0; k < 3; ++k) {
            const int a = mesh.faces[f][k], b = mesh.faces[f][(k + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), f, k, a < b});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) {
        return std::tie(s.low, s.high, s.face) < std::tie(t.low, t.high, t.face);
    });
    return sides;
}

/// The sides of the edge whose first one is `sides[begin]`.
std::span<const Side> sides_of_edge(const std::vector<Side>& sides, std::size_t begin)
{
    std::size_t end = begin + 1;
    while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high)
        ++end;
    return {sides.data() + begin, end - begin};
}

/// Unit direction from the edge into the side's face, perpendicular to the edge.
Vec3 inward(const PlacedFaces& mesh, const Side& side)
{
    const Vec3& a = mesh.places[side.low];
    const Vec3 along = (mesh.places[side.high] - a).normalized();
    const Vec3 way = mesh.places[mesh.faces[side.face][(side.corner + 2) % 3]] - a;
    return (way - way.dot(along) * along).normalized();
}

/// Whether two of the faces lie on each other beside their edge.
bool has_layers(const PlacedFaces& mesh, std::span<const Side> edge)
{
    for (std::size_t i = 0; i < edge.size(); ++i)
        for (std::size_t j = i + 1; j < edge.size(); ++j)
            if ((inward(mesh, edge[i]) - inward(mesh, edge[j])).norm() <= kSinglePrecision) return true;
    return false;
}

/// "line 7", "lines 7 and 9", "lines 1, 2, 3, 4, 5, 6, 7, 8 and 12 more".
std::string name_lines(std::vector<int> lines)
{
    constexpr std::size_t kMostNamed = 8;
    sort_unique(lines);
    if (lines.size() == 1) return fmt::format("line {}", lines[0]);
    const std::size_t named = std::min(lines.size() - 1, kMostNamed);
    const std::span<const int> first(lines.data(), named);
    if (named + 1 == lines.size())
        return fmt::format("lines {} and {}", fmt::join(first, ", "), lines.back());
    return fmt::format("lines {} and {} more", fmt::join(first, ", "), lines.size() - named);
}

std::string name_faces(const PlacedFaces& mesh, const std::vector<int>& faces)
{
    std::vector<int> lines;
    for (const int f : faces) lines.push_back(mesh.lines[f]);
    sort_unique(lines);
    return lines.size() == 1 ? mesh.describe(faces[0]) : "the faces of " + name_lines(lines);
}

/// Faces in parts that are joined by edges, ascending by their first face.
std::vector<std::vector<int>> find_parts(const PlacedFaces& mesh, const std::vector<Side>& sides)
{
    std::vector<int> root(mesh.faces.size());
    for (std::size_t f = 0; f < root.size(); ++f) root[f] = static_cast<int>(f);
    const auto root_of = [&](int f) {
        while (root[f] != f) f = root[f] = root[root[f]];
        return f;
    };
    for (std::size_t i = 0; i < sides.size(); i += sides_of_edge(sides, i).size())
        for (const Side& side : sides_of_edge(sides, i)) {
            const int a = root_of(sides[i].face), b = root_of(side.face);
            root[std::max(a, b)] = std::min(a, b);
        }
    std::map<int, std::vector<int>> parts;
    for (int f = 0; f < static_cast<int>(root.size()); ++f) parts[root_of(f)].push_back(f);
    std::vector<std::vector<int>> listed;
    for (auto& [first, faces] : parts) listed.push_back(std::move(faces));
    return listed;
}

/// Faces of the part that run against the part's majority; of two halves, the one without the first face.
std::vector<int> find_minority(const std::vector<int>& part, const std::vector<int>& turns)
{
    std::vector<int> with_first, others;
    for (const int f : part) (turns[f] == turns[part[0]] ? with_first : others).push_back(f);
    return others.size() <= with_first.size() ? others : with_first;
}

std::string describe_turned(const PlacedFaces& mesh, const std::vector<int>& turned)
{
    const bool is_one = turned.size() == 1;
    return fmt::format(
        "{} of {} triangles {} turned over against {} neighbours: {}; allowed: faces that all "
        "run the same way (reverse the order of {} corners)",
        turned.size(), mesh.faces.size(), is_one ? "is" : "are", is_one ? "its" : "their",
        name_faces(mesh, turned), is_one ? "its" : "their");
}

std::string describe_fold(const PlacedFaces& mesh, std::span<const Side> edge)
{
    ClothMesh cloth;
    cloth.world = mesh.places;
    cloth.faces = mesh.faces;
    return fmt::format(
        "the chart is folded at edge ({}, {}), between {}: one of them is clockwise in material space; "
        "allowed: UVs at which no two faces overlap{}",
        mesh.numbers[edge[0].low], mesh.numbers[edge[0].high], name_faces(mesh, {edge[0].face, edge[1].face}),
        euler_characteristic(cloth) > 0 ? "" : "; a tube cannot be laid out with one UV at each place");
}

}  // namespace

std::string PlacedFaces::describe(int face) const
{
    const Vec3& a = places[faces[face][0]];
    return fmt::format("the face of line {} (at {:.6g}, {:.6g}, {:.6g} m)", lines[face], a.x(), a.y(), a.z());
}

std::string find_doubled_face(const PlacedFaces& mesh)
{
    const auto sorted = [](Face face) {
        std::sort(face.begin(), face.end());
        return face;
    };
    std::map<Face, int> seen;
    std::vector<std::array<int, 2>> doubled;
    for (int f = 0; f < static_cast<int>(mesh.faces.size()); ++f) {
        const auto [first, is_new] = seen.emplace(sorted(mesh.faces[f]), f);
        if (!is_new) doubled.push_back({first->second, f});
    }
    const auto is_same = [&](const std::array<int, 2>& pair) {
        return sorted(mesh.corners[pair[0]]) == sorted(mesh.corners[pair[1]]);
    };
    if (doubled.empty()) return {};
    if (const auto same = std::find_if(doubled.begin(), doubled.end(), is_same); same != doubled.end())
        return fmt::format("{} is there twice, first in line {}", mesh.describe((*same)[1]),
                           mesh.lines[(*same)[0]]);
    const auto& [first, second] = doubled[0];
    return fmt::format("two layers coincide, in {} of {} triangles: {} lies on that of line {}; {}",
                       doubled.size(), mesh.faces.size(), mesh.describe(second), mesh.lines[first],
                       kStartApart);
}

std::string find_branching_edge(const PlacedFaces& mesh)
{
    const std::vector<Side> sides = sorted_sides(mesh);
    for (std::size_t i = 0; i < sides.size(); i += sides_of_edge(sides, i).size()) {
        const std::span<const Side> edge = sides_of_edge(sides, i);
        if (edge.size() <= 2) continue;
        std::vector<int> lines;
        for (const Side& side : edge) lines.push_back(mesh.lines[side.face]);
        const Vec3 middle = 0.5 * (mesh.places[edge[0].low] + mesh.places[edge[0].high]);
        return fmt::format(
            "edge ({}, {}) has more than two faces ({}), at {:.6g}, {:.6g}, {:.6g} m; {} (vertices "
            "as the file numbers them, counted from 1, and faces by their line)",
            mesh.numbers[edge[0].low], mesh.numbers[edge[0].high], fmt::join(lines, ", "), middle.x(),
            middle.y(), middle.z(),
            has_layers(mesh, edge) ? fmt::format("two layers coincide there: {}", kStartApart)
                                   : "allowed: cloth that does not branch");
    }
    return {};
}

std::string explain_turns(const PlacedFaces& mesh, const std::vector<int>& turns)
{
    const std::vector<Side> sides = sorted_sides(mesh);
    const std::vector<std::vector<int>> parts = find_parts(mesh, sides);
    std::vector<char> has_turned(mesh.faces.size(), 0);  // beside the face, one runs against it
    std::span<const Side> fold;
    for (std::size_t i = 0; i < sides.size(); i += sides_of_edge(sides, i).size()) {
        const std::span<const Side> edge = sides_of_edge(sides, i);
        if (edge.size() != 2) continue;
        if (edge[0].is_forward == edge[1].is_forward)
            has_turned[edge[0].face] = has_turned[edge[1].face] = 1;
        else if (turns[edge[0].face] != turns[edge[1].face] && fold.empty())
            fold = edge;
    }
    std::vector<int> turned;
    for (const std::vector<int>& part : parts) {
        if (std::none_of(part.begin(), part.end(), [&](int f) { return has_turned[f] != 0; })) continue;
        const std::vector<int> minority = find_minority(part, turns);
        turned.insert(turned.end(), minority.begin(), minority.end());
    }
    return turned.empty() ? describe_fold(mesh, fold) : describe_turned(mesh, turned);
}

}  // namespace arris
