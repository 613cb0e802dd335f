// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/surgery/cloth_surgery.h"
#include "geometry/surgery/surgery_clearance.h"
#include "physics/term.h"
#include "solver/mesh_change/patch_relaxation.h"
#include "solver/mesh_change/relaxation_memo.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// How much surgery may strain the cloth.
enum class StrainLimit {
    GivesWay,  ///< what would be left of it when the cloth around gave way counts
    AsMade,    ///< all of it
    Forced     ///< as made, but the way of a sliding trace is cleared unless that is seen as a push
};

/// What mesh surgery may do to the cloth of a state: nothing of an obstacle gets through it, and it is hardly
/// strained: the sum of stretch, bending and gravity energy does not rise, with the terms and creases of the
/// step.
class EolGuard {
  public:
    /// At the vertices `careful_at` (ascending) nothing counts on cloth that gives way. `relaxations` is of
    /// the scene.
    EolGuard(const Scene& scene, const State& state, StrainLimit limit, std::vector<VertexId> careful_at,
             RelaxationMemo& relaxations);

    /// The mesh under surgery, whose patches may give way.
    void watch(const ClothSurgery& surgery) { surgery_ = &surgery; }
    bool allows(const SurgeryEvent& event);

    /// Vertices, ascending, of the faces that operations replace for which the cloth around has to give way:
    /// those that were allowed, whether or not they were made.
    std::vector<VertexId> relies_at() const;

    /// What clears the way of a sliding feature may strain more: the alternative is to give the trace up.
    void set_clearing(bool is_clearing) { is_clearing_ = is_clearing; }

  private:
    /// Whether an operation raises the cloth's energy beyond what is allowed, and the cloth around could not
    /// take up what strain it makes, where it may.
    bool strains(const SurgeryEvent& event);
    bool can_give_way(const SurgeryEvent& event, double rise);
    /// Around an operation: vertices, and the faces between them that it does not replace.
    struct Neighbourhood {
        std::vector<VertexId> near;     ///< ascending
        std::vector<VertexRing> rings;  ///< of each
        std::vector<PatchFace> kept;    ///< ascending, from their least vertices
    };
    Neighbourhood look_around(const SurgeryEvent& event) const;
    void add_kept_faces(const SurgeryEvent& event, Neighbourhood& around) const;
    /// What the operation makes, and around it.
    LoosePatch make_patch(const SurgeryEvent& event) const;
    /// Whether a vertex, with its ring, may move: what is around it is near, too.
    bool is_loose(VertexId v, const VertexRing& ring, const std::vector<VertexId>& near,
                  const SurgeryEvent& event) const;
    double allowance(const SurgeryEvent& event, double elastic_energy) const;

    const Scene& scene_;
    const State& state_;
    Terms terms_;          ///< that have an energy
    double crease_width_;  ///< m
    StrainLimit limit_;
    std::vector<VertexId> careful_at_;
    bool is_clearing_ = false;
    const ClothSurgery* surgery_ = nullptr;
    RelaxationMemo& relaxations_;
    std::vector<VertexId> relies_at_;  ///< as they come
};

}  // namespace arris
