// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth/material_locator.h"

#include <algorithm>
#include <array>

#include "geometry/cgal.h"

namespace arris {
namespace {

// Share of the way into a face that tells the two sides of a border apart, and stays far below what is
// visible.
constexpr double kWayInside = 1e-6;

using Corners = std::array<Vec2, 3>;

Vec2 nearest_on_segment(const Vec2& a, const Vec2& b, const Vec2& p)
{
    const Vec2 d = b - a;
    return a + std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0) * d;
}

// The point on the face's border nearest to `point`, which lies outside the face.
Vec2 nearest_on_border(const Corners& X, const Vec2& point)
{
    Vec2 nearest = X[0];
    for (int k = 0; k < 3; ++k) {
        const Vec2 candidate = nearest_on_segment(X[k], X[(k + 1) % 3], point);
        if ((candidate - point).squaredNorm() < (nearest - point).squaredNorm()) nearest = candidate;
    }
    return nearest;
}

bool contains(const Corners& X, const Vec2& point)
{
    for (int k = 0; k < 3; ++k)
        if (exact_orientation(X[k], X[(k + 1) % 3], point) < 0) return false;
    return true;
}

Vec3 barycentric(const Corners& X, const Vec2& point)
{
    Vec3 weights(twice_area(point, X[1], X[2]), twice_area(X[0], point, X[2]), twice_area(X[0], X[1], point));
    weights = weights.cwiseMax(0.0);
    return weights / weights.sum();
}

Corners corners_of(const std::vector<Vec2>& material, const Face& face)
{
    return {material[face[0]], material[face[1]], material[face[2]]};
}

/// The best of the faces that were offered: the lowest that contains the point, else the nearest within the
/// tolerance. Independent of the order of the offers.
class BestFace {
  public:
    BestFace(const Vec2& point, double tolerance) : point_(point), least_(tolerance) {}

    void offer(int f, const Corners& X)
    {
        if (exact_orientation(X[0], X[1], X[2]) <= 0) return;  // has no barycentric coordinates
        if (contains(X, point_)) {
            if (is_inside_ && found_.face < f) return;
            found_ = {f, barycentric(X, point_)};
            is_inside_ = true;
        }
        if (is_inside_) return;
        const Vec2 on_border = nearest_on_border(X, point_);
        const double distance = (on_border - point_).norm();
        // Ties go by index; the first face within the tolerance has none to compare with.
        const bool is_tie = !(distance > least_) && (found_.face < 0 || f < found_.face);
        if (!(distance < least_) && !is_tie) return;
        least_ = distance;
        found_ = {f, barycentric(X, on_border)};
    }

    const MaterialLocation& found() const { return found_; }

  private:
    Vec2 point_;
    double least_;
    bool is_inside_ = false;
    MaterialLocation found_;
};

BoxTree::Box flat_box(const Eigen::AlignedBox2d& box)
{
    return {Vec3(box.min().x(), box.min().y(), 0.0), Vec3(box.max().x(), box.max().y(), 0.0)};
}

BoxTree make_tree(const std::vector<Vec2>& material, const std::vector<Face>& faces)
{
    std::vector<BoxTree::Box> boxes;
    boxes.reserve(faces.size());
    for (const Face& face : faces) {
        Eigen::AlignedBox2d box;
        for (const int v : face) box.extend(material[v]);
        boxes.push_back(flat_box(box));
    }
    return BoxTree(boxes);
}

}  // namespace

MaterialLocation locate(const ClothMesh& mesh, const Vec2& point)
{
    const double tolerance = kMaterialTolerance * material_size(mesh.material);
    const Eigen::AlignedBox2d near(point.array() - tolerance, point.array() + tolerance);
    BestFace best(point, tolerance);
    for (int f = 0; f < mesh.face_count(); ++f) {
        const Corners X = mesh.corners(f);
        const Eigen::AlignedBox2d box(X[0].cwiseMin(X[1]).cwiseMin(X[2]), X[0].cwiseMax(X[1]).cwiseMax(X[2]));
        if (box.intersects(near)) best.offer(f, X);
    }
    return best.found();
}

MaterialLocator::MaterialLocator(const std::vector<Vec2>& material, const std::vector<Face>& faces)
    : material_(material), faces_(faces), tree_(make_tree(material, faces))
{
}

MaterialLocation MaterialLocator::locate(const Vec2& point, double tolerance) const
{
    BestFace best(point, tolerance);
    tree_.visit(flat_box({point.array() - tolerance, point.array() + tolerance}),
                [&](int f) { best.offer(f, corners_of(material_, faces_[f])); });
    return best.found();
}

MaterialLocation MaterialLocator::locate_on_border(const Vec2& point, const Vec2& inside,
                                                   double tolerance) const
{
    MaterialLocation found = locate(point + kWayInside * (inside - point), tolerance);
    if (found.face < 0) return found;
    const Corners X = corners_of(material_, faces_[found.face]);
    found.weights = barycentric(X, contains(X, point) ? point : nearest_on_border(X, point));
    return found;
}

}  // namespace arris
