// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/friction/friction_pairs.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>

#include "geometry/obstacle/feature_path.h"

namespace arris {

namespace {

/// Velocity v' with which the vertex rides on the obstacle: its path from the last step's start to this
/// step's end is then rigid, whatever its history.
Vec3 riding_velocity(const SlippingCloth& cloth, const Carrier& carrier, int v)
{
    const Prediction& prediction = cloth.prediction;
    return (carrier.end(carrier.motion.begin[v]) -
            ridden_position(carrier, cloth.state, prediction.forward, v)) /
           prediction.gamma;
}

void add_entry(int coordinate, double coefficient, ConstraintRow& row)
{
    row.coordinate[row.count] = coordinate;
    row.coefficient[row.count++] = coefficient;
}

/// Mean deformation gradient at a contact's vertex, of the faces that hold all of the contact's vertices on
/// that vertex's side: a part of the cloth touches with one vertex, edge or face.
Mat32 deformation_at(const SlippingCloth& cloth, const Contact& contact, int i)
{
    const int split = contact.first_count();
    const int first = i < split ? 0 : split, last = i < split ? split : 4;
    std::vector<int> faces;
    for (const int f : cloth.stars.faces[contact.vertices[i]]) {
        const Face& face = cloth.state.mesh.faces[f];
        bool holds_all = true;
        for (int k = first; k < last && contact.vertices[k] >= 0; ++k)
            holds_all = holds_all && std::find(face.begin(), face.end(), contact.vertices[k]) != face.end();
        if (holds_all) faces.push_back(f);
    }
    Mat32 sum = Mat32::Zero();
    double area = 0.0;
    const Star star =
        look_around(cloth.state.mesh, cloth.stars, faces, contact.vertices[i], cloth.state.mesh.world);
    for (const StarFace& face : star.faces) {
        sum += face.area * face.F;
        area += face.area;
    }
    return sum / area;
}

/// Slip of a contact's material along two world directions: direction . sum_i w_i (v'_i - F_i V'_i - v_ride),
/// V' the flow of material through an EOL vertex.
std::array<ConstraintRow, 2> slip_along(const SlippingCloth& cloth, const Contact& contact,
                                        const std::array<Vec3, 2>& directions)
{
    std::array<ConstraintRow, 2> rows;
    const Carrier& carrier = cloth.carriers[contact.obstacle];
    for (int i = 0; i < 4 && contact.vertices[i] >= 0; ++i) {
        if (contact.weights[i] == 0.0) continue;
        const int v = contact.vertices[i];
        const Vec3 riding = cloth.at.drift[v] - riding_velocity(cloth, carrier, v);
        const bool is_eulerian = cloth.at.flow && cloth.at.flow->is_eulerian[v];
        const Mat32 F = is_eulerian ? deformation_at(cloth, contact, i) : Mat32::Zero();
        for (int r = 0; r < 2; ++r) {
            const Vec3 weighed = contact.weights[i] * directions[r];
            rows[r].lower -= weighed.dot(riding);
            Vec3 gradient = cloth.at.basis[v].transpose() * weighed;
            if (is_eulerian) gradient -= cloth.at.flow->basis[v].transpose() * (F.transpose() * weighed);
            for (int d = 0; d < 3; ++d) add_entry(3 * v + d, gradient[d], rows[r]);
        }
    }
    return rows;
}

/// The way of a material direction over a feature: along its tangent and across it. Both sides count equally.
Vec2 find_way(const Star& star, const Vec2& trace, const Vec3& tangent, const Vec2& material)
{
    Vec2 sum = Vec2::Zero();
    int sides = 0;
    for (const double sign : {1.0, -1.0}) {
        Vec2 side = Vec2::Zero();
        double area = 0.0;
        for (const StarFace& face : star.faces) {
            if (!(sign * (trace.x() * face.middle.y() - trace.y() * face.middle.x()) > 0.0)) continue;
            const Vec3 way = face.F * material;
            const double along = tangent.dot(way);
            side += face.area * Vec2(along, (way - along * tangent).norm());
            area += face.area;
        }
        if (!(area > 0.0)) continue;
        sum += side / area;
        ++sides;
    }
    const double is_left = trace.x() * material.y() - trace.y() * material.x() > 0.0 ? 1.0 : -1.0;
    return sides > 0 ? Vec2(sum.x() / sides, is_left * sum.y() / sides) : Vec2(0.0, 0.0);
}

/// Slip of the material at an EOL vertex, -F V, plus the vertex's own way along the feature.
std::array<ConstraintRow, 2> slip_over_feature(const SlippingCloth& cloth, const Contact& contact)
{
    const EolCoordinates& eol = cloth.eol[contact.eol];
    const int v = eol.vertex;
    const Star star = look_around(cloth.state.mesh, cloth.stars, v, cloth.state.mesh.world);
    std::array<ConstraintRow, 2> rows;
    const FeatureId& on = cloth.state.eol[eol.entry].on;
    if (on.is_fixed()) {  // the metric C = mean F^T F makes |C^(1/2) V| the material's speed
        double area = 0.0;
        for (const StarFace& face : star.faces) area += face.area;
        const Eigen::SelfAdjointEigenSolver<Mat2> metric(star.squared_F / area);
        const Mat2 root = metric.operatorSqrt();
        for (int d = 0; d < 2; ++d)
            for (int k = 0; k < 3; ++k)
                add_entry(3 * v + k, -root.row(d).dot(eol.material_basis.col(k)), rows[d]);
        return rows;
    }
    const Vec3 tangent = eol.basis.col(1);
    const Vec2 way = find_way(star, eol.trace, tangent, eol.material_basis.col(2));
    const Carrier& carrier = cloth.carriers[contact.obstacle];
    rows[0].lower = -tangent.dot(cloth.at.drift[v] - riding_velocity(cloth, carrier, v));
    add_entry(3 * v + 1, 1.0, rows[0]);
    add_entry(3 * v + 2, -way[0], rows[0]);
    add_entry(3 * v + 2, -way[1], rows[1]);
    return rows;
}

/// Slip, m/s, from which the search starts: that of this step's last solve, if there was one. Else sliding
/// cloth goes on with the acceleration of the last step until it would turn round, and what stuck goes on
/// sticking.
std::array<double, 2> predict_slip(const SlippingCloth& cloth, const Contact& contact,
                                   const SlipContact& slipping)
{
    const ContactFriction& last = contact.friction;
    const auto components = [&](const Vec3& slip) {
        return std::array<double, 2>{slipping.directions[0].dot(slip), slipping.directions[1].dot(slip)};
    };
    if (contact.eol >= 0 || contact.is_pressing || !cloth.prediction.has_history)
        return components(last.slip);
    Vec3 slip = Vec3::Zero();
    const Carrier& carrier = cloth.carriers[contact.obstacle];
    for (int i = 0; i < 4 && contact.vertices[i] >= 0; ++i) {
        const int v = contact.vertices[i];
        const Vec3& now = cloth.state.velocity[v];
        const Vec3 end = now + cloth.prediction.ratio * (now - cloth.state.previous_velocity[v]);
        slip += contact.weights[i] * (end - riding_velocity(cloth, carrier, v));
    }
    slip -= contact.normal.dot(slip) * contact.normal;
    return slip.dot(last.slip) > 0.0 ? components(slip) : std::array<double, 2>{0.0, 0.0};
}

/// Whether an edge of the cloth touches the polyline on which one of its ends is an EOL vertex: that vertex
/// has the friction there.
bool is_beside_trace(const SlippingCloth& cloth, const Contact& contact)
{
    if (contact.kind != ContactKind::Edge || contact.is_with_itself()) return false;
    const ObstacleFeatures& features = cloth.carriers[contact.obstacle].obstacle->features();
    const int feature = feature_of_edge(features, contact.element);
    return feature >= 0 && std::any_of(cloth.eol.begin(), cloth.eol.end(), [&](const EolCoordinates& eol) {
               const FeatureId& on = cloth.state.eol[eol.entry].on;
               return (eol.vertex == contact.vertices[0] || eol.vertex == contact.vertices[1]) &&
                      on.obstacle == contact.obstacle && !on.is_corner() &&
                      features.edges[on.index].polyline == features.edges[feature].polyline;
           });
}

bool can_slip(const SlippingCloth& cloth, const Contact& contact)
{
    return !contact.is_fold_plane() && (contact.eol >= 0 || !is_beside_trace(cloth, contact));
}

/// Two unit directions across a unit normal.
std::array<Vec3, 2> directions_across(const Vec3& normal)
{
    const Vec3 first = normal.unitOrthogonal();
    return {first, normal.cross(first)};
}

/// 1 / sum w_i^2 / m_i, kg.
double slipping_mass(const ClothPoints& points, const std::vector<double>& mass)
{
    double compliance = 0.0;
    for (int i = 0; i < 4 && points.vertices[i] >= 0; ++i)
        compliance += points.weights[i] * points.weights[i] / mass[points.vertices[i]];
    return 1.0 / compliance;
}

/// Completes the pair of a contact whose slip rows are known, from the friction of the last step and solve.
void set_forces(const SlippingCloth& cloth, const SlipContact& slipping, const ContactFriction& last,
                const ContactFriction& now, FrictionPair& pair)
{
    const double gamma = cloth.prediction.gamma;
    pair.budget = gamma * now.budget;
    for (int d = 0; d < 2; ++d) pair.slip[d].expected = gamma * slipping.directions[d].dot(last.force);
}

}  // namespace

std::vector<SlipContact> add_friction_pairs(const SlippingCloth& cloth, VelocityProblem& problem)
{
    std::vector<SlipContact> slip_contacts;
    problem.friction.clear();
    if (!cloth.scene.friction || cloth.contacts.empty()) return slip_contacts;
    const std::vector<double> mass = lump_masses(cloth.scene.materials, cloth.elements);
    for (std::size_t c = 0; c < cloth.contacts.size(); ++c) {
        const Contact& contact = cloth.contacts[c];
        const double coefficient = friction_at(cloth.scene, cloth.state.mesh, contact);
        if (!(coefficient > 0.0) || !can_slip(cloth, contact)) continue;
        SlipContact slipping{static_cast<int>(c), coefficient, {Vec3::UnitX(), Vec3::UnitY()}};
        FrictionPair pair;
        if (contact.eol >= 0) {
            pair.slip = slip_over_feature(cloth, contact);
        } else {
            slipping.directions = directions_across(contact.normal);
            pair.slip = slip_along(cloth, contact, slipping.directions);
        }
        pair.mass = slipping_mass(contact, mass);
        set_forces(cloth, slipping, contact.last_friction, contact.friction, pair);
        pair.last = predict_slip(cloth, contact, slipping);
        slip_contacts.push_back(slipping);
        problem.friction.push_back(pair);
    }
    return slip_contacts;
}

}  // namespace arris
