// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/deform/slit_samples.h"

#include <algorithm>
#include <deque>

#include "geometry/obstacle_input/deform/slit.h"

namespace arris {
namespace {

constexpr std::ptrdiff_t kSide = 2;  // samples before and after

using Values = std::vector<double>;  // of the points

/// What each sample needs by itself, of those around the present one.
class Needs {
  public:
    Needs(const PoseSource& poses, const SlitFinder& finder)
        : poses_(poses), finder_(finder), last_(static_cast<std::ptrdiff_t>(poses.times().size()) - 1)
    {
    }

    /// The greatest need from two samples before to two after `middle`. Calls with middles that ascend.
    Values greatest_around(std::ptrdiff_t middle)
    {
        Values most(poses_.point_count(), 0.0);
        for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(0, middle - kSide);
             k <= std::min(last_, middle + kSide); ++k) {
            const Values& one = at(k);
            for (std::size_t p = 0; p < most.size(); ++p) most[p] = std::max(most[p], one[p]);
        }
        while (first_ < middle - kSide) {
            known_.pop_front();
            ++first_;
        }
        return most;
    }

  private:
    const Values& at(std::ptrdiff_t sample)
    {
        while (first_ + static_cast<std::ptrdiff_t>(known_.size()) <= sample) {
            std::vector<Vec3> points;
            poses_.read(static_cast<std::size_t>(first_) + known_.size(), points);
            known_.push_back(finder_.find_retreat(points));
        }
        return known_[static_cast<std::size_t>(sample - first_)];
    }

    const PoseSource& poses_;
    const SlitFinder& finder_;
    std::ptrdiff_t last_, first_ = 0;
    std::deque<Values> known_;
};

}  // namespace

SlitSurvey make_slit(const PoseSource& poses, const ObstacleMesh& mesh, double width,
                     const std::function<void(const std::vector<Vec3>&)>& take)
{
    const SlitFinder finder(mesh, width);
    Needs needs(poses, finder);
    const auto count = static_cast<std::ptrdiff_t>(poses.times().size());
    std::deque<Values> around;  // of the middles from two before to two after the sample
    std::ptrdiff_t next = 0;    // middle
    SlitSurvey survey;
    std::vector<Vec3> points;
    for (std::ptrdiff_t k = 0; k < count; ++k) {
        for (; next <= std::min(count - 1, k + kSide); ++next) around.push_back(needs.greatest_around(next));
        while (next - static_cast<std::ptrdiff_t>(around.size()) < k - kSide) around.pop_front();
        Values retreat(poses.point_count(), 0.0);
        for (const Values& one : around)
            for (std::size_t p = 0; p < retreat.size(); ++p)
                retreat[p] += one[p] / static_cast<double>(around.size());
        const double greatest = *std::max_element(retreat.begin(), retreat.end());
        if (greatest > 0.0) ++survey.samples;
        if (greatest > survey.greatest_retreat) {
            survey.greatest_retreat = greatest;
            survey.greatest_at = static_cast<std::size_t>(k);
        }
        poses.read(static_cast<std::size_t>(k), points);
        take(finder.apply(points, retreat));
    }
    return survey;
}

}  // namespace arris
