// SPDX-License-Identifier: GPL-3.0-or-later
// A nearly rigid plate of two faces swings about its pinned edge: the physical pendulum at large amplitude.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cloth_run.h"
#include "ode.h"
#include "refinement.h"

namespace arris {
namespace {

constexpr double kG = 9.81;
constexpr double kLength = 1.0;  // m, from the pinned edge
constexpr double kDensity = 0.1;

/// Complete elliptic integral of the first kind, modulus k, by the arithmetic-geometric mean.
double elliptic_integral(double k)
{
    double a = 1.0, b = std::sqrt(1.0 - k * k);
    for (int i = 0; i < 20; ++i) {
        const double mean = 0.5 * (a + b);
        b = std::sqrt(a * b);
        a = mean;
    }
    return 0.5 * std::numbers::pi / a;
}

/// T = 4 K(sin(theta_0 / 2)) / omega, omega^2 = m g (L / 2) / (m L^2 / 3).
double exact_period(double amplitude)
{
    return 4.0 * elliptic_integral(std::sin(0.5 * amplitude)) / std::sqrt(1.5 * kG / kLength);
}

ClothRun make_plate(double amplitude, Integrator integrator, double modulus = 1e4)
{
    Scene scene;
    scene.materials[0] = {kDensity, modulus, 0.0,
                          1.0,      0.0,     1e-3};  // bending stiffness 1 J: practically rigid
    scene.gravity = Gravity{Vec3(0.0, 0.0, -kG)};
    scene.pins.push_back({{Vec2(0.0, 0.0), Vec2(0.0, 0.6)}, {}, {true, true, true}});
    ClothMesh mesh = make_sheet(Vec2(kLength, 0.6), {1, 1}, GridPattern::Diagonal);
    for (std::size_t v = 0; v < mesh.world.size(); ++v) {
        const double u = mesh.material[v].x();
        mesh.world[v] = Vec3(u * std::sin(amplitude), mesh.material[v].y(), -u * std::cos(amplitude));
    }
    ClothRun run(scene, mesh);
    run.settings.integrator = integrator;
    return run;
}

Vec3 hem(const ClothRun& run)
{
    return 0.5 * (run.state.mesh.world[1] + run.state.mesh.world[3]);
}

double hem_speed(const ClothRun& run)
{
    return 0.5 * (run.state.velocity[1].x() + run.state.velocity[3].x());
}

/// Four times the time from rest to the first pass through straight down.
double measure_period(double amplitude, double h)
{
    ClothRun run = make_plate(amplitude, Integrator::Bdf2);
    while (run.state.time < 5.0) {
        const double x0 = hem(run).x(), v0 = hem_speed(run);
        if (run.advance(h).status != StepStatus::Done) break;
        const double x1 = hem(run).x(), v1 = hem_speed(run);
        if (x1 > 0.0) continue;
        // Finds the zero of the cubic that has position and velocity at both ends of the step.
        double low = 0.0, high = 1.0;
        for (int k = 0; k < 60; ++k) {
            const double s = 0.5 * (low + high), r = 1.0 - s;
            const double x =
                r * r * ((1.0 + 2.0 * s) * x0 + s * h * v0) + s * s * ((3.0 - 2.0 * s) * x1 - r * h * v1);
            (x > 0.0 ? low : high) = s;
        }
        return 4.0 * (run.state.time - h + low * h);
    }
    ADD_FAILURE() << "never passes straight down";
    return 0.0;
}

/// Share of its amplitude that implicit Euler loses in half a period, when the exact pendulum is at rest
/// again. Implicit Euler's leading error is damping, which leaves the period of small swings unchanged.
double measure_loss(double amplitude, double h)
{
    ClothRun run = make_plate(amplitude, Integrator::ImplicitEuler);
    run.advance(0.5 * exact_period(amplitude), h);
    const double angle = std::atan2(-hem(run).x(), -hem(run).z());
    return 1.0 - angle / amplitude;
}

/// Result of halving the step from `first` on. `order` is measured from the changes between steps; `limit` is
/// Richardson's.
struct Refinement {
    double order = 0.0, limit = 0.0;
    std::vector<std::string> row;  ///< the values less `exact`, then the order
};

template <typename Measure>
Refinement refine(const Measure& measure, double first, double order, double exact)
{
    std::vector<double> steps, changes;
    Refinement refinement;
    double last = 0.0;
    for (int k = 0; k < 5; ++k) {
        const double h = std::ldexp(first, -k), value = measure(h);
        refinement.row.push_back(fmt::format("{:+.2e}", value - exact));
        if (k > 0) {
            steps.push_back(h);
            changes.push_back(std::abs(value - last));
            refinement.limit = value + (value - last) / (std::exp2(order) - 1.0);
        }
        last = value;
    }
    refinement.order = order_of(steps, changes);
    refinement.row.push_back(fmt::format("{:+.1e}", refinement.limit - exact));
    refinement.row.push_back(fmt::format("{:.2f}", refinement.order));
    return refinement;
}

// Allowance for the plate's stretch under the forces of its swing, up to 3 rho g L / E.
constexpr double kStretch = 3e-4;

TEST(Pendulum, Bdf2HasTheExactPeriodToSecondOrder)
{
    Table table("pendulum_bdf2",
                {"amplitude", "exact period", "step h", "h", "h/2", "h/4", "h/8", "h/16", "limit", "order"});
    for (const double degrees : {10.0, 90.0, 150.0}) {
        const double amplitude = degrees * std::numbers::pi / 180.0, exact = exact_period(amplitude);
        const double first =
            // At 2 ms the error of a small swing would be less than that of the plate's stretch.
            degrees < 45.0 ? 8e-3 : 2e-3;
        Refinement found =
            refine([&](double h) { return measure_period(amplitude, h) / exact; }, first, 2.0, 1.0);
        EXPECT_GT(found.order, 1.85) << degrees;
        EXPECT_LT(found.order, 2.2) << degrees;
        EXPECT_LT(std::abs(found.limit - 1.0), kStretch) << degrees;
        found.row.insert(found.row.begin(),
                         {fmt::format("{:g} degrees", degrees), fmt::format("{:.6f} s", exact),
                          fmt::format("{:g} ms", 1e3 * first)});
        table.add(found.row);
    }
}

TEST(Pendulum, ImplicitEulerLosesAmplitudeAtFirstOrder)
{
    Table table("pendulum_euler",
                {"amplitude", "1 ms", "1/2 ms", "1/4 ms", "1/8 ms", "1/16 ms", "limit", "order"});
    for (const double degrees : {10.0, 90.0, 150.0}) {
        const double amplitude = degrees * std::numbers::pi / 180.0;
        Refinement found = refine([&](double h) { return measure_loss(amplitude, h); }, 1e-3, 1.0, 0.0);
        EXPECT_NEAR(found.order, 1.0, 0.1) << degrees;
        EXPECT_LT(std::abs(found.limit), 10.0 * kStretch) << degrees;
        found.row.insert(found.row.begin(), fmt::format("{:g} degrees", degrees));
        table.add(found.row);
    }
}

/// Lag of the plate behind the rigid one, degrees, 0.48 s after its release at 90 degrees.
double measure_lag(Integrator integrator, double modulus, double h)
{
    constexpr double kEnd = 0.48;
    ClothRun run = make_plate(0.5 * std::numbers::pi, integrator, modulus);
    run.advance(kEnd, h);
    const auto slope = [](double, const Vec2& at) -> Vec2 {
        return {at[1], -1.5 * kG / kLength * std::sin(at[0])};
    };
    const double exact = integrate_rk4(Vec2(0.5 * std::numbers::pi, 0.0), 0.0, kEnd, 2000, slope)[0];
    return (std::atan2(hem(run).x(), -hem(run).z()) - exact) * 180.0 / std::numbers::pi;
}

TEST(StiffPlate, IsHeldBackByItsLinearisationAndByBdf2FarLess)
{
    // With one linearisation a step, a turning face's apparent stretch (h thetadot)^2 / 2 acts as tension:
    // see docs/measured/validation.md.
    Table table("stiff_plate", {"E", "step", "implicit Euler", "BDF2"});
    for (const double modulus : {1e4, 1e6})
        for (const double h : {8e-3, 4e-3, 1e-3}) {
            const double euler = measure_lag(Integrator::ImplicitEuler, modulus, h);
            const double bdf2 = measure_lag(Integrator::Bdf2, modulus, h);
            table.add({fmt::format("{:g} N/m", modulus), fmt::format("{:g} ms", 1e3 * h),
                       fmt::format("{:.2f}", euler), fmt::format("{:.2f}", bdf2)});
            // A large error of the linearisation makes the step linearise again.
            const bool is_again = modulus > 1e5 && h > 5e-3;
            EXPECT_LT(is_again ? euler : std::abs(bdf2), is_again ? 3.0 : euler / 3.0);
            if (h < 2e-3) {
                EXPECT_LT(std::abs(bdf2), 0.05);
            }
        }
}

}  // namespace
}  // namespace arris
