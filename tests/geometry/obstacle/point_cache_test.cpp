// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/point_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <thread>

#include "tests/geometry/obstacle/memory_poses.h"

namespace arris {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

using Motion = std::function<Vec3(double)>;

std::shared_ptr<MemoryPoses> sampled(const Motion& motion, const std::vector<double>& times)
{
    std::vector<std::vector<Vec3>> samples;
    for (const double t : times) samples.push_back({motion(t), motion(t) + Vec3(1, 2, 3)});
    return std::make_shared<MemoryPoses>(times, samples);
}

std::vector<double> even_times(double apart, int count)
{
    std::vector<double> times;
    for (int k = 0; k < count; ++k) times.push_back(apart * k);
    return times;
}

struct PointState {
    Vec3 place, velocity;
};

PointState state_at(const PointCache& cache, double time)
{
    std::vector<Vec3> points, velocities;
    cache.find(time, points, velocities);
    EXPECT_EQ(points.size(), 2U);
    EXPECT_LT((points[1] - points[0] - Vec3(1, 2, 3)).norm(), 1e-12);
    return {points[0], velocities[0]};
}

/// Greatest error between samples, away from the first and last interval, where the motion is blended into
/// rest.
double greatest_error(const PointCache& cache, const Motion& motion)
{
    const std::vector<double>& times = cache.sample_times();
    double error = 0.0;
    for (std::size_t k = 2; k + 3 < times.size(); ++k)
        for (int part = 0; part < 16; ++part) {
            const double t = times[k] + (times[k + 1] - times[k]) * part / 16.0;
            error = std::max(error, (state_at(cache, t).place - motion(t)).norm());
        }
    return error;
}

Motion swing(double amplitude, double hertz)
{
    return [=](double t) { return Vec3(amplitude * std::sin(2.0 * std::numbers::pi * hertz * t), 0, 0); };
}

TEST(PointCache, CubicErrorsOfASwingAreThoseOfTheTaylorSeries)
{
    // Linear: x'' T^2 / 8. Cubic: central differences err by x''' T^2 / 6 at both samples, which moves a
    // point between them by that times T s (1 - s) (1 - 2 s), at most T / (6 sqrt(3)).
    const double T = 1.0 / 24.0;
    for (const double hertz : {1.0, 2.0}) {
        const double omega = 2.0 * std::numbers::pi * hertz;
        const Motion motion = swing(0.3, hertz);
        const auto source = sampled(motion, even_times(T, 200));
        const double linear = greatest_error({source, PoseInterpolation::Linear}, motion);
        EXPECT_NEAR(linear, 0.3 * omega * omega * T * T / 8.0, 0.05 * linear);
        const double cubic = greatest_error({source, PoseInterpolation::Cubic}, motion);
        const double expected = 0.3 * std::pow(omega * T, 3.0) / (36.0 * std::sqrt(3.0));
        EXPECT_NEAR(cubic, expected, 0.05 * cubic) << hertz;
    }
}

TEST(PointCache, CubicConvergesWithOrderThreeAndLinearWithTwo)
{
    const Motion motion = swing(0.3, 1.0);
    const auto order = [&](PoseInterpolation interpolation) {
        const double coarse =
            greatest_error({sampled(motion, even_times(1.0 / 24, 80)), interpolation}, motion);
        const double fine =
            greatest_error({sampled(motion, even_times(1.0 / 48, 160)), interpolation}, motion);
        return std::log2(coarse / fine);
    };
    EXPECT_NEAR(order(PoseInterpolation::Cubic), 3.0, 0.1);
    EXPECT_NEAR(order(PoseInterpolation::Linear), 2.0, 0.1);
}

TEST(PointCache, UnevenTimesConvergeWithOrderThree)
{
    const Motion motion = swing(0.3, 1.0);
    const auto error = [&](double apart) {
        std::vector<double> times = even_times(apart, static_cast<int>(3.0 / apart));
        for (std::size_t k = 1; k < times.size(); k += 2) times[k] += 0.4 * apart;
        return greatest_error({sampled(motion, times), PoseInterpolation::Cubic}, motion);
    };
    EXPECT_GT(std::log2(error(1.0 / 24) / error(1.0 / 48)), 2.8);
}

TEST(PointCache, AParabolaInUnevenTimesIsExactInside)
{
    const Motion motion = [](double t) { return Vec3(3.0 * t * t - t, t, 1.0 - 2.0 * t * t); };
    const auto source = sampled(motion, {0.0, 0.1, 0.15, 0.4, 0.41, 0.6, 0.7, 0.9});
    EXPECT_LT(greatest_error({source, PoseInterpolation::Cubic}, motion), 1e-13);
}

TEST(PointCache, VelocitiesAreDerivativesOfThePlaces)
{
    const auto source = sampled(swing(0.3, 1.0), {-0.2, 0.0, 0.05, 0.2, 0.3, 0.31});
    for (const PoseInterpolation interpolation : {PoseInterpolation::Cubic, PoseInterpolation::Linear}) {
        const PointCache cache(source, interpolation);
        for (double t = -0.2913; t < 0.4; t += 0.0171) {
            const double h = 1e-6;
            const Vec3 difference = (state_at(cache, t + h).place - state_at(cache, t - h).place) / (2.0 * h);
            EXPECT_LT((state_at(cache, t).velocity - difference).norm(), 1e-6) << t;
        }
    }
}

TEST(PointCache, SamplesAreMetToTheLastBit)
{
    const Motion motion = swing(0.3, 1.0);
    const std::vector<double> times = {-0.1, 0.0, 0.05, 0.2};
    for (const PoseInterpolation interpolation : {PoseInterpolation::Cubic, PoseInterpolation::Linear}) {
        const PointCache cache(sampled(motion, times), interpolation);
        for (const double t : times) EXPECT_EQ(state_at(cache, t).place, motion(t)) << t;
    }
}

TEST(PointCache, CubicHasNoJumpOfVelocityAtTheEndsEither)
{
    const PointCache cache(sampled([](double t) { return Vec3(t, 0, 0); }, {0.0, 0.1, 0.2}),
                           PoseInterpolation::Cubic);
    EXPECT_THAT(cache.jumps(), IsEmpty());
    for (const double t : {0.0, 0.1, 0.2}) {
        const double h = 1e-9;
        EXPECT_LT((state_at(cache, t + h).velocity - state_at(cache, t - h).velocity).norm(), 1e-6) << t;
    }
    for (const double t : {-1.0, 0.0, 0.2, 5.0})
        EXPECT_EQ(state_at(cache, t).velocity, Vec3(Vec3::Zero())) << t;
    EXPECT_EQ(state_at(cache, -1.0).place, Vec3(Vec3::Zero()));
    EXPECT_EQ(state_at(cache, 5.0).place, Vec3(0.2, 0, 0));
}

TEST(PointCache, LinearTakesTheVelocityAfterASample)
{
    const PointCache cache(
        sampled([](double t) { return Vec3(t < 0.15 ? t : 0.1, 0, 0); }, {-0.1, 0.0, 0.1, 0.2}),
        PoseInterpolation::Linear);
    EXPECT_THAT(cache.jumps(), ElementsAre(0.1, 0.2));  // after time 0
    EXPECT_EQ(state_at(cache, -0.2).velocity.x(), 0.0);
    EXPECT_NEAR(state_at(cache, -0.1).velocity.x(), 1.0, 1e-12);
    EXPECT_EQ(state_at(cache, 0.1).velocity.x(), 0.0);
    EXPECT_EQ(state_at(cache, 0.2).velocity.x(), 0.0);
}

TEST(PointCache, ASingleSampleRests)
{
    for (const PoseInterpolation interpolation : {PoseInterpolation::Cubic, PoseInterpolation::Linear}) {
        const PointCache cache(sampled([](double) { return Vec3(1, 0, 0); }, {0.5}), interpolation);
        EXPECT_THAT(cache.jumps(), IsEmpty());
        for (const double t : {0.0, 0.5, 1.0}) {
            EXPECT_EQ(state_at(cache, t).place, Vec3(1, 0, 0));
            EXPECT_EQ(state_at(cache, t).velocity, Vec3(Vec3::Zero()));
        }
    }
}

TEST(PointCache, ReadsEachSampleOnceWhereTimeGoesOn)
{
    const auto source = sampled(swing(0.3, 1.0), even_times(0.1, 30));
    const PointCache cache(source, PoseInterpolation::Cubic);
    for (double t = 0.0; t < 2.8; t += 0.013) {
        state_at(cache, t + 0.013);
        state_at(cache, t);  // a step asks for both of its ends
    }
    EXPECT_EQ(source->reads, 30);
}

TEST(PointCache, ThreadsGetTheAnswersOfOne)
{
    const auto source = sampled(swing(0.3, 1.0), even_times(0.1, 30));
    const PointCache alone(source, PoseInterpolation::Cubic), shared(source, PoseInterpolation::Cubic);
    const auto time = [](int thread, int k) { return 2.9 * ((k * (7 + 4 * thread)) % 200) / 200.0; };
    std::vector<std::vector<Vec3>> found(4);
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([&, i] {
            for (int k = 0; k < 200; ++k) found[i].push_back(state_at(shared, time(i, k)).place);
        });
    for (std::thread& thread : threads) thread.join();
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 200; ++k) EXPECT_EQ(found[i][k], state_at(alone, time(i, k)).place);
}

}  // namespace
}  // namespace arris
