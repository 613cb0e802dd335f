// SPDX-License-Identifier: GPL-3.0-or-later
// Decides which contacts with sharp features are EOL vertices: whether a site gets one
// (EolAdmission::find_refusal), whether an inserted vertex keeps being one (refuse_inserted), and whether one
// of the state stays (find_releases). Thresholds to enter and to stay stand side by side in
// model/eol_limits.h. The census (feature_census.h) only reports the causes that are found here.
//
// Entering: the cloth must lie over the feature, and go on doing so for a few steps, away from the cloth's
// borders, from other traces, and from folds that have left.
//
// Staying: while material flows over a fold an EOL vertex has two velocities, one a side; an ordinary vertex
// has their mean, and the cloth loses energy. Where a fold was released the cloth bends beside the feature,
// so that inserting a vertex again strains it. So an EOL vertex that no longer presses is not released for
// that alone: cloth that lifts off an edge keeps its fold until it is flat there or a cell from the edge. But
// a fold off its feature is led in a plane that nothing is in: where the cloth that comes to it fast comes
// another way, it is released before.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/cloth/mesh_target.h"
#include "solver/eol/cloth_stars.h"
#include "solver/eol/eol_coordinates.h"
#include "solver/model/eol_limits.h"
#include "solver/model/row_cause.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/sites/feature_sites.h"
#include "solver/sites/trace_mesh.h"

namespace arris {

/// Decides which sites of a state may get an EOL vertex on its mesh under surgery. All arguments outlive it.
class EolAdmission {
  public:
    /// `soon` (s) is for how long material that flows must find room.
    EolAdmission(const Scene& scene, const State& state, const ClothStars& stars, const TraceMesh& trace,
                 double soon)
        : scene_(scene), state_(state), stars_(stars), trace_(trace), soon_(soon)
    {
    }

    /// Why a site gets no vertex, whatever the mesh has there; nothing if it may get one. `v` is the index of
    /// the site's vertex, `flow` (m/s) the material's flow over the feature there.
    std::optional<RowCause> find_refusal(const FeatureSite& site, int v, const Vec2& flow) const;

    /// Why a vertex that has just been inserted is not EOL after all; nothing if it is. Surgery at one site
    /// bends the surface a little at the next, and off its plane or side the vertex could not come back.
    std::optional<RowCause> refuse_inserted(const EolVertex& eol) const;

    /// Whether a vertex is where its coordinates can hold it: in the plane of its convex edge, in which alone
    /// it may move, or, of a fold that has left the edge, beyond both the edge's faces.
    bool is_in_plane(const EolVertex& eol) const;

  private:
    /// Whether a vertex on a wire or border is on the side to which that has pressed. Its outward direction
    /// is where the vertex is, and would be against what presses beside it.
    bool is_on_side(const EolVertex& eol) const;
    std::optional<RowCause> find_border_cause(const FeatureSite& site, int v, const Vec2& flow) const;
    bool is_beside_other(const FeatureSite& site) const;
    std::optional<RowCause> find_fold_cause(const FeatureSite& site) const;
    std::optional<double> find_free_fold(const FeatureSite& site) const;
    bool has_vertex_on(const FeatureSite& site) const;
    bool has_left(const EolVertex& eol) const;
    Vec3 world_at(const FeatureSite& site) const;

    const Scene& scene_;
    const State& state_;
    const ClothStars& stars_;
    const TraceMesh& trace_;
    double soon_;
};

/// Whether an EOL vertex stays.
enum class EolRetention {
    None,   ///< released
    Loose,  ///< released, unless it lies on its feature between two that stay
    Firm    ///< stays
};

/// The retention of EOL vertex `entry`, at `place` in its obstacle's frame. Firm where it presses or has
/// pressed within kIdleSteps; none farther than kFlyingCells from its feature (kAstrayCells where it is led
/// astray), nor off a corner that presses on a face now; firm where the cloth is folded, by more than 6
/// degrees.
EolRetention decide_retention(const Scene& scene, const State& state, const ClothStars& stars, int entry,
                              const EolCoordinates& at, const Vec3& place);

/// Makes loose ones firm that lie along a trace between firm ones: a trace with a hole holds the cloth there.
/// One retention an entry of `state.eol`.
void retain_between(const Scene& scene, const State& state, const ClothStars& stars,
                    std::vector<EolRetention>& retained);

/// An EOL vertex that becomes an ordinary one, and why.
struct EolRelease {
    VertexId vertex;
    RowCause cause;
};

/// The EOL vertices that are released, in the order of `state.eol`: those without retention, at an end of
/// their feature, too near to the cloth's border, or without coordinates.
std::vector<EolRelease> find_releases(const Scene& scene, const State& state, const ClothStars& stars);

}  // namespace arris
