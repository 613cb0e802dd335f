// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "geometry/contact/obstacle_contact.h"
#include "solver/eol/eol_coordinates.h"
#include "solver/model/pin_targets.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/model/time_integration.h"

namespace arris {

/// One obstacle during one step, and the cloth's way in its frame.
struct ObstacleStep {
    Placement before, begin, end;  ///< of its frame: a step ago, at the step's start and at its end
    ClothMotion motion;            ///< ends where the cloth would be if nothing were in its way
    std::vector<Vec3> reference;   ///< where it would be if it slid along what is
};

/// `element` of a contact that is none with the obstacle but keeps one side of cloth folded over a wire from
/// passing to the other's (fold_contacts.h).
inline constexpr int kFoldElement = -2;

inline bool is_fold(const ActiveContact& contact)
{
    return contact.kind == ContactKind::Vertex && contact.element == kFoldElement;
}

/// A contact in the world, and which constraint of the velocity solve it is.
struct Contact {
    ObstacleContact in_frame;
    int obstacle;  ///< index in the scene
    Vec3 normal;   ///< at the step's end
    double gap;    ///< distance that q~ is past what it must keep at the step's end, m; negative inside
    bool was_active;
    bool is_pressing = false;  ///< in the last solve of this step, linearised elsewhere
    bool may_grow = true;      ///< its gap, towards the stand-off; not where it has yielded
    double mitre = 1.0;        ///< its stand-off is this times the thickness
    int eol = -1;              ///< of which EOL coordinates it is the bound on the first
    int bound = -1;            ///< coordinate of the velocity solve, 3 a vertex
    int row = -1;              ///< or row

    bool is_vertex() const { return in_frame.kind == ContactKind::Vertex; }
    bool is_fold() const { return is_vertex() && in_frame.element == kFoldElement; }
};

/// Where the scene's obstacles are during the step that ends at `end` (s), and how the cloth would move past
/// them: with the velocity it has, pins where they will be.
std::vector<ObstacleStep> move_obstacles(const Scene& scene, const State& state,
                                         const std::vector<MeshEdge>& edges, const Prediction& prediction,
                                         const std::vector<PinTarget>& held, double end);

/// What the cloth may touch in the step: vertices, edges and faces against each obstacle, and the pairs that
/// pressed at the end of the last step.
std::vector<Contact> find_contacts(const Scene& scene, const State& state, const Prediction& prediction,
                                   std::vector<ObstacleStep>& steps);

/// Whether the contact is one of `state.active`: of an edge or face with the same element of the obstacle, of
/// a vertex with about the same normal, as a vertex slides from face to face.
bool was_active(const State& state, const Contact& contact);

/// How far, m, the obstacle goes along the contact's normal in the step, where the cloth is.
double way_along(const ObstacleStep& step, const Contact& contact);

/// The contact in the world, its gap that of the prediction.
Contact place_contact(const ObstacleContact& contact, int obstacle, const ObstacleStep& step,
                      const Prediction& prediction);

/// What `share_room` did: whether a contact keeps less now, and a vertex (index) that has no room at all.
struct SharedRoom {
    bool is_changed = false;
    std::optional<int> overconstrained;
};

/// Between two obstacles, or two faces of one, with room for less than both stand-offs, a vertex's contacts
/// share the room there is at the step's end. There is none between two planes that face each other exactly;
/// from between any others it could slip out sideways.
SharedRoom share_room(const std::vector<ObstacleStep>& steps, const Prediction& prediction,
                      std::vector<Contact>& contacts);

/// Lets a contact whose row could not be met with the others yield: it keeps no more than the gap it has,
/// which riding on the obstacle keeps, or, where it kept only that, half of it; of a fold nothing. False
/// where it has nothing to yield.
bool yield_stand_off(const std::vector<ObstacleStep>& steps, const Prediction& prediction, double thickness,
                     Contact& contact);

/// Flattens the history in `prediction` along the normals of those from `first` on, relative to the obstacle,
/// where the extrapolated position would pass what the contact must keep and the cloth's velocity does not
/// bring it out, or where it was active; and updates all gaps. Otherwise what a vertex brought into an impact
/// would be extrapolated through it, and it would rebound. True where anything was flattened.
bool flatten_history(const Scene& scene, const State& state, const std::vector<ObstacleStep>& steps,
                     const std::vector<EolCoordinates>& eol, std::size_t first,
                     std::vector<Contact>& contacts, Prediction& prediction);

/// Those of `contacts` that press, for `State::active`; `multiplier` has one entry a contact (N s).
std::vector<ActiveContact> active_contacts(const State& state, const std::vector<Contact>& contacts,
                                           const std::vector<double>& multiplier);

}  // namespace arris
