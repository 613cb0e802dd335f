// SPDX-License-Identifier: GPL-3.0-or-later
// Cloth whose material flows through vertices on an edge, compared with closed forms. There is no friction
// and no remeshing; slides are so short that no vertex comes near the edge.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/cloth_input/cloth_grid.h"
#include "physics/forces/energies.h"
#include "physics/forces/inertia.h"
#include "physics/forces/make_terms.h"
#include "tests/physics/sliding_cloth.h"
#include "tests/validation/ode.h"

namespace arris {
namespace {

constexpr double kG = 9.81;
constexpr double kDegree = std::numbers::pi / 180.0;

/// A strip over the edge x = z = 0 between two planes. Their angles below the horizontal along +u are `alpha`
/// before and `beta` beyond the edge, in radians. A negative `alpha` rises towards the edge.
struct Fold {
    double alpha = 0.0, beta = 0.5 * std::numbers::pi;

    Vec3 direction(double s) const
    {
        const double angle = s < 0.0 ? alpha : beta;
        return {std::cos(angle), 0.0, -std::sin(angle)};
    }
    Vec3 normal(double s) const
    {
        const double angle = s < 0.0 ? alpha : beta;
        return {std::sin(angle), 0.0, std::cos(angle)};
    }
    /// The bisector of the normals; straight up over a wire.
    Vec3 nbar() const
    {
        const Vec3 sum = normal(-1.0) + normal(1.0);
        return sum.norm() > 1e-6 ? Vec3(sum.normalized()) : Vec3::UnitZ();
    }
};

struct Strip {
    Fold fold;
    double length = 1.0, width = 0.1;  ///< m
    double at_edge = 0.9;              ///< u on the edge at the start, m
    int cells = 8, rows = 2;
    double skew = 0.0;  ///< inclination of the columns, in cells
    double density = 0.1, modulus = 2e5, bending = 1e-7;

    double cell() const { return length / cells; }
};

/// Columns of the grid nearer to the edge than this are left out for the EOL column.
constexpr double kClearance = 0.3;  // in cells

std::vector<double> columns_of(const Strip& strip)
{
    std::vector<double> columns;
    for (int j = 0; j <= strip.cells; ++j) {
        const double u = j * strip.cell();
        const bool is_end = j == 0 || j == strip.cells;
        if (is_end || std::abs(u - strip.at_edge) > kClearance * strip.cell()) columns.push_back(u);
    }
    columns.push_back(strip.at_edge);
    std::sort(columns.begin(), columns.end());
    return columns;
}

struct StripMesh {
    ClothMesh mesh;
    std::vector<char> is_on_edge;
    int height = 0;  ///< vertices in a column; numbering is by columns
};

StripMesh make_strip_mesh(const Strip& strip)
{
    StripMesh result;
    const std::vector<double> columns = columns_of(strip);
    const int height = strip.rows + 1, width = static_cast<int>(columns.size());
    result.height = height;
    for (int i = 0; i < width; ++i)
        for (int j = 0; j < height; ++j) {
            const double f = static_cast<double>(j) / strip.rows;
            const bool is_edge = columns[i] == strip.at_edge;
            const bool leans = i > 0 && i + 1 < width && !is_edge;
            const double u = columns[i] + (leans ? strip.skew * strip.cell() * (f - 0.5) : 0.0);
            const double s = u - strip.at_edge;
            result.mesh.material.emplace_back(u, f * strip.width);
            result.mesh.world.push_back(s * strip.fold.direction(s) + f * strip.width * Vec3::UnitY());
            result.is_on_edge.push_back(is_edge);
        }
    for (int i = 0; i + 1 < width; ++i)
        for (int j = 0; j < strip.rows; ++j) {
            const int a = i * height + j, b = a + height, c = b + 1, d = a + 1;
            const bool falls = (i + j) % 2 == 1;
            result.mesh.faces.push_back(falls ? Face{a, b, c} : Face{a, b, d});
            result.mesh.faces.push_back(falls ? Face{a, c, d} : Face{b, c, d});
        }
    return result;
}

/// Material direction of flow on the edge: along the cloth's border, or across the trace.
Vec2 flow_direction(const ClothMesh& mesh, int v, int height)
{
    const int row = v % height;
    if (row == 0 || row + 1 == height) return Vec2::UnitX();
    const Vec2 trace = mesh.material[v + 1] - mesh.material[v - 1];
    return Vec2(trace.y(), -trace.x()).normalized();
}

SlidingCloth make_strip(const Strip& strip)
{
    const StripMesh made = make_strip_mesh(strip);
    const Material material{strip.density, strip.modulus, 0.0, strip.bending, 0.0, 1e-3};
    const Fold fold = strip.fold;
    const auto coordinates = [fold, is_on_edge = made.is_on_edge,
                              height = made.height](const SlidingCloth& cloth) {
        std::vector<VertexCoordinates> result;
        for (int v = 0; v < cloth.mesh.vertex_count(); ++v) {
            const Vec3& x = cloth.mesh.world[v];
            const double side = x.dot(fold.direction(1.0) + fold.direction(-1.0));
            result.push_back(is_on_edge[v]
                                 ? on_edge(Vec3::UnitY(), fold.nbar(), flow_direction(cloth.mesh, v, height))
                                 : on_face(fold.normal(side)));
        }
        return result;
    };
    return SlidingCloth(make_terms(material, Gravity{Vec3(0, 0, -kG)}, {}, {}), made.mesh, coordinates);
}

/// Distance of the last column along its slope, m.
double hanging(const SlidingCloth& cloth, const Strip& strip)
{
    double sum = 0.0;
    for (int j = 0; j <= strip.rows; ++j)
        sum += cloth.mesh.world[cloth.mesh.world.size() - 1 - j].dot(strip.fold.direction(1.0));
    return sum / (strip.rows + 1);
}

/// Material beyond the edge, m: the mean over the EOL column.
double slid(const SlidingCloth& cloth, const Strip& strip)
{
    double sum = 0.0;
    int count = 0;
    const std::vector<VertexCoordinates> coordinates = cloth.coordinates(cloth);
    for (int v = 0; v < cloth.mesh.vertex_count(); ++v) {
        if (!coordinates[v].is_eulerian()) continue;
        sum += strip.at_edge - cloth.mesh.material[v].x();
        ++count;
    }
    return sum / count;
}

double least_area(const ClothMesh& mesh)
{
    double least = 1e9;
    for (const Face& f : mesh.faces)
        least = std::min(least, twice_area(mesh.material[f[0]], mesh.material[f[1]], mesh.material[f[2]]));
    return least;
}

double gravity_energy(const SlidingCloth& cloth)
{
    return compute_energies(cloth.elements, cloth.terms, cloth.mesh.world).gravity;
}

/// Relative errors after a slide of `duration`: of the length beyond the edge, and of the energy relative to
/// the energy exchanged. The exact length is at_start + growth (cosh(rate duration) - 1).
struct SlideErrors {
    double length, energy;
};

struct Slide {
    double growth, rate;  ///< m, 1/s
    double duration;      ///< s
};

SlideErrors measure(const Strip& strip, const Slide& slide, int steps)
{
    SlidingCloth cloth = make_strip(strip);
    const double energy = cloth.total_energy(strip.density), height = gravity_energy(cloth);
    cloth.advance(slide.duration, steps);
    EXPECT_GT(least_area(cloth.mesh), 0.0);
    const double exact =
        strip.length - strip.at_edge + slide.growth * (std::cosh(slide.rate * slide.duration) - 1.0);
    return {std::abs(hanging(cloth, strip) / exact - 1.0),
            std::abs(cloth.total_energy(strip.density) - energy) / std::abs(gravity_energy(cloth) - height)};
}

/// Checks second order in the time step down to 1.25 ms, and an error below `bound` at 5 ms.
void expect_second_order(const Strip& strip, const Slide& slide, double bound)
{
    SCOPED_TRACE(testing::Message() << strip.cells << " cells, skew " << strip.skew);
    const int steps = static_cast<int>(std::lround(slide.duration / 0.005));
    const SlideErrors coarse = measure(strip, slide, steps / 2), middle = measure(strip, slide, steps),
                      fine = measure(strip, slide, 4 * steps);
    EXPECT_LT(middle.length, bound);
    EXPECT_LT(middle.energy, 10.0 * bound);  // relative to the energy exchanged, which is small
    constexpr double kOrder = 1.85;          // reduced by the first step (implicit Euler) and stretch (1e-6)
    EXPECT_GT(std::log2(coarse.length / middle.length), kOrder);
    EXPECT_GT(0.5 * std::log2(middle.length / fine.length), kOrder);
}

TEST(Sliding, StripOverATableEdgeFollowsTheHyperbolicCosineOnAnyMesh)
{
    // x = x0 cosh(t sqrt(g / L)): 6.6 cm in 0.35 s, which is less than the clearance at 4 cells.
    for (const int cells : {4, 8})
        for (const double skew : {0.0, 0.4}) {
            Strip strip;
            strip.cells = cells;
            strip.skew = skew;
            expect_second_order(strip, {0.1, std::sqrt(kG), 0.35}, 3e-4);
        }
}

TEST(Sliding, StripOverAWireFollowsTheHyperbolicCosineOnAnyMesh)
{
    // From y0 off equilibrium, y = y0 cosh(t sqrt(2 g / L)).
    for (const int cells : {4, 8}) {
        Strip strip;
        strip.fold = {-90.0 * kDegree, 90.0 * kDegree};
        strip.at_edge = 0.45;
        strip.cells = cells;
        strip.skew = 0.2;
        expect_second_order(strip, {0.05, std::sqrt(2.0 * kG), 0.25}, 1e-4);
    }
}

TEST(Sliding, StripInBalanceOverARidgeDoesNotCreep)
{
    // The bending energy of a fold depends on the widths of the cells beside it. With -F^T f in place of
    // -dV/dX the strip slips by centimetres at K = 1e-4. The remaining slip is the strip's stretch under its
    // weight, ~ 1 / E.
    for (const double modulus : {2e4, 2e5})
        for (const double bending : {1e-7, 1e-4})
            for (const int cells : {7, 8, 12}) {
                SCOPED_TRACE(testing::Message() << modulus << " N/m, " << bending << " J, " << cells);
                Strip strip;
                strip.fold = {-20.0 * kDegree, 45.0 * kDegree};
                // In equilibrium the lengths are in the ratio sin 45 : sin 20.
                const double upper = std::sin(45.0 * kDegree), lower = std::sin(20.0 * kDegree);
                strip.at_edge = upper / (upper + lower);
                strip.cells = cells;
                strip.skew = 0.3;
                strip.modulus = modulus;
                strip.bending = bending;
                SlidingCloth cloth = make_strip(strip);
                double greatest = 0.0;
                for (int k = 0; k < 200; ++k) {
                    cloth.step(0.005);
                    greatest = std::max(greatest, std::abs(slid(cloth, strip)));
                }
                EXPECT_LT(greatest, 2e-5 * (2e4 / modulus));
            }
}

struct Swing {
    double angle, rate;
};

/// One element of cloth is paid out at `rate` from a fixed edge along y. Its initial length is `length`, and
/// it swings from the angle and rate `start` relative to straight down.
struct PayOut {
    double length, rate;  ///< m, m/s
    Swing start;
    double gravity;   ///< m/s^2
    double duration;  ///< s
};

Swing run(const PayOut& p, int steps, bool has_convection)
{
    constexpr double kWidth = 0.1, kTotal = 2.0;
    const Vec3 d(std::sin(p.start.angle), 0.0, -std::cos(p.start.angle));
    const Vec3 across(std::cos(p.start.angle), 0.0, std::sin(p.start.angle));
    ClothMesh mesh;
    mesh.material = {Vec2(kTotal - p.length, 0), Vec2(kTotal - p.length, kWidth), Vec2(kTotal, 0),
                     Vec2(kTotal, kWidth)};
    for (const Vec2& X : mesh.material)
        mesh.world.push_back((X.x() - kTotal + p.length) * d + X.y() * Vec3::UnitY());
    mesh.faces = {{0, 2, 1}, {2, 3, 1}};
    // The cloth stretches by 1e-6; bending has a smaller effect.
    const Material material{0.1, 3e3, 0.0, 1.0, 0.0, 1e-3};
    const auto coordinates = [rate = p.rate](const SlidingCloth&) {
        VertexCoordinates paying = on_edge(Vec3::UnitY(), Vec3::UnitX(), -Vec2::UnitX());
        paying.known = {0.0, 0.0, rate};
        return std::vector<VertexCoordinates>{paying, paying, {}, {}};
    };
    SlidingCloth cloth(make_terms(material, Gravity{Vec3(0, 0, -p.gravity)}, {}, {}), mesh, coordinates);
    cloth.has_convection = has_convection;
    for (const int v : {0, 1}) cloth.material_velocity[v] = Vec2(-p.rate, 0.0);
    for (const int v : {2, 3}) cloth.velocity[v] = p.rate * d + p.length * p.start.rate * across;
    cloth.advance(p.duration, steps);
    const Vec3 end = cloth.mesh.world[2] - cloth.mesh.world[0];
    const double angle = std::atan2(end.x(), -end.z());
    return {angle, cloth.velocity[2].dot(Vec3(std::cos(angle), 0.0, std::sin(angle))) / end.norm()};
}

/// Integrates the equation of motion thetaddot = -(3 ldot thetadot + 3/2 g sin theta) / l, from the moment of
/// momentum about the edge.
Swing integrate(const PayOut& p)
{
    const auto slope = [&](double t, const Eigen::Vector2d& y) -> Eigen::Vector2d {
        return {y[1], -(3.0 * p.rate * y[1] + 1.5 * p.gravity * std::sin(y[0])) / (p.length + p.rate * t)};
    };
    const Eigen::Vector2d end =
        integrate_rk4(Eigen::Vector2d(p.start.angle, p.start.rate), 0.0, p.duration, 20000, slope);
    return {end[0], end[1]};
}

TEST(Sliding, ClothThatSwingsWhileItIsPaidOutSlowsAsTheCubeOfItsLength)
{
    // Without gravity thetadot = thetadot0 (l0 / l)^3.
    const PayOut pay_out{0.2, 0.4, {0.0, 2.0}, 0.0, 0.5};
    const Swing exact = integrate(pay_out);
    ASSERT_NEAR(exact.angle, 0.375, 1e-9);
    ASSERT_NEAR(exact.rate, 0.25, 1e-9);
    std::vector<double> angles;
    for (const int steps : {100, 400, 800, 1600}) {
        const Swing swing = run(pay_out, steps, true);
        EXPECT_NEAR(swing.rate, exact.rate, 1e-4);
        EXPECT_NEAR(swing.angle, exact.angle, 2e-4);
        angles.push_back(swing.angle);
    }
    EXPECT_NEAR(angles.back(), exact.angle, 3e-6);
    // Second order: differences fall by a factor of 4. The errors themselves level off at the cloth's
    // stretch, 1e-6.
    EXPECT_GT((angles[1] - angles[2]) / (angles[2] - angles[3]), 3.6);

    // Inertia without 2 Fdot V conserves another quantity: thetadot falls only with the square of the length.
    EXPECT_NEAR(run(pay_out, 200, false).rate, 0.5, 1e-3);
}

TEST(Sliding, PendulumThatIsPaidOutFollowsItsEquation)
{
    const PayOut pay_out{0.2, 0.4, {0.3, 0.0}, kG, 1.0};
    const Swing exact = integrate(pay_out), swing = run(pay_out, 400, true);
    ASSERT_NEAR(exact.angle, 0.0722, 1e-4);
    EXPECT_NEAR(swing.angle, exact.angle, 1e-4);
    EXPECT_NEAR(swing.rate, exact.rate, 1e-3);
}

/// A free sheet of 1 m without gravity. Its middle vertex is EOL, on a point or on an edge along y.
SlidingCloth make_free_sheet(bool is_on_point)
{
    ClothGrid grid;
    grid.resolution = {4, 4};
    grid.pattern = GridPattern::Alternating;
    const ClothMesh mesh = make_cloth_grid(grid);
    const int eol = mesh.vertex_count() / 2;
    const auto coordinates = [is_on_point, eol](const SlidingCloth& cloth) {
        std::vector<VertexCoordinates> result(cloth.mesh.world.size());
        result[eol] =
            is_on_point ? on_point(Vec3::UnitZ()) : on_edge(Vec3::UnitY(), Vec3::UnitZ(), Vec2::UnitX());
        return result;
    };
    return SlidingCloth(make_terms(Material{0.1, 1e3, 0.3, 1e-4, 0.0, 1e-3}, {}, {}, {}), mesh, coordinates);
}

/// Gives the sheet's material the velocities `velocity_at`(x).
template <typename VelocityAt>
void set_in_motion(SlidingCloth& cloth, const VelocityAt& velocity_at)
{
    const std::vector<VertexCoordinates> c = cloth.coordinates(cloth);
    for (int v = 0; v < cloth.mesh.vertex_count(); ++v) {
        const Vec3 w = velocity_at(cloth.mesh.world[v]);
        Mat32 F;
        F << 1, 0, 0, 1, 0, 0;
        const Vec3 u = corner_matrix(F, c[v].basis, c[v].material_basis).inverse() * w;
        cloth.velocity[v] = c[v].basis * u;
        cloth.material_velocity[v] = c[v].material_basis * u;
    }
}

TEST(Sliding, FlatClothPassesAPointOrAnEdgeAsIfItWereNotThere)
{
    for (const bool is_on_point : {true, false}) {
        SlidingCloth cloth = make_free_sheet(is_on_point);
        const Vec3 velocity(0.3, -0.2, 0.0);
        set_in_motion(cloth, [&](const Vec3&) { return velocity; });
        const int eol = cloth.mesh.vertex_count() / 2;
        const Vec3 x = cloth.mesh.world[eol];
        const Vec2 X = cloth.mesh.material[eol];
        cloth.advance(0.1, 20);
        const CornerVelocities corners = compute_corner_velocities(cloth.elements, cloth.mesh.world,
                                                                   cloth.velocity, cloth.material_velocity);
        for (const auto& face : corners)
            for (const Vec3& w : face) EXPECT_LT((w - velocity).norm(), 1e-12);
        const Vec3 along_edge = is_on_point ? Vec3::Zero() : Vec3(0.0, velocity.y(), 0.0);
        EXPECT_LT((cloth.mesh.world[eol] - x - 0.1 * along_edge).norm(), 1e-12);
        EXPECT_LT((cloth.mesh.material[eol] - X + 0.1 * (velocity - along_edge).head<2>()).norm(), 1e-12);
    }
}

/// Relative gain of angular momentum of a sheet that turns about an axis while sliding over a point beside
/// that axis.
double spin_gain(int steps, bool has_convection)
{
    SlidingCloth cloth = make_free_sheet(true);
    cloth.has_convection = has_convection;
    for (Vec3& x : cloth.mesh.world) x -= Vec3(0.3, 0.4, 0.0);  // the axis does not pass through the point
    set_in_motion(cloth, [](const Vec3& x) { return Vec3::UnitZ().cross(x); });
    const auto momentum = [&] {
        const CornerVelocities corners = compute_corner_velocities(cloth.elements, cloth.mesh.world,
                                                                   cloth.velocity, cloth.material_velocity);
        return angular_momentum(Material{0.1}, cloth.elements, cloth.mesh.world, corners).z();
    };
    const double before = momentum();
    cloth.advance(0.2, steps);
    return momentum() / before - 1.0;
}

TEST(Sliding, ClothThatSpinsOverAPointKeepsItsAngularMomentum)
{
    // No force acts in the plane, so angular momentum is conserved to second order. Without 2 Fdot V it is
    // not conserved.
    const double coarse = spin_gain(20, true), fine = spin_gain(80, true);
    EXPECT_LT(std::abs(coarse), 1e-4);
    EXPECT_GT(0.5 * std::log2(coarse / fine), 1.9);
    EXPECT_GT(std::abs(spin_gain(80, false)), 1e-3);
}

}  // namespace
}  // namespace arris
