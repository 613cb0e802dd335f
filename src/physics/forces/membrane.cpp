// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/forces/membrane.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace arris {

namespace {

double find_mu(const Material& material)
{
    return material.youngs_modulus / (2.0 * (1.0 + material.poisson_ratio));
}

double find_lambda(const Material& material)
{
    const double nu = material.poisson_ratio;
    return material.youngs_modulus * nu / (1.0 - nu * nu);
}

/// Quantities that determine the energy; symbols as in the class comment.
struct Invariants {
    Vec3 cross;      ///< f1 x f2
    double J;        ///< f1 x f2|
    double squared;  ///< |F|^2
    double S;        ///< s1 + s2
    double S_minus_2;
    double squared_difference;  ///< (s1 - s2)^2
};

/// Further quantities that force and stiffness need.
struct Stretch : Invariants {
    Vec3 n;   ///< unit normal
    Mat32 R;  ///< rotation part of F
};

/// A unit vector perpendicular to `v`; an arbitrary one if v is zero.
Vec3 any_perpendicular(const Vec3& v)
{
    int least = 0;
    v.cwiseAbs().minCoeff(&least);
    const Vec3 perpendicular = v.cross(Vec3::Unit(least));
    const double length = perpendicular.norm();
    return length > 0.0 ? Vec3(perpendicular / length) : Vec3::UnitZ();
}

Invariants find_invariants(const Mat32& F)
{
    const Vec3 f1 = F.col(0), f2 = F.col(1);
    Invariants s;
    s.cross = f1.cross(f2);
    s.J = s.cross.norm();
    s.squared = F.squaredNorm();
    s.S = std::sqrt(s.squared + 2.0 * s.J);
    s.S_minus_2 = (s.squared + 2.0 * s.J - 4.0) / (s.S + 2.0);  // S - 2 = (S^2 - 4) / (S + 2)

    // s1^2 - s2^2 is the difference of the eigenvalues of F^T F; divided by S and squared it is (s1 - s2)^2.
    const double half_difference = 0.5 * (f1.squaredNorm() - f2.squaredNorm());
    const double off = f1.dot(f2);
    s.squared_difference =
        s.S > 0.0 ? 4.0 * (half_difference * half_difference + off * off) / (s.S * s.S) : 0.0;
    return s;
}

Stretch decompose(const Mat32& F)
{
    const Vec3 f1 = F.col(0), f2 = F.col(1);
    Stretch s{find_invariants(F), {}, {}};
    // A face collapsed to a line or a point has no normal. Any normal across it serves: each gives the same
    // energy and a limit of the force.
    constexpr double kCollapsed = 1e-14;  // relative to |F|^2: below, the direction of f1 x f2 is rounding
    s.n = s.J > kCollapsed * s.squared ? Vec3(s.cross / s.J)
                                       : any_perpendicular(f1.squaredNorm() > f2.squaredNorm() ? f1 : f2);
    s.R.col(0) = f1 + f2.cross(s.n);
    s.R.col(1) = f2 + s.n.cross(f1);
    if (s.S > 0.0)
        s.R /= s.S;
    else
        s.R << any_perpendicular(s.n), s.n.cross(any_perpendicular(s.n));
    return s;
}

/// W of P = F W, with negative eigenvalues set to zero: the stiffness against rotation out of the plane. W =
/// sum_i (2 mu (s_i - 1) + lambda (S - 2)) / s_i v_i v_i^T, with v_i, s_i the eigenpairs of the stretch R^T
/// F.
Mat2 out_of_plane_stiffness(const Mat32& F, const Stretch& s, double mu, double lambda)
{
    const Mat2 U = s.R.transpose() * F;
    const double mean = 0.5 * (U(0, 0) + U(1, 1));
    const double half = 0.5 * (U(0, 0) - U(1, 1));
    const double off = 0.5 * (U(0, 1) + U(1, 0));
    const double radius = std::hypot(half, off);
    constexpr double kLeastStretch = 1e-3;  // below, the true stiffness grows without limit; this value is
                                            // used
    const auto stiffness = [&](double s_i) {
        const double force = 2.0 * mu * (s_i - 1.0) + lambda * s.S_minus_2;
        return std::max(force, 0.0) / std::max(s_i, kLeastStretch);
    };
    const double k1 = stiffness(mean + radius), k2 = stiffness(mean - radius);

    // v1 v1^T - v2 v2^T = [half, off; off, -half] / radius
    Mat2 W = 0.5 * (k1 + k2) * Mat2::Identity();
    if (radius > 0.0) {
        Mat2 traceless;
        traceless << half, off, off, -half;
        W += 0.5 * (k1 - k2) / radius * traceless;
    }
    return W;
}

}  // namespace

Membrane::Membrane(const Materials& materials)
{
    for (const Material& material : materials) moduli_.push_back({find_mu(material), find_lambda(material)});
}

double Membrane::energy(const FaceState& face) const
{
    const auto& [mu, lambda] = moduli_[face.element.piece];
    const Invariants s = find_invariants(face.F);
    // sum (s_i - 1)^2 = ((S - 2)^2 + (s1 - s2)^2) / 2   no cancellation near rest
    const double shear = 0.5 * (s.S_minus_2 * s.S_minus_2 + s.squared_difference);
    return face.element.area * (mu * shear + 0.5 * lambda * s.S_minus_2 * s.S_minus_2);
}

void Membrane::add(const FaceState& face, FaceSystem& system) const
{
    const auto& [mu, lambda] = moduli_[face.element.piece];
    const Stretch s = decompose(face.F);
    const double area = face.element.area;
    const auto& b = face.element.gradients;

    // Force on corner i: -A P b_i.
    const Mat32 P = 2.0 * mu * (face.F - s.R) + lambda * s.S_minus_2 * s.R;
    for (int i = 0; i < 3; ++i) system.add_elastic_force(i, -area * (P * b[i]));
    if (system.is_eulerian()) {
        const double V = energy(face);
        for (int i = 0; i < 3; ++i)
            system.add_material_force(i, area * (face.F.transpose() * (P * b[i])) - V * b[i]);
    }

    // dP in the plane: 2 mu dF + lambda R <R, dF> + k T <T, dF>, T = R [0 -1; 1 0], |T|^2 = 2. The eigenvalue
    // of the twist, 2 mu + 2 k, must not be negative.
    const double k = s.S > 0.0 ? std::max((lambda * s.S_minus_2 - 2.0 * mu) / s.S, -mu) : -mu;
    const Mat2 W = out_of_plane_stiffness(face.F, s, mu, lambda);
    const Mat3 normal = s.n * s.n.transpose();
    const Mat3 plane = Mat3::Identity() - normal;
    std::array<Vec3, 3> Rb, Tb;
    for (int i = 0; i < 3; ++i) {
        Rb[i] = s.R * b[i];
        Tb[i] = s.R * Vec2(-b[i].y(), b[i].x());
    }
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j)
            system.add_stiffness(
                i, j,
                area * (2.0 * mu * b[i].dot(b[j]) * plane + lambda * Rb[i] * Rb[j].transpose() +
                        k * Tb[i] * Tb[j].transpose() + b[i].dot(W * b[j]) * normal));
}

Vec2 principal_stretches(const Mat32& F)
{
    const Invariants s = find_invariants(F);
    const double difference = std::sqrt(s.squared_difference);
    return {0.5 * (s.S + difference), 0.5 * (s.S - difference)};
}

std::vector<Vec2> compute_stretches(const ClothElements& elements, const std::vector<Vec3>& position)
{
    std::vector<Vec2> stretches;
    stretches.reserve(elements.faces.size());
    for (const FaceElement& face : elements.faces)
        stretches.push_back(principal_stretches(FaceState(face, position).F));
    return stretches;
}

Vec2 principal_tensions(const Vec2& stretches, const Material& material)
{
    const double mu = find_mu(material), lambda = find_lambda(material);
    const Vec2 strains = stretches.array() - 1.0;
    return 2.0 * mu * strains + Vec2::Constant(lambda * strains.sum());
}

}  // namespace arris
