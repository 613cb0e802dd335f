// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/self_contact/self_intersection.h"

#include <algorithm>
#include <numeric>

#include "geometry/batches.h"
#include "geometry/box_tree.h"
#include "geometry/cgal.h"

namespace arris {

namespace {

/// The common vertices of two faces first, the others after them, each part in the faces' own order.
struct SharedFirst {
    std::array<Point3, 3> first, second;
    int shared = 0;

    SharedFirst(const std::vector<Vec3>& positions, const Face& a, const Face& b)
    {
        for (int pass = 0; pass < 2; ++pass) {
            int at_a = shared, at_b = shared;
            for (const int v : a) {
                const bool is_shared = std::find(b.begin(), b.end(), v) != b.end();
                if (is_shared == (pass == 0)) first[at_a++] = to_cgal(positions[v]);
                if (is_shared && pass == 0) second[at_b++] = to_cgal(positions[v]);
            }
            for (const int v : b)
                if (pass == 1 && std::find(a.begin(), a.end(), v) == a.end())
                    second[at_b++] = to_cgal(positions[v]);
            if (pass == 0) shared = at_a;
        }
    }
};

/// Whether faces that share an edge lie on each other: coplanar, with their third vertices on one side.
bool is_folded_flat(const SharedFirst& at)
{
    const Point3 &a = at.first[0], &b = at.first[1], &c = at.first[2], &d = at.second[2];
    return CGAL::orientation(a, b, c, d) == CGAL::COPLANAR &&
           CGAL::coplanar_orientation(a, b, c, d) == CGAL::POSITIVE;
}

}  // namespace

bool is_crossing(const std::vector<Vec3>& positions, const Face& first, const Face& second)
{
    const SharedFirst at(positions, first, second);
    using Triangle = Kernel::Triangle_3;
    using Segment = Kernel::Segment_3;
    const auto triangle = [](const std::array<Point3, 3>& p) { return Triangle(p[0], p[1], p[2]); };
    const Triangle a = triangle(at.first), b = triangle(at.second);
    if (at.shared == 3) return true;
    if (a.is_degenerate() || b.is_degenerate()) return at.shared == 0;  // never proven apart
    if (at.shared == 0) return CGAL::do_intersect(a, b);
    if (at.shared == 2) return is_folded_flat(at);
    return CGAL::do_intersect(Segment(at.first[1], at.first[2]), b) ||
           CGAL::do_intersect(Segment(at.second[1], at.second[2]), a);
}

std::vector<std::array<int, 2>> find_self_intersections(const std::vector<Vec3>& positions,
                                                        const std::vector<Face>& faces,
                                                        const std::vector<int>& of)
{
    std::vector<BoxTree::Box> boxes(faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (const int v : faces[f]) boxes[f].extend(positions[v]);
    const BoxTree tree(boxes);
    using Pair = std::array<int, 2>;
    const auto find = [&](int begin, int end, std::vector<Pair>& crossing) {
        std::vector<int> near;
        for (int i = begin; i < end; ++i) {
            const int f = of[i];
            tree.find(boxes[f], near);
            for (const int g : near) {
                const bool comes_again = g < f && std::binary_search(of.begin(), of.end(), g);
                if (g != f && !comes_again && is_crossing(positions, faces[f], faces[g]))
                    crossing.push_back({std::min(f, g), std::max(f, g)});
            }
        }
    };
    std::vector<Pair> all = collect_in_batches<Pair>(static_cast<int>(of.size()), find);
    std::sort(all.begin(), all.end());
    return all;
}

std::vector<std::array<int, 2>> find_self_intersections(const std::vector<Vec3>& positions,
                                                        const std::vector<Face>& faces)
{
    std::vector<int> all(faces.size());
    std::iota(all.begin(), all.end(), 0);
    return find_self_intersections(positions, faces, all);
}

}  // namespace arris
