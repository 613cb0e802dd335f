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

/// One obstacle during one step, and the motion of the cloth in its frame.
struct ObstacleStep {
    Placement before, begin, end;  ///< placement of its frame: one step ago, at the step's start and end
    ClothMotion motion;            ///< ends where the cloth would be without obstacles
    std::vector<Vec3> reference;   ///< where the cloth would be if it slid along obstacles in its way
};

/// `element` of a fold contact, which is not with the obstacle: it keeps one side of cloth folded over a wire
/// from passing to the other side (fold_contacts.h).
inline constexpr int kFoldElement = -2;

inline bool is_fold(const ActiveContact& contact)
{
    return contact.kind == ContactKind::Vertex && contact.element == kFoldElement;
}

/// A contact in the world, and its constraint in the velocity solve.
struct Contact {
    ObstacleContact in_frame;
    int obstacle;  ///< index in the scene
    Vec3 normal;   ///< at the step's end
    double gap;    ///< distance of q~ beyond the gap to be kept at the step's end, m; negative inside
    double last_multiplier = 0.0;  ///< N s, of the last step; 0 where it did not press
    ContactFriction last_friction =
        {};                         ///< of the last step, in the world; at EOL vertices see ContactFriction
    ContactFriction friction = {};  ///< likewise, of the last solve; before one, of the last step
    bool is_pressing = false;       ///< in the last solve of this step, at an earlier linearization
    bool may_grow = true;           ///< whether its gap may grow to the stand-off; false where it has yielded
    double mitre = 1.0;             ///< stand-off over thickness
    int eol = -1;                   ///< index of the EOL coordinates whose first one it bounds; else -1
    int bound = -1;                 ///< coordinate of the velocity solve, 3 a vertex; -1 where it is a row
    int row = -1;                   ///< row of the velocity solve, or -1

    bool is_vertex() const { return in_frame.kind == ContactKind::Vertex; }
    bool was_active() const { return last_multiplier > 0.0; }
    bool is_fold() const { return is_vertex() && in_frame.element == kFoldElement; }
};

/// Motion of the obstacles during the step that ends at `end` (s), and of the cloth past them: at its current
/// velocity, with pinned vertices moving to their targets.
std::vector<ObstacleStep> move_obstacles(const Scene& scene, const State& state,
                                         const std::vector<MeshEdge>& edges, const Prediction& prediction,
                                         const std::vector<PinTarget>& held, double end);

/// Contacts possible in the step: vertices, edges and faces against each obstacle, and the pairs that pressed
/// at the end of the last step.
std::vector<Contact> find_contacts(const Scene& scene, const State& state, const Prediction& prediction,
                                   std::vector<ObstacleStep>& steps);

/// q~ of a vertex that has ridden on the obstacle during the last step.
Vec3 ridden_position(const ObstacleStep& step, const State& state, double forward, int vertex);

/// Sets each contact's gap from the prediction.
void update_gaps(const std::vector<ObstacleStep>& steps, const Prediction& prediction,
                 std::vector<Contact>& contacts);

/// Sets the contact's last multiplier and friction from `state.active`, if it pressed. For an edge or face,
/// the obstacle's element must match. For a vertex, which slides from face to face, the normals must be
/// close.
void recall(const State& state, const ObstacleStep& step, Contact& contact);

/// Distance, m, by which the obstacle at the contact moves along the contact's normal in the step.
double way_along(const ObstacleStep& step, const Contact& contact);

/// The contact in the world, with its gap at the prediction.
Contact place_contact(const ObstacleContact& contact, int obstacle, const ObstacleStep& step,
                      const Prediction& prediction);

/// Result of `share_room`: whether a contact keeps less now, and a vertex (index) without any room.
struct SharedRoom {
    bool is_changed = false;
    std::optional<int> overconstrained;
};

/// Lets a vertex's contacts share the room at the step's end, where two obstacles, or two faces of one, leave
/// less than both stand-offs. Only two planes that face each other exactly can leave no room: between others
/// the vertex could slip out sideways.
SharedRoom share_room(const std::vector<ObstacleStep>& steps, const Prediction& prediction,
                      std::vector<Contact>& contacts);

/// Lets a contact yield whose row could not be met together with the others. It keeps its current gap, which
/// riding on the obstacle preserves; if that is not less than it keeps now, half of what it keeps. A fold
/// contact keeps nothing any more. False where nothing is left to yield.
bool yield_stand_off(const std::vector<ObstacleStep>& steps, const Prediction& prediction, double thickness,
                     Contact& contact);

/// Flattens the history in `prediction` along the normals of the contacts from `first` on, relative to the
/// obstacle, and updates all gaps. Applies to contacts that were active. Applies also where the extrapolated
/// position would violate the kept gap and the cloth's velocity does not restore the gap. Otherwise the
/// velocity of a vertex before an impact would be extrapolated through the obstacle, and the vertex would
/// rebound. True where anything was flattened.
bool flatten_history(const Scene& scene, const State& state, const std::vector<ObstacleStep>& steps,
                     const std::vector<EolCoordinates>& eol, std::size_t first,
                     std::vector<Contact>& contacts, Prediction& prediction);

/// Pressing contacts, for `State::active`; `multiplier` has one entry a contact (N s).
std::vector<ActiveContact> active_contacts(const State& state, const std::vector<ObstacleStep>& steps,
                                           const std::vector<Contact>& contacts,
                                           const std::vector<double>& multiplier);

}  // namespace arris
