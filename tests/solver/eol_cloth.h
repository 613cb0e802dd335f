// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/eol/eol_coordinates.h"
#include "solver/mesh_change/conform.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris::testing {

ClothStars stars_of(const ClothMesh& mesh);

/// A ridge along y whose tip is the segment x = z = 0, `half_length` to either side of y = 0, with
/// `tip_degrees` between its flanks.
MovingObstacle make_ridge(double tip_degrees, double half_length = 0.5);

/// The feature that is the ridge's tip, and the corner at which it ends at y > 0.
int tip_of(const Obstacle& ridge);
int end_of(const Obstacle& ridge);

/// A square of cloth 0.4 m wide over the ridge x = z = 0.
struct Drape {
    int cells = 8;
    double turn_degrees = 0.0;   ///< angle between material and ridge
    double fold_degrees = 90.0;  ///< angle between the two sides; 180 is flat
    double stretch = 1.0;        ///< along y
};

/// The cloth's middle is on the ridge; its sides hang down to x < 0 and x > 0.
ClothMesh make_draped(const Drape& shape);

/// A scene and state with the given obstacle and cloth, a material and a mesh target, without gravity.
struct EolCloth {
    Scene scene;
    State state;

    EolCloth(MovingObstacle obstacle, ClothMesh mesh);
    int vertex_at(double u, double v) const;  ///< nearest to the material point (u, v)
    /// Makes a vertex EOL and returns the index of its entry.
    int add_eol(int vertex, bool is_corner, int feature);
    ClothStars stars() const;
    EolPlacing place(int vertex, const Placement& end = {}) const;
};

inline constexpr double kThickness = 1e-3;       // m, thickness of an EolCloth
inline constexpr double kLyingCell = 0.4 / 7.0;  // m: for this cell size no mesh line is above the ridge

/// Flat cloth one thickness above the ridge, turned by `turn` (degrees) and moved by `shift` (m) along x.
EolCloth lying(double turn, double shift = 0.0, double half_length = 0.5);

/// Adds pressing rows where the cloth's edges cross the ridge's tip, as after a step.
void press_edges(EolCloth& cloth);

/// Flat cloth `height` thicknesses above a disk of 16 sides and radius 0.1 m; no vertex is above the rim.
EolCloth make_disk_cloth(double height);

/// Lets every face of the cloth press on a point of the obstacle's mesh.
void press_faces_on(int point, State& state);

inline constexpr double kStep = 0.005;  // s, the step of conform_cloth and take

/// Conforms the cloth's mesh to its features.
ConformOutcome conform_cloth(const EolCloth& cloth, const FailedFlow& failed = {},
                             const ConformLimits& limits = {});

/// Conforms the mesh and carries the state over to it. Fails the test if the mesh needs no change.
ConformedMesh take(EolCloth& cloth);

std::vector<MeshEdge> edges_of(const State& state);

/// Kinetic energy (J) and linear momentum (kg m/s) of the whole cloth's material.
double kinetic_energy_of(const Scene& scene, const State& state);
Vec3 momentum_of(const Scene& scene, const State& state);

/// Stretch and bending energy, J.
double elastic_energy_of(const Scene& scene, const ClothMesh& mesh);

}  // namespace arris::testing
