// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/forces/hinge_moments.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "physics/elements/eulerian_element.h"
#include "physics/elements/hinge_angle.h"

namespace arris {

namespace {

/// Edges of a face, opposite to its corners, counter-clockwise.
std::array<Vec2, 3> edges_of(const FaceElement& face)
{
    std::array<Vec2, 3> edges;  // a shape function's gradient is the edge turned by 90 degrees over 2 A
    for (int i = 0; i < 3; ++i)
        edges[i] = 2.0 * face.area * Vec2(face.gradients[i].y(), -face.gradients[i].x());
    return edges;
}

/// M = -1 / (4 A^2) sum_i y_i sym(E_j E_k): n . sym(E_j E_k) n is -(2 A / L_i)^2 on edge i and zero on j, k.
Mat2 moment_tensor(const FaceElement& face, const std::array<Vec2, 3>& edges, const Vec3& y)
{
    Mat2 M = Mat2::Zero();
    for (int i = 0; i < 3; ++i) {
        const Mat2 product = edges[(i + 1) % 3] * edges[(i + 2) % 3].transpose();
        M -= y[i] / (8.0 * face.area * face.area) * (product + product.transpose());
    }
    return M;
}

/// A face with unknown moments.
struct PlateFace {
    FaceElement element;
    std::array<int, 3> hinges;  ///< opposite each corner; the number of hinges where the edge has no moment
    std::array<bool, 3> has_moment = {false, false, false};
    Mat3 compliance;            ///< zero rows and columns where the edge has no moment
    Vec3 scale = Vec3::Ones();  ///< of y: an edge's length in the face over that of its hinge, 1 but on seams

    int hinge_count() const
    {
        return static_cast<int>(std::count(has_moment.begin(), has_moment.end(), true));
    }

    /// Values at the face's hinges; the last one of `values` is zero, and stands for edges without a moment.
    Vec3 gather(const std::vector<double>& values) const
    {
        return {values[hinges[0]], values[hinges[1]], values[hinges[2]]};
    }

    /// The corner opposite a hinge's edge.
    int corner_of(const HingeElement& hinge, int side) const
    {
        const Face& corners = element.vertices;
        return static_cast<int>(std::find(corners.begin(), corners.end(), hinge.vertices[2 + side]) -
                                corners.begin());
    }

    /// Length, m, of the edge opposite a corner: squared.
    double squared_length(int corner) const
    {
        return 4.0 * element.area * element.area * element.gradients[corner].squaredNorm();
    }
};

/// Length, m, of a hinge's edge; on a seam the mean of both sides.
double length_of(const HingeElement& hinge, const std::vector<PlateFace>& faces)
{
    const PlateFace &c = faces[hinge.faces[0]], &d = faces[hinge.faces[1]];
    const double length = std::sqrt(c.squared_length(c.corner_of(hinge, 0)));
    if (!hinge.is_seam) return length;
    return 0.5 * (length + std::sqrt(d.squared_length(d.corner_of(hinge, 1))));
}

/// Whether the hinge is one of these plates'.
bool has_moment(const std::vector<PlateMaterial>& plates, const HingeElement& hinge)
{
    return !hinge.is_crease() && plates[hinge.pieces[0]].stiffness > 0.0 &&
           plates[hinge.pieces[1]].stiffness > 0.0;
}

std::vector<PlateFace> list_faces(const std::vector<PlateMaterial>& plates, const ClothElements& elements,
                                  const MaterialFlow* flow)
{
    const std::size_t inner = elements.faces.size();
    std::vector<PlateFace> faces(inner + elements.rim.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const FaceElement& element = f < inner ? elements.faces[f] : elements.rim[f - inner];
        const bool flows = flow != nullptr && has_eulerian_vertex(*flow, element.vertices);
        faces[f].hinges.fill(static_cast<int>(elements.hinges.size()));
        faces[f].element = flows ? move_element(element, flow->position) : element;
    }
    for (std::size_t h = 0; h < elements.hinges.size(); ++h) {
        const HingeElement& hinge = elements.hinges[h];
        if (!has_moment(plates, hinge)) continue;
        for (int side = 0; side < 2; ++side) {
            PlateFace& face = faces[hinge.faces[side]];
            const int apex = face.corner_of(hinge, side);
            assert(apex < 3 && "a hinge's apexes are corners of its faces");
            face.hinges[apex] = static_cast<int>(h);
            face.has_moment[apex] = true;
            // The whole edge has one moment, L m, and so L / L_face m per length of the face's side.
            if (hinge.is_seam)
                face.scale[apex] = std::sqrt(face.squared_length(apex)) / length_of(hinge, faces);
        }
    }
    for (PlateFace& face : faces) {
        face.compliance.setZero();
        if (face.hinge_count() == 0) continue;
        face.compliance = face.scale.asDiagonal() *
                          plate_compliance(plates[face.element.piece], face.element) *
                          face.scale.asDiagonal();
        for (int i = 0; i < 3; ++i)
            if (!face.has_moment[i]) {
                face.compliance.row(i).setZero();
                face.compliance.col(i).setZero();
            }
    }
    return faces;
}

// Relative residuals of the equations. An energy is off by the square of its one, and damping need not be
// more exact than a material's constant.
constexpr double kForceTolerance = 1e-9, kEnergyTolerance = 1e-6, kRateTolerance = 1e-4;

struct Moments {
    std::vector<double> y;
    std::vector<double> residual;  ///< q - B y
};

/// B y = q, with y = L^2 m and q = s / L, by conjugate gradients preconditioned with B's diagonal. They start
/// from zero, so that the result is a function of the positions alone. `y` and `q` have one entry per hinge,
/// and a last one of zero. Hinges without a moment have q = 0.
class MomentEquations {
  public:
    MomentEquations(const std::vector<PlateFace>& faces, std::size_t size)
        : faces_(faces), inverse_diagonal_(size, 0.0)
    {
        for (const PlateFace& face : faces)
            for (int i = 0; i < 3; ++i) inverse_diagonal_[face.hinges[i]] += face.compliance(i, i);
        for (double& entry : inverse_diagonal_)
            if (entry > 0.0) entry = 1.0 / entry;
    }

    /// `tolerance`: of the residual, relative.
    Moments solve(const std::vector<double>& q, double tolerance) const
    {
        constexpr int kMostRounds = 200;  // well-shaped faces take 25 to 30, many slivers thousands
        const std::size_t n = q.size();
        std::vector<double> y(n, 0.0), r = q, p(n, 0.0), Bp(n);
        double last = 0.0, first = 0.0;
        for (int k = 0; k < kMostRounds; ++k) {
            double rho = 0.0;  // r . diagonal^-1 r
            for (std::size_t h = 0; h < n; ++h) rho += inverse_diagonal_[h] * r[h] * r[h];
            if (k == 0) first = last = rho;
            if (!(rho > tolerance * tolerance * first))  // also where a position is not finite
                return {std::move(y), std::move(r)};
            const double beta = rho / last;  // p is zero at first
            last = rho;
            for (std::size_t h = 0; h < n; ++h) p[h] = inverse_diagonal_[h] * r[h] + beta * p[h];
            const double alpha = rho / multiply(p, Bp);
            for (std::size_t h = 0; h < n; ++h) {
                y[h] += alpha * p[h];
                r[h] -= alpha * Bp[h];
            }
        }
        return factorise(q);
    }

  private:
    /// The same for meshes with many slivers, on which conjugate gradients are slow: by elimination.
    Moments factorise(const std::vector<double>& q) const
    {
        const auto n = static_cast<Eigen::Index>(q.size());
        std::vector<Eigen::Triplet<double>> entries;
        for (const PlateFace& face : faces_)
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                    if (face.has_moment[i] && face.has_moment[j])
                        entries.emplace_back(face.hinges[i], face.hinges[j], face.compliance(i, j));
        for (Eigen::Index h = 0; h < n; ++h)  // without a moment
            if (!(inverse_diagonal_[h] > 0.0)) entries.emplace_back(h, h, 1.0);
        Eigen::SparseMatrix<double> B(n, n);
        B.setFromTriplets(entries.begin(), entries.end());
        const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(B);
        const Eigen::VectorXd y = factor.solve(Eigen::Map<const Eigen::VectorXd>(q.data(), n));
        return {{y.begin(), y.end()}, std::vector<double>(q.size(), 0.0)};
    }

    /// Sets B p and returns p . B p.
    double multiply(const std::vector<double>& p, std::vector<double>& Bp) const
    {
        std::fill(Bp.begin(), Bp.end(), 0.0);
        double product = 0.0;
        for (const PlateFace& face : faces_) {
            const Vec3 at_edges = face.gather(p);
            const Vec3 own = face.compliance * at_edges;
            for (int i = 0; i < 3; ++i) Bp[face.hinges[i]] += own[i];
            product += at_edges.dot(own);
        }
        return product;
    }

    const std::vector<PlateFace>& faces_;
    std::vector<double> inverse_diagonal_;
};

/// A diagonal matrix that is at most the face's compliance, so that its inverse is at least the stiffness.
/// Zero where the edge has no moment.
Vec3 least_compliance(const PlateFace& face)
{
    Mat3 scaled = Mat3::Identity();
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (i != j && face.has_moment[i] && face.has_moment[j])
                scaled(i, j) =
                    face.compliance(i, j) / std::sqrt(face.compliance(i, i) * face.compliance(j, j));
    Eigen::SelfAdjointEigenSolver<Mat3> eigen;
    eigen.computeDirect(scaled, Eigen::EigenvaluesOnly);
    constexpr double kRoundOff = 1e-6;  // of the closed form for the eigenvalues
    return std::max(eigen.eigenvalues()[0], kRoundOff) * face.compliance.diagonal();
}

/// 2 sin(theta/2) with the sign of theta; zero where a face has collapsed.
double signed_sine(const std::array<Vec3, 4>& x)
{
    const std::optional<HingeAngle> angle = find_hinge_angle(x);
    return angle ? std::copysign(2.0 * std::sqrt(angle->squared_sine()), sine_of_angle(*angle, x)) : 0.0;
}

bool has_damping(const Linearization& at)
{
    return std::any_of(at.damping.begin(), at.damping.end(), [](double damping) { return damping > 0.0; });
}

/// Rate of signed_sine, 1/s, as the material at the hinge's corners moves with v_k.
double sine_rate(const HingeElement& hinge, const std::vector<PlateFace>& faces, const Linearization& at)
{
    const HingeState state(hinge, at.position);
    const std::optional<HingeAngle> angle = find_hinge_angle(state.x);
    if (!angle) return 0.0;
    std::array<Vec3, 4> velocity;
    for (int i = 0; i < 4; ++i) velocity[i] = at.v_last[hinge.vertices[i]];
    if (at.flow && has_eulerian_vertex(*at.flow, hinge.vertices)) {
        const FaceElement &c = faces[hinge.faces[0]].element, &d = faces[hinge.faces[1]].element;
        const std::array<Mat32, 4> F = find_hinge_deformation(hinge, c, d, at);
        const std::array<int, 4> points = points_of(hinge, c, d);
        for (int i = 0; i < 4; ++i) velocity[i] -= F[i] * at.flow->v_last[points[i]];
    }
    const std::array<Vec3, 4> gradient = angle_gradient(*angle, state.x);
    double rate = 0.0;  // of the angle
    for (int i = 1; i < 4; ++i) rate += gradient[i].dot(velocity[i] - velocity[0]);
    return std::sqrt(angle->squared_cosine()) * rate;
}

/// Adds -dV/dX at fixed positions and moments to the hinges with an EOL vertex. V is the sum of y s / L over
/// hinges, less the faces' energies, of which each hinge of a face takes an equal share.
void add_material_forces(const std::vector<PlateMaterial>& plates, const ClothElements& elements,
                         const std::vector<PlateFace>& faces, const std::vector<double>& y,
                         const std::vector<double>& sine, const MaterialFlow& flow,
                         std::vector<HingeMoment>& moments)
{
    for (std::size_t h = 0; h < moments.size(); ++h) {
        const HingeElement& hinge = elements.hinges[h];
        if (!has_moment(plates, hinge) || !has_eulerian_vertex(flow, hinge.vertices)) continue;
        std::array<Vec2, 4>& force = moments[h].material_force;
        const FaceElement &c = faces[hinge.faces[0]].element, &d = faces[hinge.faces[1]].element;
        const std::array<int, 4> points = points_of(hinge, c, d);
        const Vec2 e = flow.position[points[1]] - flow.position[points[0]];
        // d(1/L) = -e . de / L^3; on a seam L is the mean of both sides, which grow together.
        const double length = hinge.is_seam ? length_of(hinge, faces) : e.norm();
        const Vec2 along = y[h] * sine[h] / (e.squaredNorm() * length) * e;
        force[0] -= along;
        force[1] += along;
        const Mat2 back = turn_over(flow.position, hinge, c, d).transpose();
        for (int side = 0; side < 2; ++side) {
            const PlateFace& face = faces[hinge.faces[side]];
            const std::array<Vec2, 3> gradients = plate_energy_gradients(
                plates[face.element.piece], face.element, face.scale.cwiseProduct(face.gather(y)));
            for (int i = 0; i < 4; ++i)
                for (int k = 0; k < 3; ++k)
                    if (face.element.vertices[k] == hinge.vertices[i]) {
                        const bool is_beyond = hinge.is_seam && side == 1 && i < 2;
                        force[i] +=
                            (is_beyond ? Vec2(back * gradients[k]) : gradients[k]) / face.hinge_count();
                    }
        }
    }
}

}  // namespace

Mat3 plate_compliance(const PlateMaterial& plate, const FaceElement& face)
{
    // With D_i = sym(E_j E_k): D_i : D_i = (|E_j|^2 |E_k|^2 + t_i^2) / 2, D_i : D_j = (t_i t_j + t_k |E_k|^2)
    // / 2, where t_i = tr D_i = E_j . E_k.
    const std::array<Vec2, 3> E = edges_of(face);
    Vec3 squared, trace;
    for (int i = 0; i < 3; ++i) {
        squared[i] = E[i].squaredNorm();
        trace[i] = E[(i + 1) % 3].dot(E[(i + 2) % 3]);
    }
    Mat3 product;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        product(i, i) = 0.5 * (squared[j] * squared[k] + trace[i] * trace[i]);
        product(i, j) = product(j, i) = 0.5 * (trace[i] * trace[j] + trace[k] * squared[k]);
    }
    const double nu = plate.poisson_ratio;
    return ((1.0 + nu) * product - nu * trace * trace.transpose()) /
           (16.0 * face.area * face.area * face.area * plate.stiffness);
}

std::array<Vec2, 3> plate_energy_gradients(const PlateMaterial& plate, const FaceElement& face, const Vec3& y)
{
    const std::array<Vec2, 3> E = edges_of(face);
    const Mat2 M = moment_tensor(face, E, y);
    const double nu = plate.poisson_ratio;
    const Mat2 S = ((1.0 + nu) * M - nu * M.trace() * Mat2::Identity()) / plate.stiffness;
    const double U = 0.5 * face.area * M.cwiseProduct(S).sum();

    // dU = -3 U dA / A - 1 / (4 A) sum_i y_i (S E_k . dE_j + S E_j . dE_k), and dA = A b . dX.
    std::array<Vec2, 3> by_edge, by_corner;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        by_edge[i] = -0.25 / face.area * (S * (y[k] * E[j] + y[j] * E[k]));
    }
    for (int i = 0; i < 3; ++i)  // E_i runs from corner i + 1 to corner i + 2
        by_corner[i] = by_edge[(i + 1) % 3] - by_edge[(i + 2) % 3] - 3.0 * U * face.gradients[i];
    return by_corner;
}

std::vector<HingeMoment> find_hinge_moments(const std::vector<PlateMaterial>& plates,
                                            const ClothElements& elements, const std::vector<Vec3>& position,
                                            const Linearization* at)
{
    const MaterialFlow* flow = at != nullptr && at->flow ? &*at->flow : nullptr;
    const std::size_t n = elements.hinges.size();
    const std::vector<PlateFace> faces = list_faces(plates, elements, flow);
    std::vector<double> length(n), sine(n, 0.0), q(n + 1, 0.0), compliance(n + 1, 0.0);
    for (std::size_t h = 0; h < n; ++h) {
        const HingeElement& hinge = elements.hinges[h];
        if (!has_moment(plates, hinge)) continue;
        length[h] = length_of(hinge, faces);
        sine[h] = signed_sine(HingeState(hinge, position).x);
        q[h] = sine[h] / length[h];
    }
    const MomentEquations equations(faces, n + 1);
    const auto [y, residual] = equations.solve(q, at != nullptr ? kForceTolerance : kEnergyTolerance);
    if (at != nullptr)
        for (const PlateFace& face : faces) {
            const Vec3 least = least_compliance(face);
            for (int i = 0; i < 3; ++i) compliance[face.hinges[i]] += least[i];
        }
    std::vector<HingeMoment> moments(n);
    for (std::size_t h = 0; h < n; ++h) {
        if (!has_moment(plates, elements.hinges[h])) continue;
        moments[h].moment = y[h] / length[h];
        // V = y . q - y . B y / 2 is stationary at the solution: its error is of second order in the
        // residual.
        moments[h].energy = 0.5 * y[h] * (q[h] + residual[h]);
        if (at != nullptr) moments[h].stiffness = 1.0 / (compliance[h] * length[h] * length[h]);
    }
    if (flow != nullptr) add_material_forces(plates, elements, faces, y, sine, *flow, moments);
    if (at != nullptr && has_damping(*at)) {
        std::vector<double> rate(n + 1, 0.0);  // of q
        for (std::size_t h = 0; h < n; ++h)
            if (has_moment(plates, elements.hinges[h]))
                rate[h] = sine_rate(elements.hinges[h], faces, *at) / length[h];
        const std::vector<double> y_rate = equations.solve(rate, kRateTolerance).y;
        for (std::size_t h = 0; h < n; ++h)
            if (has_moment(plates, elements.hinges[h]))
                moments[h].excess_rate = moments[h].stiffness * rate[h] * length[h] - y_rate[h] / length[h];
    }
    return moments;
}

}  // namespace arris
