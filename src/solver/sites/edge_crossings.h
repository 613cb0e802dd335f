// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "solver/sites/feature_sites.h"

namespace arris {

/// Places where edges of the cloth cross the feature edges of one obstacle. At a convex edge this is where
/// the cloth's edge crosses the plane in which an EOL vertex may move, no higher than cloth that lies on the
/// feature. On a wire or border, whose plane turns with the cloth, this is the nearest point.
class EdgeCrossings {
  public:
    /// `stars` are the state's.
    EdgeCrossings(const Scene& scene, const State& state, const ClothStars& stars, std::int32_t obstacle);

    /// Crossing of the cloth's edge from vertex a to b with feature edge `feature`, where it lies or presses
    /// along `normal` (in the obstacle's frame). Nothing at an EOL vertex.
    std::optional<FeatureSite> find(int a, int b, int feature, const Vec3& normal) const;

    /// `find` past an end of a wire, on the line that goes on from there.
    std::optional<FeatureSite> find_past_end(int a, int b, int feature, const Vec3& normal) const;

    /// `find` for an edge that pressed. By now the edge may be higher, or end before it crosses; the crossing
    /// is then on an edge that continues from its end.
    std::optional<FeatureSite> find_pressed(int a, int b, int feature, const Vec3& normal) const;

    /// Position of a site on a cloth's edge, in the obstacle's frame.
    Vec3 place_of(const FeatureSite& site) const;

    /// Whether a site on a cloth's edge is past an end of its feature.
    bool is_past_end(int feature, const FeatureSite& site) const;

    const Obstacle& obstacle() const { return obstacle_; }
    std::int32_t obstacle_index() const { return o_; }
    const State& state() const { return state_; }
    const ClothStars& stars() const { return stars_; }

    /// Positions of the cloth in the obstacle's frame.
    const std::vector<Vec3>& positions() const { return positions_; }

    /// Neighbours of a vertex of the cloth, ascending.
    std::vector<int> neighbours(int vertex) const;

  private:
    struct Reach {
        double in_plane;  ///< thicknesses from the plane, within which an end of an edge is the crossing
        double height;    ///< m, above the feature, up to which cloth lies on it
        bool is_past_end = false;  ///< whether sites inside the cloth may be past an end of a wire
    };
    std::optional<FeatureSite> find(int a, int b, int feature, const Vec3& normal, const Reach& reach) const;
    std::optional<double> find_share(int a, int b, int feature, const Reach& reach) const;
    std::array<Vec3, 2> segment_at(int v, int feature) const;
    struct FoldEnd {
        int vertex;
        Vec3 from;  ///< to the vertex, from its nearest point on the feature
    };
    bool is_beside_fold(int a, int b, int feature, const Vec2& X) const;
    std::optional<FoldEnd> find_fold_around(int a, int b, int feature) const;
    std::optional<FeatureSite> find_on_fold(const FoldEnd& fold, int feature) const;
    double find_rise(int a, int b, int feature, const Vec3& normal) const;
    std::optional<FeatureSite> find_beyond_end(int a, int b, int feature, const Vec3& normal) const;
    bool is_eol(int v) const { return state_.eol_entry(state_.ids[v]) >= 0; }

    const State& state_;
    const ClothStars& stars_;
    const MovingObstacle& moving_;
    ObstaclePose obstacle_;  ///< at the state's time
    std::int32_t o_;
    double thickness_;
    MeshTarget target_;
    std::vector<Vec3> positions_;
};

}  // namespace arris
