// SPDX-License-Identifier: GPL-3.0-or-later
// Decides which contacts with sharp features are EOL vertices. `EolAdmission::find_refusal` decides whether a
// site gets one, `refuse_inserted` whether an inserted vertex becomes one, and `find_releases` which ones of
// the state are released. Thresholds are in model/eol_limits.h; where one to stay belongs to one to enter, it
// follows by kStayRatio (model/hysteresis.h); numbers that one question alone asks are beside that question
// in eol_decision.cpp. The census (feature_census.h) only reports the causes that are found here.
//
// An admitted site may still stay a constraint for three reasons: the mesh has no place
// (mesh_change/site_insertion), a vertex there has no coordinates (eol/eol_coordinates), or attempts at the
// step failed (retry_policy).
//
// Entering: the cloth must lie over the feature and remain there for a few steps. Borders of the cloth, other
// traces and free folds must not be near.
//
// Staying: an EOL vertex under flow has two velocities, one for each side of the fold. An ordinary vertex has
// only their mean, so a release loses kinetic energy. A released fold also bends beside the feature, so that
// a new insertion strains the cloth. Therefore an EOL vertex stays after it has ceased to press, until the
// cloth is flat there or a cell from the edge. A fold off its feature moves only in the plane of its
// coordinates. Where fast cloth comes to it from another direction, the fold is released earlier.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/cloth/mesh_target.h"
#include "solver/eol/cloth_stars.h"
#include "solver/eol/eol_coordinates.h"
#include "solver/model/constraint_cause.h"
#include "solver/model/eol_limits.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/sites/feature_sites.h"
#include "solver/sites/trace_mesh.h"

namespace arris {

/// Decides which sites of a state may get an EOL vertex on the mesh under surgery. All arguments outlive it.
class EolAdmission {
  public:
    /// `soon` (s): time for which flowing material must find room.
    EolAdmission(const Scene& scene, const State& state, const ClothStars& stars, const TraceMesh& trace,
                 double soon)
        : scene_(scene),
          state_(state),
          stars_(stars),
          trace_(trace),
          soon_(soon),
          material_tolerance_(kMaterialTolerance * material_size(state.mesh.material))
    {
    }

    /// Cause for which a site gets no EOL vertex, whatever the mesh there; nothing if it may get one. `v` is
    /// the index of the site's vertex, `flow` (m/s) the flow of material over the feature there.
    std::optional<ConstraintCause> find_refusal(const FeatureSite& site, int v, const Vec2& flow) const;

    /// Cause for which a vertex just inserted does not become EOL; nothing if it does. Surgery at one site
    /// bends the surface slightly at the next. A vertex inserted off its plane or side could not return
    /// there. A fold around a wire may come down to the wire later.
    std::optional<ConstraintCause> refuse_inserted(const EolVertex& eol, const FeatureSite& site) const;

    /// Whether a pin holds vertices at this material point in the next step: a pinned vertex is never EOL.
    bool is_pinned(const Vec2& material) const;

    /// Whether the coordinates of an EOL vertex can hold it at its place. On a convex edge this is the plane
    /// in which alone it moves; for a free fold, anywhere beyond both faces of the edge. On other edges it is
    /// within kOnFeature.
    bool is_in_plane(const EolVertex& eol) const;

  private:
    /// Whether a vertex on a wire or border is on the side to which the feature has pressed. Outward points
    /// from the feature to the vertex; on the other side it would oppose the contacts beside it.
    bool is_on_side(const EolVertex& eol) const;
    std::optional<ConstraintCause> find_border_cause(const FeatureSite& site, int v, const Vec2& flow) const;
    bool is_unresolved(const FeatureSite& site) const;
    bool is_beside_other(const FeatureSite& site) const;
    bool gathers(const FeatureSite& site, int v) const;
    std::optional<ConstraintCause> find_fold_cause(const FeatureSite& site) const;
    std::optional<double> find_free_fold(const FeatureSite& site) const;
    bool has_vertex_on(const FeatureSite& site) const;
    bool has_left(const EolVertex& eol) const;
    Vec3 world_at(const FeatureSite& site) const;

    const Scene& scene_;
    const State& state_;
    const ClothStars& stars_;
    const TraceMesh& trace_;
    double soon_;
    double material_tolerance_;  ///< m, of boxes of pins
};

/// Whether an EOL vertex stays.
enum class EolRetention {
    None,   ///< released
    Loose,  ///< released, unless it lies along its trace between two that stay
    Firm    ///< stays
};

/// Retention of EOL vertex `entry`, which has coordinates `at` and lies at `place` in its obstacle's frame.
/// The first rule that applies decides. Firm: it has pressed within kIdleSteps. None: it is farther from its
/// feature than kFlyingCells (kAstrayCells where its fold moves otherwise than the arriving cloth). None: it
/// is off a corner that now presses on a face. Firm: the cloth is folded there by more than 6 degrees.
/// Otherwise Loose on its feature, None off it.
EolRetention decide_retention(const Scene& scene, const State& state, const ClothStars& stars, int entry,
                              const EolCoordinates& at, const Vec3& place);

/// Makes Loose vertices along a trace between Firm ones Firm, as a trace with a hole holds the cloth there.
/// Other Loose vertices become None. `retained` has one entry an entry of `state.eol`.
void retain_between(const Scene& scene, const State& state, const ClothStars& stars,
                    std::vector<EolRetention>& retained);

/// An EOL vertex that becomes an ordinary one, and the cause.
struct EolRelease {
    VertexId vertex;
    ConstraintCause cause;
};

/// EOL vertices to release, in the order of `state.eol`. These have no retention or no coordinates, have
/// passed an end of their feature (past a wire's, a fold may lead on), or are too near to the cloth's border.
std::vector<EolRelease> find_releases(const Scene& scene, const State& state, const ClothStars& stars);

}  // namespace arris
