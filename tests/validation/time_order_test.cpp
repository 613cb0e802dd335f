// SPDX-License-Identifier: GPL-3.0-or-later
// Order of convergence in time, on a fixed mesh. The reference is the closed form if there is one, otherwise
// Richardson's limit of the finest steps.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "cloth_run.h"
#include "ode.h"
#include "physics/forces/inertia.h"
#include "refinement.h"

namespace arris {
namespace {

struct Band {
    double least, most;
};

Band order_band(Integrator integrator)
{
    return integrator == Integrator::ImplicitEuler ? Band{0.9, 1.1} : Band{1.85, 2.2};
}

const char* name_of(Integrator integrator)
{
    return integrator == Integrator::ImplicitEuler ? "implicit Euler" : "BDF2";
}

/// Steps of about `first`, `second`, `first`, ... seconds that end at `end`.
void advance_alternating(ClothRun& run, double end, double first, double second)
{
    const double start = run.state.time;
    const auto pairs = static_cast<int>(std::lround((end - start) / (first + second)));
    for (int k = 0; k < pairs && !run.failures.any(); ++k) {
        const double begin = start + (end - start) * k / pairs;
        run.advance(begin + first * (end - start) / (pairs * (first + second)) - run.state.time);
        run.advance(start + (end - start) * (k + 1) / pairs - run.state.time);
    }
}

// --- A clamped hinge: two faces share the edge (0, 1); face (0, 1, 2) is held and the other is the flap. ---

constexpr double kFlap = 0.5;       // m, the flap's height
constexpr double kStiffness = 0.4;  // J, of the hinge, V = 2 k sin^2(theta / 2)
constexpr double kFlapStart = 95.0 * std::numbers::pi / 180.0;

constexpr double kDensity = 0.3;     // kg/m^2
constexpr double kModulus = 1000.0;  // N/m

ClothRun make_hinge(Integrator integrator)
{
    ClothMesh mesh;
    mesh.material = {Vec2(0.0, 0.0), Vec2(0.0, 1.0), Vec2(-kFlap, 0.5), Vec2(kFlap, 0.5)};
    mesh.faces = {Face{0, 1, 2}, Face{1, 0, 3}};
    for (const Vec2& X : mesh.material) mesh.world.emplace_back(X.x(), X.y(), 0.0);
    mesh.world[3] = Vec3(kFlap * std::cos(kFlapStart), 0.5, kFlap * std::sin(kFlapStart));
    Scene scene;
    const double weight = 3.0 * 1.0 / kFlap;  // 3 |e|^2 / A
    scene.materials[0] = {kDensity, kModulus, 0.0, 2.0 * kStiffness / weight, 0.0, 1e-3};
    scene.pins.push_back({{Vec2(-kFlap, 0.0), Vec2(0.0, 1.0)}, {}, {true, true, true}});
    ClothRun run(scene, mesh);
    run.settings.integrator = integrator;
    return run;
}

double flap_angle(const ClothRun& run)
{
    return std::atan2(run.state.mesh.world[3].z(), run.state.mesh.world[3].x());
}

/// theta at `end`. Only the third corner moves, with mass m = rho A / 6, in the plane v = 1/2. At radius r
/// and angle theta, V = 2 k sin^2(theta / 2) + A E / 2 (r / l - 1)^2; the two equations of motion are solved
/// here.
double exact_flap_angle(double end)
{
    const double area = 0.5 * kFlap, mass = kDensity * area / 6.0;
    const auto slope = [&](double, const Eigen::Vector4d& at) -> Eigen::Vector4d {
        const Vec2 x = at.head<2>();
        const double r = x.norm(), radial = -area * kModulus / kFlap * (r / kFlap - 1.0);
        const double tangential = -kStiffness * x.y() / (r * r);  // -k sin(theta) / r
        const Vec2 outward = x / r;
        const Vec2 force = radial * outward + tangential * Vec2(-outward.y(), outward.x());
        return (Eigen::Vector4d() << at.tail<2>(), force / mass).finished();
    };
    const Eigen::Vector4d start(kFlap * std::cos(kFlapStart), kFlap * std::sin(kFlapStart), 0.0, 0.0);
    const Eigen::Vector4d last = integrate_rk4(start, 0.0, end, 20000, slope);
    return std::atan2(last[1], last[0]);
}

using StepPattern = std::function<void(ClothRun&, double end, double h)>;

void equal_steps(ClothRun& run, double end, double h)
{
    run.advance(end, h);
}
void alternating_steps(ClothRun& run, double end, double h)
{
    advance_alternating(run, end, 2.0 * h / 3.0, 4.0 * h / 3.0);
}

struct OrderCase {
    Integrator integrator;
    bool has_alternating_steps;

    friend void PrintTo(const OrderCase& c, std::ostream* out) { *out << name_of(c.integrator); }
    std::string name() const
    {
        return fmt::format("{}{}", integrator == Integrator::Bdf2 ? "bdf2" : "implicit_euler",
                           has_alternating_steps ? "_alternating" : "");
    }
    void advance(ClothRun& run, double end, double h) const
    {
        has_alternating_steps ? alternating_steps(run, end, h) : equal_steps(run, end, h);
    }
};

const std::vector<OrderCase> kOrderCases = {
    {Integrator::ImplicitEuler, false}, {Integrator::Bdf2, false}, {Integrator::Bdf2, true}};

void expect_order(const OrderCase& c, const std::string& what, const std::vector<double>& steps,
                  const std::vector<double>& errors)
{
    Table table(fmt::format("order_{}_{}", what, c.name()), {"step", "error"});
    for (std::size_t k = 0; k < steps.size(); ++k)
        table.add({fmt::format("{:g} ms", 1e3 * steps[k]), fmt::format("{:.3e}", errors[k])});
    const double order = order_of(steps, errors);
    table.add({"order", fmt::format("{:.3f}", order)});
    EXPECT_GT(order, order_band(c.integrator).least);
    EXPECT_LT(order, order_band(c.integrator).most);
}

class TimeOrder : public testing::TestWithParam<OrderCase> {};

TEST_P(TimeOrder, OfAClampedHinge)
{
    const OrderCase& c = GetParam();
    const double end = 0.12;  // s, in which the flap swings through about a right angle
    const double exact = exact_flap_angle(end);
    const std::vector<double> steps = c.integrator == Integrator::Bdf2
                                          ? std::vector{2e-3, 1e-3, 5e-4, 2.5e-4}
                                          : std::vector{5e-4, 2.5e-4, 1.25e-4, 6.25e-5};
    std::vector<double> errors;
    for (const double h : steps) {
        ClothRun run = make_hinge(c.integrator);
        c.advance(run, end, h);
        ASSERT_FALSE(HasFailure());
        errors.push_back(std::abs(flap_angle(run) - exact));
    }
    expect_order(c, "hinge", steps, errors);
}

// --- A strip clamped along one end, released from the horizontal: bending, stretch and large rotations ---

ClothRun make_swinging_strip(Integrator integrator)
{
    Scene scene;
    // The sudden release excites the strip's fastest modes. No step here resolves their phase over 200
    // periods, so they are damped away (a mode of 100 rad/s by 10 % of critical).
    scene.materials[0] = {0.3, 50.0, 0.3, 1e-3, 2e-3, 1e-3};
    scene.gravity = Gravity{};
    scene.pins.push_back({{Vec2(0.0, 0.0), Vec2(0.05, 0.1)}, {}, {true, true, true}});
    ClothRun run(scene, make_sheet(Vec2(0.5, 0.1), {10, 2}, GridPattern::Cross));
    run.settings.integrator = integrator;
    return run;
}

double greatest_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double distance = 0.0;
    for (std::size_t v = 0; v < a.size(); ++v) distance = std::max(distance, (a[v] - b[v]).norm());
    return distance;
}

TEST_P(TimeOrder, OfASwingingStrip)
{
    const OrderCase& c = GetParam();
    const double end = 0.192;  // s
    std::vector<double> steps = {1e-3, 5e-4, 2.5e-4, 1.25e-4};
    if (is_deep()) steps.push_back(6.25e-5);
    // The changes between successive steps converge at the order of the error.
    std::vector<double> changes;
    std::vector<Vec3> last;
    for (std::size_t k = 0; k <= steps.size(); ++k) {
        ClothRun run = make_swinging_strip(c.integrator);
        c.advance(run, end, k < steps.size() ? steps[k] : 0.5 * steps.back());
        ASSERT_FALSE(HasFailure());
        if (k > 0) changes.push_back(greatest_distance(run.state.mesh.world, last));
        last = run.state.mesh.world;
    }
    expect_order(c, "strip", steps, changes);
}

INSTANTIATE_TEST_SUITE_P(All, TimeOrder, testing::ValuesIn(kOrderCases),
                         [](const auto& i) { return i.param.name(); });

}  // namespace
}  // namespace arris
