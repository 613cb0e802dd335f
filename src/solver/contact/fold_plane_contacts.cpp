// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/contact/fold_plane_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "geometry/obstacle/feature_path.h"

namespace arris {

namespace {

// Angles from the plane, rad. A vertex farther than kFarRound cannot pass the plane in one step. A vertex
// more than kWrong on the wrong side, where the cloth has passed through itself, is left there.
constexpr double kFarRound = 1.0, kWrong = 0.5;

// Reach of a fold plane from its EOL vertex, in the material: kCells mean distances to its neighbours, plus
// the flow during kTime. Cloth that has swung past the plane farther down arrives at the wire on its wrong
// side. Nothing can be merged across the wire there, so such a vertex stops the whole cloth. kTime is
// therefore the time in which a metre of cloth slides off, not the time of a swing. The plane of a moving
// wire pushes the cloth, more so the farther it reaches: kTimeOfMoving.
constexpr double kCells = 4.0, kTime = 1.0, kTimeOfMoving = 0.2;  // s

class FoldPlaneSearch {
  public:
    FoldPlaneSearch(const std::vector<MovingObstacle>& obstacles, const State& state, const ClothStars& stars,
                    const std::vector<EolCoordinates>& eol,
                    const std::vector<const std::vector<Vec3>*>& positions)
        : obstacles_(obstacles),
          state_(state),
          stars_(stars),
          eol_(eol),
          positions_(positions),
          is_eol_(state.ids.size(), 0)
    {
        for (const EolCoordinates& at : eol) is_eol_[at.vertex] = 1;
    }

    std::vector<FoldPlaneContact> run()
    {
        for (const EolCoordinates& at : eol_) {
            const EolVertex& vertex = state_.eol[at.entry];
            if (!is_on_wire(vertex)) continue;
            const Wire wire = {vertex.on.obstacle, polyline_of(vertex)};
            const double reach = find_reach(at.vertex, wire);
            for_neighbours(at.vertex, wire, [&](int, int w) {
                const double angle = angle_behind(at.frame, place_of(w, wire));
                add(planes_, {w, wire}, {&at, angle < 0.0 ? -1 : 1, std::abs(angle), reach});
            });
        }
        for (Planes layer = planes_; !layer.empty();) {
            layer = find_beyond(layer);
            planes_.insert(layer.begin(), layer.end());
        }
        return contacts();
    }

  private:
    using Wire = std::array<int, 2>;  ///< obstacle, polyline
    struct Key {
        int vertex;
        Wire wire;
        auto operator<=>(const Key&) const = default;
    };
    struct Plane {
        const EolCoordinates* at;
        int side;      ///< 0 where two planes disagree
        double angle;  ///< rad, to its side
        double reach;  ///< m, material, from its vertex
    };
    using Planes = std::map<Key, Plane>;

    bool is_on_wire(const EolVertex& vertex) const
    {
        return !vertex.on.is_corner() &&
               obstacles_[vertex.on.obstacle].shape().features().edges[vertex.on.index].kind ==
                   FeatureKind::Wire;
    }

    int polyline_of(const EolVertex& vertex) const
    {
        return obstacles_[vertex.on.obstacle].shape().features().edges[vertex.on.index].polyline;
    }

    const Vec3& place_of(int vertex, const Wire& wire) const { return (*positions_[wire[0]])[vertex]; }

    /// Visits the neighbours that are not on the wire, each in its faces.
    template <typename Visit>
    void for_neighbours(int vertex, const Wire& wire, const Visit& visit) const
    {
        for (const int f : stars_.faces[vertex])
            for (const int w : state_.mesh.faces[f]) {
                const int entry = state_.eol_entry(state_.ids[w]);
                const bool is_there =
                    entry >= 0 && is_on_wire(state_.eol[entry]) &&
                    Wire{state_.eol[entry].on.obstacle, polyline_of(state_.eol[entry])} == wire;
                if (w != vertex && !is_there) visit(f, w);
            }
    }

    /// Distance in the material, m, of a vertex of face f from an EOL vertex, on that face's side of a seam.
    double way(int eol, int f, int w) const
    {
        const ClothMesh& mesh = state_.mesh;
        const Vec2& X = mesh.material[mesh.point_of(w, f)];
        return (X - mesh.material[find_point_beside(mesh, stars_, eol, X)]).norm();
    }

    /// Distance, m of material, within which cloth soon arrives at a vertex on the wire.
    double find_reach(int vertex, const Wire& wire) const
    {
        double sum = 0.0;
        int count = 0;
        for_neighbours(vertex, wire, [&](int f, int w) {
            sum += way(vertex, f, w);
            ++count;
        });
        const double cell = count > 0 ? sum / count : 0.0;
        const double time = obstacles_[wire[0]].is_moving() ? kTimeOfMoving : kTime;
        return kCells * cell + time * state_.material_velocity[vertex].norm();
    }

    /// Cloth past the wire's end can pass freely. Where it hangs straight down, it lies in the fold plane
    /// itself and on neither side.
    bool is_past_end(const EolCoordinates& at, int w, const Wire& wire) const
    {
        const ObstaclePose obstacle = obstacles_[wire[0]].at(state_.time);
        const Vec3& place = place_of(w, wire);
        const int edge = follow_polyline(obstacle, state_.eol[at.entry].on.index, place).feature;
        return arris::is_past_end(obstacle, edge, place);
    }

    /// Neighbours of the last layer, each on the side of the vertex that leads to it. Vertices held
    /// elsewhere, as at the wire's end, do not pass a side on.
    Planes find_beyond(const Planes& last) const
    {
        Planes next;
        for (const auto& [key, plane] : last) {
            if (is_eol_[key.vertex]) continue;
            for_neighbours(key.vertex, key.wire, [&](int f, int w) {
                if (planes_.contains({w, key.wire}) || way(plane.at->vertex, f, w) > plane.reach ||
                    is_past_end(*plane.at, w, key.wire))
                    return;
                const double angle = plane.side * angle_behind(plane.at->frame, place_of(w, key.wire));
                add(next, {w, key.wire}, {plane.at, plane.side, angle, plane.reach});
            });
        }
        return next;
    }

    static void add(Planes& planes, const Key& key, const Plane& plane)
    {
        const auto [known, is_new] = planes.try_emplace(key, plane);
        if (is_new) return;
        const bool is_disputed = known->second.side != plane.side;
        if (plane.angle < known->second.angle) known->second = plane;
        if (is_disputed) known->second.side = 0;
    }

    std::vector<FoldPlaneContact> contacts() const
    {
        std::vector<FoldPlaneContact> found;
        for (const auto& [key, plane] : planes_)
            if (plane.side != 0 && plane.angle < kFarRound && plane.angle > -kWrong && !is_eol_[key.vertex])
                found.push_back(
                    {key.vertex, key.wire[0],
                     find_fold_plane_bound(plane.at->frame, place_of(key.vertex, key.wire), plane.side),
                     plane.at->frame.point});
        return found;
    }

    const std::vector<MovingObstacle>& obstacles_;
    const State& state_;
    const ClothStars& stars_;
    const std::vector<EolCoordinates>& eol_;
    const std::vector<const std::vector<Vec3>*>& positions_;
    /// EOL vertices, also on other features or at the wire's end: their feature holds them, and a fold bound
    /// would point where they cannot move.
    std::vector<char> is_eol_;
    Planes planes_;
};

}  // namespace

std::vector<FoldPlaneContact> find_fold_plane_contacts(const std::vector<MovingObstacle>& obstacles,
                                                       const State& state, const ClothStars& stars,
                                                       const std::vector<EolCoordinates>& eol,
                                                       const std::vector<const std::vector<Vec3>*>& positions)
{
    return FoldPlaneSearch(obstacles, state, stars, eol, positions).run();
}

}  // namespace arris
