// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/timeline.h"
#include "app/scene/parts/merge_events.h"

#include <gtest/gtest.h>

#include <cmath>

namespace arris {
namespace {

RunConfig make_config(double duration, double step, double frames_per_second)
{
    RunConfig config;
    config.duration = duration;
    config.settings.step = step;
    config.output.frames_per_second = frames_per_second;
    return config;
}

std::vector<double> step_ends(const Timeline& timeline)
{
    std::vector<double> ends;
    for (TimelinePosition at; !timeline.is_over(at); at = timeline.next(at)) {
        ends.push_back(timeline.next_end(at));
        if (ends.size() > 1000000) break;
    }
    return ends;
}

TEST(Timeline, WithoutFramesStepsAreExactlyTheStep)
{
    const std::vector<double> ends = step_ends(Timeline(make_config(1.0, 0.005, 0.0)));
    ASSERT_EQ(ends.size(), 200u);
    for (int k = 0; k < 200; ++k) EXPECT_DOUBLE_EQ(ends[k], (k + 1) / 200.0);
    EXPECT_EQ(ends.back(), 1.0);
}

TEST(Timeline, StepsEndExactlyOnFramesJumpsAndTheDuration)
{
    for (const double fps : {24.0, 25.0, 29.97, 30.0, 1000.0, 0.3}) {
        for (const double step : {0.005, 0.0031, 0.1, 2.0}) {
            RunConfig config = make_config(1.37, step, fps);
            Pin pin;
            pin.motion.velocity = Vec3(1, 0, 0);
            pin.motion.start = 0.31;
            pin.motion.stop = 1.0 / 3.0;
            pin.release = 0.5;
            config.scene.pins = {pin};
            Pull pull;
            pull.start = 0.0;
            pull.stop = 9.0;  // after the end
            config.scene.pulls = {pull};
            const Timeline timeline(config);
            const std::vector<double> ends = step_ends(timeline);

            double begin = 0.0;
            std::int64_t frames = 1;  // time 0
            EXPECT_EQ(timeline.frame_at(0.0), 0);
            for (const double end : ends) {
                ASSERT_GT(end, begin);
                EXPECT_LE(end - begin, step * (1 + 1e-8));
                const std::int64_t frame = timeline.frame_at(end);
                if (frame >= 0) {
                    EXPECT_EQ(frame, frames++);
                }
                begin = end;
            }
            EXPECT_EQ(ends.back(), 1.37);
            EXPECT_EQ(frames, timeline.frame_count());
            for (const double event : {0.31, 1.0 / 3.0, 0.5}) {
                EXPECT_TRUE(std::find(ends.begin(), ends.end(), event) != ends.end()) << event;
                EXPECT_TRUE(timeline.jumps_at(event));
            }
            for (std::int64_t k = 1; k < frames; ++k)
                EXPECT_TRUE(std::find(ends.begin(), ends.end(), static_cast<double>(k) / fps) != ends.end())
                    << k;
        }
    }
}

TEST(Timeline, AFrameThatIsTheDurationIsTaken)
{
    for (const double duration : {0.1, 0.7, 1.0, 2.5, 3.3}) {
        const Timeline timeline(make_config(duration, 0.005, 10.0));
        EXPECT_EQ(timeline.frame_at(duration), std::lround(10.0 * duration));
        EXPECT_EQ(timeline.frame_count(), std::lround(10.0 * duration) + 1);
    }
}

TEST(Timeline, ARoundedUpQuotientDoesNotAddAStep)
{
    // 0.3 / 0.1 is 2.9999999999999996 and 0.7 / 0.1 is 6.999999999999999: three and seven steps.
    EXPECT_EQ(step_ends(Timeline(make_config(0.3, 0.1, 0.0))).size(), 3u);
    EXPECT_EQ(step_ends(Timeline(make_config(0.7, 0.1, 0.0))).size(), 7u);
    EXPECT_EQ(step_ends(Timeline(make_config(0.6, 0.2, 0.0))).size(), 3u);
}

TEST(Timeline, TimesThatAllButMeetAreOne)
{
    // 0.1 + 0.2 and a script's t += 1 / 24 are an ulp or two off the frames they mean.
    RunConfig config = make_config(0.1 + 0.2 + 0.7, 0.005, 10.0);
    Pin pin;
    pin.release = 0.1 + 0.2;
    Pin keyed;
    double t = 0.0;
    for (int k = 0; k < 10; ++k, t += 1.0 / 10.0)
        keyed.motion.keyframes.push_back({t, Vec3(k, 0, 0), Eigen::Quaterniond::Identity()});
    config.scene.pins = {pin, keyed};
    Pull pull;
    pull.start = 0.123;
    pull.stop = 0.123 * (1 + 4e-16) + 0.5 - 0.5;
    config.scene.pulls = {pull};
    merge_events(config);
    EXPECT_EQ(config.duration, 1.0);
    EXPECT_EQ(config.scene.pins[0].release, 3.0 / 10.0);
    EXPECT_EQ(config.scene.pulls[0].stop, config.scene.pulls[0].start);
    double begin = 0.0;
    for (const double end : step_ends(Timeline(config))) {
        EXPECT_GT(end - begin, 1e-3);
        begin = end;
    }
    EXPECT_EQ(begin, 1.0);
}

}  // namespace
}  // namespace arris
