// SPDX-License-Identifier: GPL-3.0-or-later
// Where a feature presses a vertex can do good only if the cloth lies over the feature there, and goes on
// doing so for a few steps: away from the cloth's borders, from other traces, and from folds that have left.
#pragma once

#include <optional>

#include "solver/eol/cloth_stars.h"
#include "solver/model/row_cause.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/sites/feature_sites.h"
#include "solver/sites/trace_mesh.h"

namespace arris {

/// Which sites of a state may have an EOL vertex on its mesh under surgery. All arguments outlive it.
class SiteAdmission {
  public:
    /// `soon` (s) is for how long material that flows must find room.
    SiteAdmission(const Scene& scene, const State& state, const ClothStars& stars, const TraceMesh& trace,
                  double soon)
        : scene_(scene), state_(state), stars_(stars), trace_(trace), soon_(soon)
    {
    }

    /// Why a site gets no vertex, whatever the mesh has there; nothing where it may. `v` is the index of the
    /// site's vertex, `flow` (m/s) the material's over the feature there.
    std::optional<RowCause> find_refusal(const FeatureSite& site, int v, const Vec2& flow) const;

    /// Whether a vertex that has been made is where its coordinates can hold it. Surgery at one site bends
    /// the surface a little differently at the next. Off the plane of a convex edge a vertex would stay off
    /// it, as it may only move in it; and one of a fold that has left the edge is beyond both its faces.
    bool is_in_plane(const EolVertex& eol) const;
    /// Whether one that is to be on a wire or border is on the side to which that has pressed. Its outward
    /// direction is where it is, and would be against what presses beside it.
    bool is_on_side(const EolVertex& eol) const;

  private:
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

}  // namespace arris
