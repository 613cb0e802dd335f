// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "physics/elements/cloth_elements.h"
#include "physics/elements/linearization.h"
#include "physics/elements/term.h"

namespace arris {

/// Impulse that holds each EOL vertex to its coordinates, N s, in world axes; one entry per vertex of the
/// mesh, zero for other vertices. It is A v' - b before the reduction, where `u` is the step's solution.
///
/// Its component along the first column of the basis is the impulse of the vertex's own contact. Impulses of
/// other contacts are included. The component across, in which the vertex moves with its feature and the
/// material flows, belongs to no contact. `mesh` and `elements` are those of the step's start. All zero where
/// `at.flow` is absent.
std::vector<Vec3> compute_feature_impulses(const ClothMesh& mesh, const ClothElements& elements,
                                           const Terms& terms, const Linearization& at,
                                           const Eigen::VectorXd& u);

/// An EOL vertex whose cloth has two sides: to the left and to the right of its trace.
struct TraceVertex {
    int vertex;
    Vec2 trace;  ///< direction of the feature in the material
};

/// What the two sides of the cloth at a trace vertex need, left first.
struct TraceSides {
    std::array<Vec3, 2> impulse = {Vec3::Zero(), Vec3::Zero()};  ///< N s; their sum holds the vertex
    std::array<Vec3, 2> normal = {Vec3::Zero(),
                                  Vec3::Zero()};  ///< sum of the faces' normals times twice their areas
    std::array<Vec3, 2> leaving = {Vec3::Zero(),
                                   Vec3::Zero()};  ///< sum of the ways to the faces' middles times area
    Vec3 flux = Vec3::Zero();  ///< N s: resistance of the material that turns (momentum_flux.h)
};

/// The parts of `compute_feature_impulses` that each side of the cloth asks for, one entry per trace vertex.
/// Both sides share a hinge along the trace equally. Loads on single vertices (pulls) are left out. `at.flow`
/// must be present.
std::vector<TraceSides> compute_trace_sides(const std::vector<TraceVertex>& vertices,
                                            const ClothElements& elements, const Terms& terms,
                                            const Linearization& at, const Eigen::VectorXd& u);

}  // namespace arris
