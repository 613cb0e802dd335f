// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/untangle/move_check.h"

#include <algorithm>

#include "geometry/check/sweep_check.h"
#include "geometry/self_contact/self_sweep.h"

namespace arris {

namespace {

constexpr double kAnyAngle = 30.0;  // degrees: wires and points are features at any angle

}  // namespace

MoveCheck::MoveCheck(const CollisionMesh& mesh, const UntangleRequest& request)
    : mesh_(mesh), thickness_(request.thickness)
{
    for (const StartObstacle& obstacle : request.obstacles) {
        const ObstacleMesh& shape = obstacle.pose->mesh();
        if (obstacle.rule == StartRule::Ignore || (shape.segments.empty() && shape.lone_points.empty()))
            continue;
        ObstacleMesh bare{shape.points, {}, shape.segments, shape.lone_points};
        wires_.push_back({Obstacle(std::move(bare), kAnyAngle), obstacle.pose.placement});
    }
    if (wires_.empty()) return;
    cloth_.assign(mesh.surface().faces.begin(), mesh.surface().faces.begin() + mesh.cloth_faces());
    edges_ = make_topology(mesh.cloth_vertices(), cloth_).edges;
}

bool MoveCheck::passes_wire(const std::vector<Vec3>& end) const
{
    const auto cloth_of = [&](const std::vector<Vec3>& places) {
        return std::vector<Vec3>(places.begin(), places.begin() + mesh_.cloth_vertices());
    };
    return std::any_of(wires_.begin(), wires_.end(), [&](const Wires& wires) {
        const ClothMotion motion{&cloth_, &edges_, to_local(wires.placement, cloth_of(mesh_.positions)),
                                 to_local(wires.placement, cloth_of(end))};
        return check_sweep(wires.shape, motion, thickness_).crossings > 0;
    });
}

bool MoveCheck::may_meet(SelfContactKind kind, int first, int second, const WaySides& sides) const
{
    const SelfSurface& surface = mesh_.surface();
    const MeshEdge* second_edge = kind == SelfContactKind::EdgeEdge ? &surface.edges[second] : nullptr;
    const auto may_meet_second = [&](int f) {
        if (!second_edge) return sides.may_meet(f, second);
        return sides.may_meet(f, second_edge->face_left) ||
               (second_edge->face_right >= 0 && sides.may_meet(f, second_edge->face_right));
    };
    const int second_face = second_edge ? second_edge->face_left : second;
    if (kind == SelfContactKind::EdgeEdge) {
        const MeshEdge& edge = surface.edges[first];
        return mesh_.rule(edge.face_left, second_face) == StartRule::Ignore ||
               may_meet_second(edge.face_left) || (edge.face_right >= 0 && may_meet_second(edge.face_right));
    }
    const auto around = surface.faces_at[first];
    return mesh_.rule(around.front(), second_face) == StartRule::Ignore ||
           std::any_of(around.begin(), around.end(), may_meet_second);
}

MoveFinding MoveCheck::check(const std::vector<Vec3>& end, const std::vector<WayApart>& ways,
                             const Crossings& before) const
{
    MoveFinding finding;
    const WaySides sides(mesh_.surface().faces.size(), ways);
    const SelfSweepReport swept = check_self_sweep(
        mesh_.surface(), {mesh_.positions, end}, thickness_,
        [&](SelfContactKind kind, int first, int second) { return may_meet(kind, first, second, sides); });
    finding.violations = swept.violations;
    if (!swept.is_clean() || passes_wire(end)) return finding;

    finding.after = find_crossings(mesh_, end);
    const std::vector<std::array<int, 2>>& old = before.to_untangle;
    const auto is_allowed = [&](const std::array<int, 2>& pair) {
        return sides.may_meet(pair[0], pair[1]) || std::binary_search(old.begin(), old.end(), pair);
    };
    finding.is_clean =
        std::all_of(finding.after.to_untangle.begin(), finding.after.to_untangle.end(), is_allowed) &&
        std::includes(before.kept.begin(), before.kept.end(), finding.after.kept.begin(),
                      finding.after.kept.end());
    return finding;
}

}  // namespace arris
