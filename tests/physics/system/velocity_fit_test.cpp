// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/system/velocity_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace arris {
namespace {

constexpr double kRoundOff = 1e-12;  // for values of about 1
constexpr double kDensity = 0.7;

class Random {
  public:
    double next()
    {
        state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
        return 2.0 * static_cast<double>(state_ >> 11) / 9007199254740992.0 - 1.0;
    }
    Vec3 vector() { return {next(), next(), next()}; }

  private:
    std::uint64_t state_ = 1;
};

/// A square of n x n cells, each cut along one diagonal; all vertices are free and Lagrangian.
FitPatch make_patch(int n, bool is_other_diagonal)
{
    FitPatch patch;
    std::vector<Vec2> material;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            material.emplace_back(double(i) / n, double(j) / n);
            patch.world.emplace_back(double(i) / n, double(j) / n, 0.0);
        }
    const std::size_t count = material.size();
    patch.is_free.assign(count, 1);
    patch.drift.assign(count, Vec3::Zero());
    patch.material_drift.assign(count, Vec2::Zero());
    patch.basis.assign(count, Mat3::Identity());
    patch.material_basis.assign(count, Mat23::Zero());
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const int a = i + j * (n + 1), b = a + 1, c = b + n + 1, d = a + n + 1;
            if (is_other_diagonal) {
                patch.faces.push_back({a, b, d});
                patch.faces.push_back({b, c, d});
            } else {
                patch.faces.push_back({a, b, c});
                patch.faces.push_back({a, c, d});
            }
        }
    for (const auto& [a, b, c] : patch.faces)
        patch.triangles.push_back({material[a], material[b], material[c]});
    return patch;
}

/// The velocity field of a patch of Lagrangian vertices.
VelocityField field_of(const FitPatch& patch, const std::vector<Vec3>& velocity)
{
    VelocityField field;
    field.triangles = patch.triangles;
    for (const Face& f : patch.faces) {
        field.velocity.push_back({velocity[f[0]], velocity[f[1]], velocity[f[2]]});
    }
    return field;
}

Vec3 momentum(const VelocityField& field)
{
    Vec3 sum = Vec3::Zero();
    for (std::size_t t = 0; t < field.triangles.size(); ++t) {
        const auto& X = field.triangles[t];
        const Vec2 p = X[1] - X[0], q = X[2] - X[0];
        const double area = 0.5 * (p.x() * q.y() - p.y() * q.x());
        for (const Vec3& v : field.velocity[t]) sum += kDensity * area / 3.0 * v;
    }
    return sum;
}

std::vector<Vec3> random_velocities(std::size_t count, Random& random)
{
    std::vector<Vec3> velocity;
    for (std::size_t v = 0; v < count; ++v) velocity.push_back(random.vector());
    return velocity;
}

/// Kinetic energy of the fitted velocity less that of the old field, J. Material at a corner moves with
/// xdot - F Xdot.
double energy_gain(const VelocityField& old, const FitPatch& patch, const VelocityFit& fit)
{
    VelocityField fitted;
    fitted.triangles = patch.triangles;
    for (std::size_t f = 0; f < patch.faces.size(); ++f) {
        const auto& [a, b, c] = patch.faces[f];
        const std::array<Vec2, 3>& X = patch.triangles[f];
        Mat2 material;
        material << X[1] - X[0], X[2] - X[0];
        Mat32 world;
        world << patch.world[b] - patch.world[a], patch.world[c] - patch.world[a];
        const Mat32 F = world * material.inverse();
        const auto corner = [&](int v) { return Vec3(fit.velocity[v] - F * fit.material_velocity[v]); };
        fitted.velocity.push_back({corner(a), corner(b), corner(c)});
    }
    return compute_kinetic_energy(Material{kDensity}, fitted) -
           compute_kinetic_energy(Material{kDensity}, old);
}

TEST(VelocityFit, ChangesNothingWhereTheMeshIsTheSame)
{
    Random random;
    const FitPatch patch = make_patch(3, false);
    const std::vector<Vec3> velocity = random_velocities(patch.world.size(), random);
    const auto fit = fit_velocity(Material{kDensity}, field_of(patch, velocity), patch);
    ASSERT_TRUE(fit);
    for (std::size_t v = 0; v < velocity.size(); ++v)
        EXPECT_NEAR((fit->velocity[v] - velocity[v]).norm(), 0.0, kRoundOff);
    EXPECT_NEAR(energy_gain(field_of(patch, velocity), patch, *fit), 0.0, kRoundOff);
}

TEST(VelocityFit, DoesNotDependOnTheCornerAtWhichATriangleStarts)
{
    Random random;
    const FitPatch patch = make_patch(3, false);
    const std::vector<Vec3> velocity = random_velocities(patch.world.size(), random);
    VelocityField field = field_of(patch, velocity);
    for (std::size_t t = 0; t < field.triangles.size(); ++t) {
        const auto by = static_cast<std::ptrdiff_t>(t % 3);
        std::rotate(field.triangles[t].begin(), field.triangles[t].begin() + by, field.triangles[t].end());
        std::rotate(field.velocity[t].begin(), field.velocity[t].begin() + by, field.velocity[t].end());
    }
    const auto fit = fit_velocity(Material{kDensity}, field, patch);
    ASSERT_TRUE(fit);
    for (std::size_t v = 0; v < velocity.size(); ++v)
        EXPECT_NEAR((fit->velocity[v] - velocity[v]).norm(), 0.0, kRoundOff);
}

TEST(VelocityFit, KeepsMomentumAndGainsNoEnergyInFreeClothOnAnotherMesh)
{
    Random random;
    for (const int n : {1, 2, 5}) {
        const FitPatch old = make_patch(n, false), other = make_patch(n, true);
        const std::vector<Vec3> velocity = random_velocities(old.world.size(), random);
        const VelocityField field = field_of(old, velocity);
        const auto fit = fit_velocity(Material{kDensity}, field, other);
        ASSERT_TRUE(fit);
        EXPECT_NEAR((momentum(field_of(other, fit->velocity)) - momentum(field)).norm(), 0.0, kRoundOff);
        EXPECT_LE(energy_gain(field, other, *fit),
                  kRoundOff * compute_kinetic_energy(Material{kDensity}, field));
        EXPECT_LT(energy_gain(field, other, *fit), -1e-4) << "a random field cannot be carried over whole";
    }
}

TEST(VelocityFit, IsTheNearestFieldOfThatMomentum)
{
    Random random;
    const FitPatch old = make_patch(3, false);
    FitPatch other = make_patch(3, true);
    const std::vector<Vec3> velocity = random_velocities(old.world.size(), random);
    // Only the two vertices in the middle of each inner row are free.
    for (std::size_t v = 0; v < other.is_free.size(); ++v) {
        const Vec2 X = other.world[v].head<2>();
        other.is_free[v] = X.x() > 0.1 && X.x() < 0.9 && X.y() > 0.1 && X.y() < 0.9;
        if (!other.is_free[v]) other.drift[v] = velocity[v];
    }
    const VelocityField field = field_of(old, velocity);
    const auto fit = fit_velocity(Material{kDensity}, field, other);
    ASSERT_TRUE(fit);
    EXPECT_NEAR((momentum(field_of(other, fit->velocity)) - momentum(field)).norm(), 0.0, kRoundOff);
    // Squared distance to the old field by fine quadrature; changes without net momentum must increase this
    // distance.
    const auto squared_distance = [&](const std::vector<Vec3>& candidate) {
        const VelocityField fitted = field_of(other, candidate);
        double sum = 0.0;
        constexpr int kPoints = 300;
        for (int i = 0; i < kPoints; ++i)
            for (int j = 0; j < kPoints; ++j) {
                const Vec2 p((i + 0.5) / kPoints, (j + 0.5) / kPoints);
                const auto sample = [&](const VelocityField& f) {
                    for (std::size_t t = 0; t < f.triangles.size(); ++t) {
                        const auto& X = f.triangles[t];
                        Mat2 D;
                        D << X[1] - X[0], X[2] - X[0];
                        const Vec2 w = D.inverse() * (p - X[0]);
                        if (w.minCoeff() >= -1e-12 && w.sum() <= 1.0 + 1e-12)
                            return Vec3((1.0 - w.sum()) * f.velocity[t][0] + w[0] * f.velocity[t][1] +
                                        w[1] * f.velocity[t][2]);
                    }
                    return Vec3(Vec3::Zero());
                };
                sum += (sample(fitted) - sample(field)).squaredNorm();
            }
        return sum / (kPoints * kPoints);
    };
    const double best = squared_distance(fit->velocity);
    std::vector<int> free;
    for (std::size_t v = 0; v < other.is_free.size(); ++v)
        if (other.is_free[v]) free.push_back(static_cast<int>(v));
    ASSERT_EQ(free.size(), 4u);
    for (int trial = 0; trial < 6; ++trial) {
        std::vector<Vec3> candidate = fit->velocity;
        const Vec3 change = 0.2 * random.vector();
        candidate[free[trial % 3]] += change;  // all four free vertices have equal mass
        candidate[free[3]] -= change;
        EXPECT_GT(squared_distance(candidate), best);
    }
}

/// Flat, translating cloth with one vertex through which the material flows.
TEST(VelocityFit, FindsTheVelocityOfAnEolVertexOnFlatClothExactly)
{
    Random random;
    const FitPatch old = make_patch(2, false);
    FitPatch flowing = old;
    const int middle = 4;
    Mat3 basis = Mat3::Zero();
    basis.col(0) = Vec3::UnitZ();
    basis.col(1) = Vec3::UnitY();
    flowing.basis[middle] = basis;
    flowing.material_basis[middle].col(2) = Vec2::UnitX();
    for (std::size_t v = 0; v < flowing.is_free.size(); ++v) flowing.is_free[v] = v == middle;
    const Vec3 velocity = random.vector();
    for (Vec3& drift : flowing.drift) drift = velocity;
    flowing.drift[middle] = Vec3::Zero();
    const auto fit = fit_velocity(Material{kDensity},
                                  field_of(old, std::vector<Vec3>(old.world.size(), velocity)), flowing);
    ASSERT_TRUE(fit);
    EXPECT_NEAR((fit->velocity[middle] - Vec3(0, velocity.y(), velocity.z())).norm(), 0.0, kRoundOff);
    EXPECT_NEAR((fit->material_velocity[middle] - Vec2(-velocity.x(), 0)).norm(), 0.0, kRoundOff);
    EXPECT_NEAR(energy_gain(field_of(old, std::vector<Vec3>(old.world.size(), velocity)), flowing, *fit), 0.0,
                kRoundOff);
}

TEST(VelocityFit, DoesNotDependOnWhereTheClothIsOrHowLargeItIs)
{
    for (const double scale : {1e-3, 1.0, 1e3}) {
        Random random;
        FitPatch old = make_patch(2, false), other = make_patch(2, true);
        for (FitPatch* patch : {&old, &other})
            for (std::array<Vec2, 3>& X : patch->triangles)
                for (Vec2& corner : X) corner = scale * (corner + Vec2(100, -50));
        const std::vector<Vec3> velocity = random_velocities(old.world.size(), random);
        const auto fit = fit_velocity(Material{kDensity}, field_of(old, velocity), other);
        ASSERT_TRUE(fit);
        const Vec3 before = momentum(field_of(old, velocity)),
                   after = momentum(field_of(other, fit->velocity));
        // The offset of coordinates is 100 times the cloth's size.
        EXPECT_NEAR((after - before).norm(), 0.0, 1e-11 * scale * scale);
        EXPECT_LE(energy_gain(field_of(old, velocity), other, *fit),
                  1e-11 * compute_kinetic_energy(Material{kDensity}, field_of(old, velocity)));
    }
}

TEST(VelocityFit, WithoutFreeVerticesThereIsNone)
{
    FitPatch patch = make_patch(1, false);
    patch.is_free.assign(4, 0);
    EXPECT_FALSE(
        fit_velocity(Material{kDensity}, field_of(patch, std::vector<Vec3>(4, Vec3::UnitX())), patch));
}

}  // namespace
}  // namespace arris
