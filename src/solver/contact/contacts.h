// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/contact/obstacle_contact.h"
#include "geometry/self_contact/self_contact.h"
#include "geometry/self_contact/self_surface.h"
#include "physics/elements/cloth_elements.h"
#include "solver/eol/eol_coordinates.h"
#include "solver/model/pin_targets.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/model/time_integration.h"

namespace arris {

/// `element` of a fold contact, which is not with the obstacle: it keeps one side of cloth folded over a wire
/// from passing to the other side (fold_plane_contacts.h).
inline constexpr int kFoldPlaneElement = -2;

inline bool is_fold_plane(const ActiveContact& contact)
{
    return contact.kind == ContactKind::Vertex && contact.element == kFoldPlaneElement;
}

/// A vertex of the cloth that rides on an obstacle that deforms.
struct Ride {
    Vec3 begin;   ///< its place at the step's start, world
    Vec3 before;  ///< where what rides there was one step ago
    Mat3 turn;    ///< how that turns in the step
    Vec3 gained;  ///< m/s, that its velocity has gained in the last step
};

struct ClothPoints;

/// An obstacle during one step, or the cloth itself where it meets itself, and the motion of the cloth in its
/// frame. The frame of the cloth itself is the world, at rest. The frame of an obstacle that deforms is the
/// world, too, but the cloth's motion in it begins where the cloth would end if it rode on the surface.
struct Carrier {
    Placement before, begin, end;  ///< placement of its frame: one step ago, at the step's start and end
    ClothMotion motion;            ///< ends where the cloth would be without contacts
    std::vector<Ride> rides;       ///< of each vertex on an obstacle that deforms; else none
    std::vector<Vec3> reference;   ///< where the cloth would be if it slid along an obstacle in its way
    std::shared_ptr<const Obstacle> obstacle;  ///< its shape at the step's end; null: the cloth itself
    const MovingObstacle* moving = nullptr;    ///< likewise
    double previous_time = 0.0, time = 0.0;    ///< s, one step ago and at the step's start

    /// What rides on it with a vertex (`at_start`: world): where it was one step ago, and the velocity, m/s,
    /// that it has gained in the last step.
    Vec3 one_step_ago(int vertex) const;
    Vec3 velocity_gained(int vertex, const Vec3& at_start) const;

    /// World places of what rides on it with a point of the cloth, at the step's start and end.
    Vec3 at_begin(const ClothPoints& points) const;
    Vec3 at_end(const ClothPoints& points) const;

    /// Turns vectors of a contact from its frame at the state's time to the world at the step's end.
    Mat3 turn(const ClothPoints& points) const;
};

/// The carriers of a step.
struct Carriers {
    std::vector<Carrier> obstacles;  ///< as in the scene
    Carrier cloth;

    const Carrier& operator[](int obstacle) const  ///< index of an obstacle, or kClothItself
    {
        return obstacle == kClothItself ? cloth : obstacles[static_cast<std::size_t>(obstacle)];
    }
};

/// A point of the cloth, or the difference of two: weights on up to four vertices.
struct ClothPoints {
    std::array<int, 4> vertices = {-1, -1, -1, -1};  ///< -1 where there are fewer
    std::array<double, 4> weights =
        {};  ///< sum 1; of a difference, 1 on the first point and -1 on the second

    Vec3 at(const std::vector<Vec3>& field) const
    {
        Vec3 sum = Vec3::Zero();
        for (int i = 0; i < 4 && vertices[i] >= 0; ++i) sum += weights[i] * field[vertices[i]];
        return sum;
    }

    /// Whether the vertex has a weight.
    bool has_vertex(int vertex) const
    {
        for (int i = 0; i < 4; ++i)
            if (vertices[i] == vertex && weights[i] != 0.0) return true;
        return false;
    }

    /// Changes the value by `change` with the least momentum. `mobility`: 1 / mass of each vertex, 0 where it
    /// stays. Nothing changes where all stay.
    void shift(const Vec3& change, const std::vector<double>& mobility, std::vector<Vec3>& field) const;
};

/// A contact in the world, and its constraint in the velocity solve: at the step's end
/// normal . at(x') - normal . point >= least_gap. The point is zero where the cloth meets itself.
struct Contact : ClothPoints {
    ContactKind kind = ContactKind::Vertex;  ///< element of the cloth; of two parts of it the first one
    int obstacle = kClothItself;             ///< index in the scene, or kClothItself
    int element = 0;                         ///< as ObstacleContact's
    Vec3 normal = Vec3::Zero();              ///< unit, at the step's end
    Vec3 local_normal = Vec3::Zero(), local_point = Vec3::Zero();  ///< of the carrier
    double least_gap = 0.0;                                        ///< m
    double stand_off = 0.0;                                        ///< m: up to which the gap may grow
    double gap = 0.0;  ///< distance of q~ beyond the gap to be kept at the step's end, m; negative inside
    double last_multiplier = 0.0;  ///< N s, of the last step; 0 where it did not press
    ContactFriction last_friction =
        {};                         ///< of the last step, in the world; at EOL vertices see ContactFriction
    ContactFriction friction = {};  ///< likewise, of the last solve; before one, of the last step
    bool is_pressing = false;       ///< in the last solve of this step, at an earlier linearization
    bool may_grow = true;           ///< whether its gap may grow to the stand-off (restore_stand_off)
    double stiffness = 0.0;         ///< N/m, of squeezed cloth (squeezed.h); 0 where it keeps `least_gap`
    bool was_squeezed = false;      ///< in the last step
    bool is_beside_rim = false;     ///< of a squeezed vertex with the plane of a squeezed edge past a rim
    bool is_floor = false;          ///< keeps squeezed cloth from going below the least thickness
    int eol = -1;                   ///< index of the EOL coordinates whose first one it bounds; else -1
    int bound = -1;  ///< coordinate of the velocity solve, 3 a vertex; -1 where it is a constraint
    int row = -1;    ///< row of the velocity solve, or -1

    bool is_with_itself() const { return obstacle == kClothItself; }
    bool is_squeezed() const { return stiffness > 0.0; }
    bool is_fold_plane() const { return is_vertex() && element == kFoldPlaneElement; }
    bool is_vertex() const { return vertices[1] < 0; }  ///< a single vertex, at an obstacle

    /// Vertices that a part of the cloth can have here; of two parts, the first one. The second one has the
    /// others.
    int first_count() const { return kind == ContactKind::Vertex ? 1 : kind == ContactKind::Edge ? 2 : 3; }
    bool was_active() const { return last_multiplier > 0.0; }
};

/// Motion of the obstacles during the step that ends at `end` (s), and of the cloth past them: at its current
/// velocity, with pinned vertices moving to their targets.
Carriers move_obstacles(const Scene& scene, const State& state, const std::vector<MeshEdge>& edges,
                        const Prediction& prediction, const std::vector<PinTarget>& held, double end);

/// Contacts with obstacles possible in the step: of vertices, edges and faces, and the pairs that pressed at
/// the end of the last step.
std::vector<Contact> find_contacts_with_obstacles(const Scene& scene, const State& state,
                                                  const Prediction& prediction, Carriers& carriers);

/// Contacts of the cloth with itself possible in the step, as predicted. None without self-contact in the
/// scene.
std::vector<Contact> find_contacts_with_itself(const Scene& scene, const State& state,
                                               const Prediction& prediction,
                                               const std::vector<PinTarget>& held, const SelfSurface& surface,
                                               Carriers& carriers);

/// q~ of a vertex that has ridden on the carrier during the last step.
Vec3 ridden_position(const Carrier& carrier, const State& state, double forward, int vertex);

/// Sets the contact's gap from the prediction.
void update_gap(const Carrier& carrier, const Prediction& prediction, Contact& contact);

/// Sets each contact's gap from the prediction.
void update_gaps(const Carriers& carriers, const Prediction& prediction, std::vector<Contact>& contacts);

/// Sets the contact's last multiplier and friction from `state.active`, if it pressed. For an edge or face
/// both elements must match. A vertex slides from face to face: the normals must be close.
void recall(const State& state, const Carriers& carriers, Contact& contact);

/// Distance, m, by which the carrier moves along the contact's normal in the step, at the contact.
double way_along(const Carriers& carriers, const Contact& contact);

/// A contact that search or check has found, in the world, with its gap at the prediction.
Contact place_contact(const ObstacleContact& found, int obstacle, double thickness, const Carriers& carriers,
                      const Prediction& prediction);
Contact place_contact(const SelfContact& found, const Carriers& carriers, const Prediction& prediction);

/// Coefficient of friction at a contact of a cloth with this mesh; 0 without friction.
double friction_at(const Scene& scene, const ClothMesh& mesh, const Contact& contact);

/// 1 / mass of each vertex, 1/kg, with which contacts shift positions and history; 0 at vertices pinned in
/// all directions, which stay.
std::vector<double> find_mobility(const Materials& materials, const ClothElements& elements,
                                  const std::vector<PinTarget>& held);

/// Pressing contacts, for `State::active`; `multiplier` has one entry a contact (N s).
std::vector<ActiveContact> active_contacts(const State& state, const Carriers& carriers,
                                           const std::vector<Contact>& contacts,
                                           const std::vector<double>& multiplier);

}  // namespace arris
