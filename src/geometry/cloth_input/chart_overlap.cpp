// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/chart_overlap.h"

#include <CGAL/box_intersection_d.h>

#include <algorithm>

#include "geometry/cgal.h"

namespace arris {
namespace {

using Box = CGAL::Box_intersection_d::Box_with_handle_d<double, 2, std::vector<Face>::const_iterator>;

// Two convex polygons have disjoint interiors exactly if the line through a side of one separates them.
bool is_parted_by_side(const std::vector<Vec2>& X, const Face& face, const Face& other)
{
    for (int k = 0; k < 3; ++k) {
        const Vec2& a = X[face[k]];
        const Vec2& b = X[face[(k + 1) % 3]];
        if (std::all_of(other.begin(), other.end(),
                        [&](int v) { return exact_orientation(a, b, X[v]) <= 0; }))
            return true;
    }
    return false;
}

std::vector<Box> boxes_of(const std::vector<Vec2>& X, const std::vector<Face>& faces)
{
    std::vector<Box> boxes;
    boxes.reserve(faces.size());
    for (auto face = faces.begin(); face != faces.end(); ++face) {
        CGAL::Bbox_2 box;
        for (const int v : *face) box += to_cgal(X[v]).bbox();
        boxes.emplace_back(box, face);
    }
    return boxes;
}

}  // namespace

std::optional<std::array<int, 2>> find_overlap(const std::vector<Vec2>& material,
                                               const std::vector<Face>& faces)
{
    std::optional<std::array<int, 2>> lowest;
    const auto check = [&](const Box& p, const Box& q) {
        if (is_parted_by_side(material, *p.handle(), *q.handle())) return;
        if (is_parted_by_side(material, *q.handle(), *p.handle())) return;
        std::array<int, 2> pair = {static_cast<int>(p.handle() - faces.begin()),
                                   static_cast<int>(q.handle() - faces.begin())};
        std::sort(pair.begin(), pair.end());
        if (!lowest || pair < *lowest) lowest = pair;
    };
    std::vector<Box> boxes = boxes_of(material, faces);
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), check);
    return lowest;
}

}  // namespace arris
