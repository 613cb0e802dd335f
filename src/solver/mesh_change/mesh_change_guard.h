// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/surgery/cloth_surgery.h"
#include "geometry/surgery/surgery_clearance.h"
#include "physics/elements/term.h"
#include "solver/mesh_change/patch_relaxation.h"
#include "solver/mesh_change/relaxation_memo.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// Limits on the strain of surgery.
enum class StrainLimit {
    GivesWay,  ///< only strain that would remain after the cloth around gave way counts
    AsMade     ///< all strain counts
};

/// Guards mesh surgery: refuses operations that would pass through an obstacle or strain the cloth. The sum
/// of stretch, bending and gravity energy may not rise beyond a small allowance. Terms and creases are the
/// step's.
class MeshChangeGuard {
  public:
    /// At the vertices `careful_at` (ascending) no operation may rely on cloth that gives way. `relaxations`
    /// belongs to the scene.
    MeshChangeGuard(const Scene& scene, const State& state, StrainLimit limit,
                    std::vector<VertexId> careful_at, RelaxationMemo& relaxations);

    /// Sets the mesh under surgery, whose patches may give way.
    void watch(const ClothSurgery& surgery) { surgery_ = &surgery; }
    bool allows(const SurgeryEvent& event);

    /// Vertices, ascending, of the faces replaced by operations that rely on cloth giving way: all such
    /// allowed operations, whether or not they were made.
    std::vector<VertexId> relies_at() const;

    /// Clearing ahead of a sliding vertex may strain more: otherwise its trace is released.
    void set_clearing(bool is_clearing) { is_clearing_ = is_clearing; }

  private:
    /// Whether an operation raises the cloth's energy beyond the allowance, and the cloth around may or can
    /// not give way to its strain.
    bool strains(const SurgeryEvent& event);
    bool can_give_way(const SurgeryEvent& event, double rise);
    /// Vertices around an operation, and the faces between them that the operation does not replace.
    struct Neighbourhood {
        std::vector<VertexId> near;     ///< ascending
        std::vector<VertexRing> rings;  ///< by entry of `near`
        std::vector<PatchFace> kept;    ///< ascending; each begins with its least vertex
    };
    Neighbourhood look_around(const SurgeryEvent& event) const;
    void add_kept_faces(const SurgeryEvent& event, Neighbourhood& around) const;
    /// The faces that the operation makes, and its surroundings.
    LoosePatch make_patch(const SurgeryEvent& event) const;
    /// Whether a vertex may move: an unchanged free vertex whose whole ring is in `near`.
    bool is_loose(VertexId v, const VertexRing& ring, const std::vector<VertexId>& near,
                  const SurgeryEvent& event) const;
    double allowance(const SurgeryEvent& event, double elastic_energy) const;

    const Scene& scene_;
    const State& state_;
    Terms terms_;                        ///< terms that have an energy
    std::vector<double> crease_widths_;  ///< m, of each piece
    StrainLimit limit_;
    std::vector<VertexId> careful_at_;
    bool is_clearing_ = false;
    const ClothSurgery* surgery_ = nullptr;
    RelaxationMemo& relaxations_;
    std::vector<VertexId> relies_at_;  ///< unsorted, with duplicates
};

}  // namespace arris
