// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/study/shape_distance.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "geometry/box_tree.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

constexpr int kPointsASide = 64;
constexpr double kOnBorder = 1e-9;  // of a barycentric weight: a point on an edge belongs to both faces

/// Finds the world position of material points.
class MaterialMap {
  public:
    explicit MaterialMap(const Frame& frame) : frame_(frame), tree_(material_boxes(frame)) {}

    std::optional<Vec3> find(const Vec2& point) const
    {
        std::vector<int> faces;
        const Vec3 at(point.x(), point.y(), 0.0);
        tree_.find(BoxTree::Box(at, at), faces);
        for (const int face : faces)
            if (const std::optional<Vec3> weights = weights_in(face, point)) {
                const auto& corners = frame_.faces[face];
                return (*weights)[0] * frame_.world[corners[0]] + (*weights)[1] * frame_.world[corners[1]] +
                       (*weights)[2] * frame_.world[corners[2]];
            }
        return std::nullopt;
    }

  private:
    static std::vector<BoxTree::Box> material_boxes(const Frame& frame)
    {
        std::vector<BoxTree::Box> boxes;
        for (const auto& face : frame.corners()) {
            BoxTree::Box box;
            for (const int corner : face)
                box.extend(Vec3(frame.material[corner].x(), frame.material[corner].y(), 0.0));
            boxes.push_back(box);
        }
        return boxes;
    }

    static double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

    std::optional<Vec3> weights_in(int face, const Vec2& point) const
    {
        const auto& corners = frame_.corners()[face];
        const Vec2 &a = frame_.material[corners[0]], &b = frame_.material[corners[1]],
                   &c = frame_.material[corners[2]];
        const double area = cross(b - a, c - a);
        if (!(area > 0.0)) return std::nullopt;
        const double of_b = cross(point - a, c - a) / area, of_c = cross(b - a, point - a) / area;
        const Vec3 weights(1.0 - of_b - of_c, of_b, of_c);
        if (weights.minCoeff() < -kOnBorder) return std::nullopt;
        return weights;
    }

    const Frame& frame_;
    BoxTree tree_;
};

}  // namespace

ShapeDistance measure_shape_distance(const Frame& cloth, const Frame& reference)
{
    Eigen::AlignedBox2d box;
    for (const Vec2& point : reference.material) box.extend(point);
    const MaterialMap first(cloth), second(reference);
    ShapeDistance distance;
    int one_has = 0;
    double sum = 0.0;
    for (int i = 0; i < kPointsASide; ++i)
        for (int k = 0; k < kPointsASide; ++k) {
            const Vec2 share((i + 0.5) / kPointsASide, (k + 0.5) / kPointsASide);
            const Vec2 point = box.min() + box.sizes().cwiseProduct(share);
            const std::optional<Vec3> a = first.find(point), b = second.find(point);
            one_has += a || b;
            if (!a || !b) continue;
            const double apart = (*a - *b).norm();
            sum += apart;
            distance.greatest = std::max(distance.greatest, apart);
            ++distance.points;
        }
    if (2 * distance.points < one_has || distance.points == 0)
        throw InputError(
            fmt::format("error.shape: of {} material points only {} are in both cloths; allowed: "
                        "cloths of equal material",
                        one_has, distance.points));
    distance.mean = sum / distance.points;
    return distance;
}

double world_diagonal(const Frame& cloth)
{
    Eigen::AlignedBox3d box;
    for (const Vec3& point : cloth.world) box.extend(point);
    return box.diagonal().norm();
}

}  // namespace arris
