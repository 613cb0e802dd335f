// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/eol/eol_coordinates.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/cloth/cloth_cone.h"
#include "geometry/obstacle/feature_nodes.h"
#include "solver/eol/eol_features.h"
#include "solver/eol/free_fold.h"
#include "solver/eol/wire_fold.h"
#include "solver/model/eol_limits.h"

namespace arris {

namespace {

const double kSinLeastCrossing = std::sin(kLeastCrossing * M_PI / 180.0);
const double kCos10 = std::cos(10.0 * M_PI / 180.0);
const double kSin10 = std::sin(10.0 * M_PI / 180.0);

/// Unit directions across a feature in which the cloth leaves it, to the left of its trace and to the right.
struct Sides {
    Vec3 left = Vec3::Zero(), right = Vec3::Zero();
};

/// Sums the two sides of a trace, each with equal weight, however many faces it has.
ClothAround sum_sides(const Star& star, const Vec2& trace, const Vec3& tangent, const EolVertex& eol,
                      Sides& sides)
{
    ClothAround cloth{Vec3::Zero(), Vec3::Zero(), eol.outward, eol.side};
    for (const double sign : {1.0, -1.0}) {
        Vec3 normal = Vec3::Zero(), leaving = Vec3::Zero();
        for (const StarFace& face : star.faces) {
            if (!(sign * (trace.x() * face.middle.y() - trace.y() * face.middle.x()) > 0.0)) continue;
            normal += face.area * face.normal;
            leaving += face.area * face.leaving;
        }
        normal = (normal - tangent.dot(normal) * tangent).stableNormalized();
        const Vec3 along = normal.cross(tangent);  // in the side's plane, across the feature
        Vec3& side = sign > 0.0 ? sides.left : sides.right;
        side = along.dot(leaving) < 0.0 ? Vec3(-along) : along;
        cloth.normal += normal;
        cloth.leaving += side;
    }
    return cloth;
}

/// Sums the faces around a point, each weighted by its angle there.
ClothAround sum_around(const Star& star, const EolVertex& eol)
{
    ClothAround cloth{Vec3::Zero(), Vec3::Zero(), eol.outward, eol.side};
    for (const StarFace& face : star.faces) {
        const double angle = face.angle();
        cloth.normal += angle * face.normal;
        cloth.leaving += angle * face.leaving;
    }
    return cloth;
}

Vec2 perpendicular(const Vec2& v)
{
    return Vec2(v.y(), -v.x()).normalized();
}

/// Material direction of the feature through the vertex: along the cloth's edges on the feature; without such
/// edges, the direction that F maps nearest to the tangent.
Vec2 find_trace(const Obstacle& obstacle, const State& state, int entry, int vertex, const ClothStars& stars,
                const std::vector<Vec3>& positions, const Star& star, const Vec3& tangent)
{
    const ClothMesh& mesh = state.mesh;
    Vec2 along = Vec2::Zero();
    std::vector<int> seen;
    const Vec2 estimate = star.squared_F.inverse() * (star.F_transposed * tangent);
    for (const int f : stars.faces[vertex])
        for (const int w : mesh.faces[f]) {
            if (w == vertex || std::find(seen.begin(), seen.end(), w) != seen.end()) continue;
            seen.push_back(w);
            const int other = state.eol_entry(state.ids[w]);
            if (other < 0 || !is_trace_edge(obstacle, {state.eol[entry], positions[vertex]},
                                            {state.eol[other], positions[w]}))
                continue;
            const int point = mesh.point_of(vertex, f);
            Vec2 way = mesh.material[mesh.point_of(w, f)] - mesh.material[point];
            if (point != vertex) way = find_turn(mesh, stars, point).inverse() * way;
            along += way.dot(estimate) >= 0.0 ? way : Vec2(-way);
        }
    return along.norm() > 0.0 ? along.normalized() : estimate.normalized();
}

std::optional<FeatureFrame> find_frame(const Obstacle& obstacle, const EolVertex& eol, const Vec3& place,
                                       const ClothAround& around)
{
    if (eol.on.is_corner()) return find_corner_frame(obstacle, eol.on.index, place, around);
    if (eol.on.is_bend()) return find_bend_frame(obstacle, eol.on.index, eol.on.end, around);
    return find_edge_frame(obstacle, eol.on.index, place, around);
}

/// Whether the cloth around the vertex is flat and contains the outward direction: motion along outward in
/// the world then equals flow in the material.
bool is_edge_on(const Star& star, const Vec3& outward)
{
    Vec3 mean = Vec3::Zero();
    for (const StarFace& face : star.faces) mean += face.normal;
    if (!(mean.norm() > 0.0)) return false;
    mean.normalize();
    const bool is_flat = std::all_of(star.faces.begin(), star.faces.end(),
                                     [&](const StarFace& face) { return face.normal.dot(mean) > kCos10; });
    return is_flat && std::abs(mean.dot(outward)) < kSin10;
}

/// Moving c alone would stretch the cloth beside the vertex, whose flow would have to follow. The least
/// kinetic energy also moves the vertex along the feature and through the material.
Vec3 find_opening(const Star& star, const Mat3& basis, const Mat23& material_basis)
{
    Mat3 inertia = Mat3::Zero();
    for (const StarFace& face : star.faces) {
        const Mat3 G = basis - face.F * material_basis;
        inertia += face.area * G.transpose() * G;
    }
    const Vec3 response = inertia.inverse().col(0);
    return response / response[0];
}

/// Whether the normals point outward (1) or inward (-1); unchanged where the cloth is almost folded flat.
int find_side(const ClothAround& cloth, const EolVertex& eol, const Vec3& outward)
{
    constexpr double kSeen = 0.3;  // of a sum of two unit vectors, or of angles: 17 degrees from a flat fold
    const double along = cloth.normal.dot(outward);
    return std::abs(along) > kSeen ? (along > 0.0 ? 1 : -1) : eol.side;
}

/// The side from which cloth arrives: the vertex moves towards that side through the material with `flow`
/// (m/s).
ArrivingCloth find_arriving(const Sides& sides, const Vec2& trace, const Vec2& flow)
{
    const bool is_left = trace.x() * flow.y() - trace.y() * flow.x() > 0.0;
    return {is_left ? sides.left : sides.right, flow.norm()};
}

/// Turns outward at a tip to the apex of the cone of cloth around the vertex, and moves the vertex round the
/// point with it. If the vertex stayed, cloth that hangs ever steeper would come to the point. A vertex that
/// has left the point stays: carrying it across flying cloth would do work on the cloth.
void turn_with_cone(const Star& star, double thickness, double dt, FeatureFrame& frame, Vec3& place)
{
    const double height = (place - frame.point).norm();
    if (!(height > 0.0)) return;
    if (height > kOnFeature * thickness) dt = 0.0;
    const Vec3 now = (place - frame.point) / height;
    std::vector<FaceSector> sectors;
    for (const StarFace& face : star.faces) sectors.push_back(face.sector);
    const Vec3 wanted = -find_cone_axis(sectors, -now);
    const double angle = std::atan2(now.cross(wanted).norm(), now.dot(wanted));
    const double share = std::min(kTurnPerStep, kMendingSpeed * dt / (height * angle));
    const auto turn = Eigen::Quaterniond::FromTwoVectors(now, wanted);
    frame.outward = Eigen::Quaterniond::Identity().slerp(angle > 0.0 ? share : 0.0, turn) * now;
    place = frame.point + height * frame.outward;
}

/// Turns the outward direction at a wire with the cloth, and moves the vertex round the wire with it, as
/// `turn_with_cone` does at a tip.
void turn_with_cloth(const Obstacle& obstacle, double thickness, const State& state, int entry, int vertex,
                     std::span<const int> faces, const std::vector<Vec3>& positions, double dt,
                     FeatureFrame& frame, Vec3& place)
{
    const EolVertex& eol = state.eol[entry];
    if (eol.on.is_corner() || obstacle.features().edges[eol.on.index].kind != FeatureKind::Wire) return;
    std::vector<Vec3> beside;
    for (const int f : faces)
        for (const int w : state.mesh.faces[f]) {
            const int other = state.eol_entry(state.ids[w]);
            const bool is_on_wire =
                w == vertex || (other >= 0 && is_trace_edge(obstacle, {eol, positions[vertex]},
                                                            {state.eol[other], positions[w]}));
            if (!is_on_wire) beside.push_back(positions[w]);
        }
    const Vec3 from = place - frame.point, along = frame.tangent.dot(from) * frame.tangent;
    if ((from - along).norm() > kOnFeature * thickness) dt = 0.0;
    frame.outward = turn_outward(frame, place, beside, dt);
    place = frame.point + along + (from - along).norm() * frame.outward;
}

/// Whether the border leads along the trace in the material, or along the feature in the world. A border
/// vertex flows only along the border. If the border runs along the feature, flow and motion along the
/// feature become one, and both could grow without limit. Faces are tested one by one: at a fold the border
/// leads away from the feature to opposite sides.
bool leads_along(const Star& star, const Vec2& border, const Vec2& trace, const Vec3& tangent)
{
    double along = 0.0, across = 0.0;
    for (const StarFace& face : star.faces) {
        const Vec3 way = face.F * border;
        const double part = tangent.dot(way);
        along += face.area * part;
        across += face.area * (way - part * tangent).norm();
    }
    const double sine_in_material = std::abs(border.x() * trace.y() - border.y() * trace.x());
    return sine_in_material < kSinLeastCrossing || across < kSinLeastCrossing * std::hypot(along, across);
}

EolPlacing finish(const Star& star, const Placement& end, EolCoordinates at)
{
    at.opening = find_opening(star, at.basis, at.material_basis);
    if (!at.opening.allFinite()) return {std::nullopt, ConstraintCause::EdgeOn};
    at.basis = end.rotation * at.basis;
    return {at, {}};
}

}  // namespace

EolPlacing place_eol_vertex(const Obstacle& obstacle, double thickness, const State& state, int entry,
                            const ClothStars& stars, const std::vector<Vec3>& positions, const Placement& end,
                            double dt)
{
    const EolVertex& eol = state.eol[entry];
    const int v = state.index_of(eol.vertex_id);
    const Vec3& place = positions[v];
    const std::optional<Vec2> border = find_border(state.mesh, stars, v);
    if (border && border->isZero()) return {std::nullopt, ConstraintCause::ClothCorner};
    if (border && eol.on.is_fixed()) return {std::nullopt, ConstraintCause::AlongBorder};

    const Vec3 tangent = feature_tangent(obstacle, eol);
    const Star star = look_around(state.mesh, stars, v, positions);
    Vec2 trace = Vec2::Zero();
    if (!eol.on.is_corner()) trace = find_trace(obstacle, state, entry, v, stars, positions, star, tangent);
    if (!trace.allFinite()) return {std::nullopt, ConstraintCause::NoDirection};
    Sides sides;
    const ClothAround around =
        eol.on.is_corner() ? sum_around(star, eol) : sum_sides(star, trace, tangent, eol, sides);
    std::optional<FeatureFrame> frame = find_frame(obstacle, eol, place, around);
    if (!frame) return {std::nullopt, ConstraintCause::NoDirection};
    if (is_on_convex_edge(obstacle, eol))
        frame = turn_to_free_fold(obstacle.features().edges[eol.on.index],
                                  find_arriving(sides, trace, state.material_velocity[v]), place, thickness,
                                  *frame);
    if (is_edge_on(star, frame->outward)) return {std::nullopt, ConstraintCause::EdgeOn};

    EolCoordinates at{v,
                      entry,
                      *frame,
                      place,
                      Mat3::Zero(),
                      Mat23::Zero(),
                      find_side(around, eol, frame->outward),
                      Vec3::UnitX()};
    if (eol.on.is_corner() && is_tip(obstacle, eol.on.index))
        turn_with_cone(star, thickness, dt, at.frame, at.carried);
    turn_with_cloth(obstacle, thickness, state, entry, v, stars.faces[v], positions, dt, at.frame,
                    at.carried);
    at.carried = end(at.carried);
    at.basis.col(0) = at.frame.outward;
    if (!eol.on.is_fixed()) at.basis.col(1) = at.frame.tangent;
    if (eol.on.is_corner()) {
        at.material_basis.col(1) = Vec2::UnitX();
        at.material_basis.col(2) = Vec2::UnitY();
        return finish(star, end, at);
    }
    if (border && leads_along(star, *border, trace, tangent))
        return {std::nullopt, ConstraintCause::AlongBorder};
    for (int p = stars.next_point(v); p >= 0; p = stars.next_point(p))
        at.beyond.push_back({p, find_turn(state.mesh, stars, p)});
    at.trace = trace;
    if (eol.on.is_bend()) at.material_basis.col(1) = trace;
    at.material_basis.col(2) = border ? *border : perpendicular(trace);
    return finish(star, end, at);
}

EolPlacing EolPlacer::place(int entry)
{
    const EolVertex& eol = state_.eol[entry];
    if (std::exchange(of_, eol.on.obstacle) != eol.on.obstacle)
        now_ = obstacles_[eol.on.obstacle].at(state_.time);
    positions_.resize(state_.mesh.world.size(), Vec3::Zero());
    for (const int f : stars_.faces[state_.index_of(eol.vertex_id)])
        for (const int v : state_.mesh.faces[f]) positions_[v] = now_.placement.inverse(state_.mesh.world[v]);
    return place_eol_vertex(now_, thickness_, state_, entry, stars_, positions_, now_.placement);
}

}  // namespace arris
