// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/system/velocity_fit.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "physics/elements/deformation_gradient.h"
#include "physics/system/block_ordering.h"

namespace arris {

namespace {

double cross(const Vec2& a, const Vec2& b)
{
    return a.x() * b.y() - a.y() * b.x();
}

/// A convex polygon of up to nine corners. Two triangles overlap in at most six; rounding may add a few.
struct Polygon {
    std::array<Vec2, 12> corners;
    int count = 0;

    Polygon() = default;
    explicit Polygon(const std::array<Vec2, 3>& triangle)
    {
        for (const Vec2& corner : triangle) add(corner);
    }
    void add(const Vec2& corner)
    {
        if (count < static_cast<int>(corners.size())) corners[count++] = corner;
    }
};

/// The part of the polygon to the left of the line from a to b.
Polygon clip(const Polygon& polygon, const Vec2& a, const Vec2& b)
{
    Polygon kept;
    for (int i = 0; i < polygon.count; ++i) {
        const Vec2& p = polygon.corners[i];
        const Vec2& q = polygon.corners[(i + 1) % polygon.count];
        const double of_p = cross(b - a, p - a), of_q = cross(b - a, q - a);
        if (of_p >= 0.0) kept.add(p);
        if ((of_p > 0.0 && of_q < 0.0) || (of_p < 0.0 && of_q > 0.0))
            kept.add(p + of_p / (of_p - of_q) * (q - p));
    }
    return kept;
}

Polygon overlap(const std::array<Vec2, 3>& a, const std::array<Vec2, 3>& b)
{
    Polygon polygon(a);
    for (int i = 0; i < 3 && polygon.count > 0; ++i) polygon = clip(polygon, b[i], b[(i + 1) % 3]);
    return polygon;
}

Vec3 barycentric(const std::array<Vec2, 3>& triangle, const Vec2& p)
{
    const double area = cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
    const double second = cross(p - triangle[0], triangle[2] - triangle[0]) / area;
    const double third = cross(triangle[1] - triangle[0], p - triangle[0]) / area;
    return {1.0 - second - third, second, third};
}

Vec3 at(const std::array<Vec3, 3>& corners, const Vec3& weights)
{
    return weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
}

struct Box2 {
    Vec2 low, high;

    explicit Box2(const std::array<Vec2, 3>& corners)
        : low(corners[0].cwiseMin(corners[1]).cwiseMin(corners[2])),
          high(corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]))
    {
    }
    bool touches(const Box2& other) const
    {
        return !((low.array() > other.high.array()).any() || (other.low.array() > high.array()).any());
    }
};

/// The old field. Its triangles are sorted by the lower ends of their boxes along the patch's longer side.
class OldField {
  public:
    explicit OldField(const VelocityField& field) : field_(field)
    {
        boxes_.reserve(field.triangles.size());
        for (const std::array<Vec2, 3>& triangle : field.triangles) boxes_.emplace_back(triangle);
        if (boxes_.empty()) return;
        Box2 whole = boxes_.front();
        for (const Box2& box : boxes_) {
            whole.low = whole.low.cwiseMin(box.low);
            whole.high = whole.high.cwiseMax(box.high);
        }
        axis_ = whole.high.x() - whole.low.x() >= whole.high.y() - whole.low.y() ? 0 : 1;
        for (std::size_t t = 0; t < boxes_.size(); ++t) {
            order_.push_back(static_cast<int>(t));
            widest_ = std::max(widest_, boxes_[t].high[axis_] - boxes_[t].low[axis_]);
        }
        std::sort(order_.begin(), order_.end(), [this](int a, int b) { return low(a) < low(b); });
    }

    /// The old triangle equal to `triangle`, and which of its corners is the first of `triangle`.
    std::optional<std::pair<int, int>> find_same(const std::array<Vec2, 3>& triangle) const
    {
        const double at = Box2(triangle).low[axis_];
        for (auto t = first_from(at); t != order_.end() && low(*t) == at; ++t)
            for (int k = 0; k < 3; ++k) {
                const std::array<Vec2, 3>& old = field_.triangles[*t];
                if (triangle[0] == old[k] && triangle[1] == old[(k + 1) % 3] &&
                    triangle[2] == old[(k + 2) % 3])
                    return std::pair(*t, k);
            }
        return {};
    }

    /// Old triangles whose boxes touch the triangle's box, ascending.
    std::vector<int> find_near(const std::array<Vec2, 3>& triangle) const
    {
        const Box2 box(triangle);
        std::vector<int> found;
        // Twice the widest box, so that rounding loses none.
        for (auto t = first_from(box.low[axis_] - 2.0 * widest_);
             t != order_.end() && low(*t) <= box.high[axis_]; ++t)
            if (box.touches(boxes_[*t])) found.push_back(*t);
        std::sort(found.begin(), found.end());
        return found;
    }

    const std::array<Vec2, 3>& triangle(int t) const { return field_.triangles[t]; }
    const std::array<Vec3, 3>& velocity(int t) const { return field_.velocity[t]; }

  private:
    double low(int t) const { return boxes_[t].low[axis_]; }
    std::vector<int>::const_iterator first_from(double bound) const
    {
        return std::lower_bound(order_.begin(), order_.end(), bound,
                                [this](int t, double least) { return low(t) < least; });
    }

    const VelocityField& field_;
    std::vector<Box2> boxes_;
    std::vector<int> order_;
    int axis_ = 0;
    double widest_ = 0.0;  ///< m, largest width of a box along the axis
};

/// Adds density times the integrals, over part of a triangle, of its shape functions times the velocity of an
/// old triangle there.
void add_integrals(double density, const std::array<Vec2, 3>& triangle, const Polygon& part,
                   const std::array<Vec2, 3>& old, const std::array<Vec3, 3>& old_velocity,
                   std::array<Vec3, 3>& sums)
{
    for (int k = 2; k < part.count; ++k) {
        // Products of linear functions: the midpoints of the three sides integrate them exactly.
        const Vec2 &p = part.corners[0], &q = part.corners[k - 1], &r = part.corners[k];
        const double weight = density * 0.5 * cross(q - p, r - p) / 3.0;
        for (const Vec2& middle : {Vec2(0.5 * (p + q)), Vec2(0.5 * (q + r)), Vec2(0.5 * (r + p))}) {
            const Vec3 velocity = at(old_velocity, barycentric(old, middle));
            const Vec3 shape = barycentric(triangle, middle);
            for (int i = 0; i < 3; ++i) sums[i] += weight * shape[i] * velocity;
        }
    }
}

double area_of(const std::array<Vec2, 3>& triangle)
{
    return 0.5 * cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
}

/// Mass times velocity of a triangle with these corner velocities: sum_j m_ij v_j, m_ij = mass / 12 (1 +
/// delta_ij).
std::array<Vec3, 3> times_mass(double mass, const std::array<Vec3, 3>& v)
{
    const Vec3 sum = v[0] + v[1] + v[2];
    return {mass / 12.0 * (sum + v[0]), mass / 12.0 * (sum + v[1]), mass / 12.0 * (sum + v[2])};
}

/// The integrals over a whole new triangle.
std::array<Vec3, 3> integrate_old(double density, const OldField& old, const std::array<Vec2, 3>& triangle)
{
    if (const auto same = old.find_same(triangle)) {  // most triangles are unchanged
        const auto [t, k] = *same;
        const std::array<Vec3, 3>& v = old.velocity(t);
        return times_mass(density * area_of(triangle), {v[k], v[(k + 1) % 3], v[(k + 2) % 3]});
    }
    std::array<Vec3, 3> sums = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    for (const int t : old.find_near(triangle))
        add_integrals(density, triangle, overlap(triangle, old.triangle(t)), old.triangle(t), old.velocity(t),
                      sums);
    return sums;
}

double energy_of(double mass, const std::array<Vec3, 3>& v)
{
    // 1/2 sum m_ij v_i . v_j,  m_ij = mass / 12 (1 + delta_ij)
    return mass / 24.0 *
           (v[0].squaredNorm() + v[1].squaredNorm() + v[2].squaredNorm() +
            (v[0] + v[1] + v[2]).squaredNorm());
}

struct NewFace {
    std::array<Vec2, 3> X;
    Mat32 F;
    double mass;
};

NewFace make_face(double density, const FitPatch& patch, std::size_t f)
{
    const Face& face = patch.faces[f];
    NewFace made;
    made.X = patch.triangles[f];
    made.F = deformation_gradient(made.X, {patch.world[face[0]], patch.world[face[1]], patch.world[face[2]]});
    made.mass = density * area_of(made.X);
    return made;
}

/// The normal equations M u + C^T lambda = r, C u = p. M is the mass matrix of the free coordinates, C u
/// their momentum. M is sparse and positive definite; three further solves eliminate the multipliers.
class NormalEquations {
  public:
    NormalEquations(const FitPatch& patch) : patch_(patch), slot_(patch.world.size(), -1)
    {
        for (std::size_t v = 0; v < slot_.size(); ++v)
            if (patch.is_free[v]) slot_[v] = 3 * free_count_++;
        carried_.setZero(3, 3 * free_count_);
        rhs_.setZero(3 * free_count_);
    }

    bool is_empty() const { return free_count_ == 0; }

    void add(const Face& vertices, const Face& points, const NewFace& face, const std::array<Vec3, 3>& old)
    {
        std::array<Mat3, 3> G;
        std::array<Vec3, 3> known;  // known part of the corner velocities
        for (int i = 0; i < 3; ++i) {
            const int v = vertices[i], p = points[i];
            G[i] = patch_.basis[v] - face.F * patch_.material_basis[p];
            known[i] = patch_.drift[v] - face.F * patch_.material_drift[p];
        }
        for (int i = 0; i < 3; ++i) {
            Vec3 missing = old[i];
            for (int j = 0; j < 3; ++j) missing -= weight(face, i, j) * known[j];
            momentum_ += missing;
            const int row = slot_[vertices[i]];
            if (row < 0) continue;
            rhs_.segment<3>(row) += G[i].transpose() * missing;
            carried_.middleCols<3>(row) += face.mass / 3.0 * G[i];
            for (int j = 0; j < 3; ++j)
                if (const int column = slot_[vertices[j]]; column >= 0 && column <= row)
                    add_block(row, column, weight(face, i, j) * G[i].transpose() * G[j]);
        }
    }

    /// u of each vertex, zero where the vertex is not free.
    std::optional<std::vector<Vec3>> solve() const
    {
        Eigen::SparseMatrix<double> mass(rhs_.size(), rhs_.size());
        mass.setFromTriplets(lower_.begin(), lower_.end());
        const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower, BlockAmdOrdering> factor(mass);
        if (factor.info() != Eigen::Success) return std::nullopt;
        const Eigen::Matrix<double, Eigen::Dynamic, 3> of_unit = factor.solve(carried_.transpose());
        const Eigen::PartialPivLU<Mat3> schur(carried_ * of_unit);

        // The second round corrects the rounding of the first.
        Eigen::VectorXd u = Eigen::VectorXd::Zero(rhs_.size()), left = rhs_;
        Vec3 multiplier = Vec3::Zero(), missing = momentum_;
        for (int round = 0; round < 2; ++round) {
            const Eigen::VectorXd free = factor.solve(left);
            const Vec3 change = schur.solve(carried_ * free - missing);
            u += free - of_unit * change;
            multiplier += change;
            left = rhs_ - mass.selfadjointView<Eigen::Lower>() * u - carried_.transpose() * multiplier;
            missing = momentum_ - carried_ * u;
        }
        constexpr double kSolved = 1e-9;
        if (!u.allFinite() ||
            !(std::hypot(left.norm(), missing.norm()) <= kSolved * std::hypot(rhs_.norm(), momentum_.norm())))
            return std::nullopt;
        std::vector<Vec3> all(slot_.size(), Vec3::Zero());
        for (std::size_t v = 0; v < slot_.size(); ++v)
            if (slot_[v] >= 0) all[v] = u.segment<3>(slot_[v]);
        return all;
    }

  private:
    static double weight(const NewFace& face, int i, int j) { return face.mass / (i == j ? 6.0 : 12.0); }

    /// Adds only nonzero entries. Blocks between Lagrangian vertices are multiples of the identity, to the
    /// bit. So their x, y and z are uncoupled, and the factor stays sparse.
    void add_block(int row, int column, const Mat3& block)
    {
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r)
                if (row + r >= column + c && block(r, c) != 0.0)
                    lower_.emplace_back(row + r, column + c, block(r, c));
    }

    const FitPatch& patch_;
    std::vector<int> slot_;
    int free_count_ = 0;
    std::vector<Eigen::Triplet<double>> lower_;         ///< of M
    Eigen::Matrix<double, 3, Eigen::Dynamic> carried_;  ///< C
    Eigen::VectorXd rhs_;                               ///< r
    Vec3 momentum_ = Vec3::Zero();                      ///< p
};

}  // namespace

double compute_kinetic_energy(const Materials& materials, const VelocityField& field)
{
    double energy = 0.0;
    for (std::size_t t = 0; t < field.triangles.size(); ++t) {
        const std::array<Vec2, 3>& X = field.triangles[t];
        energy += energy_of(materials.at(X[0]).density * area_of(X), field.velocity[t]);
    }
    return energy;
}

std::optional<VelocityFit> fit_velocity(const Materials& materials, const VelocityField& old,
                                        const FitPatch& patch)
{
    NormalEquations equations(patch);
    if (equations.is_empty()) return std::nullopt;
    const OldField old_field(old);
    std::vector<NewFace> faces;
    for (std::size_t f = 0; f < patch.faces.size(); ++f) {
        const double density = materials.at(patch.triangles[f][0]).density;
        faces.push_back(make_face(density, patch, f));
        equations.add(patch.faces[f], patch.points.empty() ? patch.faces[f] : patch.points[f], faces.back(),
                      integrate_old(density, old_field, faces.back().X));
    }
    const std::optional<std::vector<Vec3>> u = equations.solve();
    if (!u) return std::nullopt;

    VelocityFit fit;
    for (std::size_t v = 0; v < u->size(); ++v)
        fit.velocity.push_back(patch.drift[v] + patch.basis[v] * (*u)[v]);
    for (std::size_t p = 0; p < patch.material_drift.size(); ++p) {
        const std::size_t v =
            p < u->size() ? p : static_cast<std::size_t>(patch.seam_vertices[p - u->size()]);
        fit.material_velocity.push_back(patch.material_drift[p] + patch.material_basis[p] * (*u)[v]);
    }
    return fit;
}

}  // namespace arris
