// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/sewing/closing.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "solver/sewing/welding.h"

namespace arris {
namespace {

double distance(const State& state, const SeamPair& pair)
{
    return (state.mesh.world[state.index_of(pair.vertex_ids[0])] -
            state.mesh.world[state.index_of(pair.vertex_ids[1])])
        .norm();
}

const OpenSeam& seam_of(const Scene& scene, const SeamPair& pair)
{
    return scene.sewing->seams[static_cast<std::size_t>(pair.seam)];
}

/// Seams of up to the present order that are open; others' turn has not come.
bool is_waiting(const Scene& scene, const State& state)
{
    const std::vector<SeamGap> open = find_open_seams(scene, state);
    return std::any_of(open.begin(), open.end(), [&](const SeamGap& gap) {
        return scene.sewing->seams[static_cast<std::size_t>(gap.seam)].order <= state.closing.order;
    });
}

/// Lets the seams of the least order above the present one close. False where there is none.
bool begin_next(const Scene& scene, State& state)
{
    bool is_any = false;
    std::int32_t next = std::numeric_limits<std::int32_t>::max();
    for (const SeamPair& pair : state.seam_pairs)
        if (const std::int32_t order = seam_of(scene, pair).order; order > state.closing.order) {
            next = std::min(next, order);
            is_any = true;
        }
    if (!is_any) return false;
    double widest = 0.0;
    for (SeamPair& pair : state.seam_pairs) {
        if (seam_of(scene, pair).order != next) continue;
        pair.gap = distance(state, pair);
        widest = std::max(widest, pair.gap);
    }
    state.closing = {next, state.time, state.time + closing_time(widest, scene.sewing->speed)};
    return true;
}

}  // namespace

double closing_time(double gap, double speed)
{
    return 1.5 * gap / speed;  // the cubic of `length_at` is steepest in its middle
}

double closed_gap(const Scene& scene)
{
    constexpr double kClosed = 0.5;
    return kClosed * (scene.self_contact ? scene.self_contact->thickness : scene.materials.thickness());
}

std::vector<SeamGap> find_open_seams(const Scene& scene, const State& state)
{
    const double closed = closed_gap(scene);
    std::map<int, SeamGap> open;
    for (const SeamPair& pair : state.seam_pairs) {
        const double gap = distance(state, pair);
        if (seam_of(scene, pair).is_tie && gap <= closed) continue;
        SeamGap& seam = open.try_emplace(pair.seam, SeamGap{pair.seam}).first->second;
        seam.pairs += gap > closed;
        if (gap < seam.widest) continue;
        seam.widest = gap;
        seam.vertex = state.index_of(pair.vertex_ids[0]);
    }
    std::vector<SeamGap> list;
    for (const auto& [seam, gap] : open) list.push_back(gap);
    return list;
}

void slow_down(double elapsed, State& state)
{
    constexpr double kDrag = 10.0;  // 1/s: 5 cm of way at the greatest speed of seams by default
    const double left = std::exp(-kDrag * elapsed);
    for (Vec3& velocity : state.velocity) velocity *= left;
}

void advance_sewing(const Scene& scene, State& state)
{
    if (!scene.sewing || std::isfinite(state.sewn_at)) return;
    if (state.time >= state.closing.end)
        for (const SeamGap& gap : find_open_seams(scene, state))
            if (gap.pairs == 0) weld(scene, gap.seam, state);
    while (state.time >= state.closing.end && !is_waiting(scene, state))
        if (!begin_next(scene, state)) {
            state.sewn_at = state.time;
            return;
        }
}

}  // namespace arris
