// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/contact/contacts.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "geometry/contact/contact_plane.h"

namespace arris {

namespace {

using VertexIds = std::array<std::uint32_t, 3>;

VertexIds ids_of(const State& state, const std::array<int, 3>& vertices)
{
    VertexIds ids;
    for (int i = 0; i < 3; ++i) ids[i] = vertices[i] < 0 ? ActiveContact::kNoVertex : state.ids[vertices[i]];
    return ids;
}

auto key_of(const ActiveContact& contact)
{
    return std::tuple(contact.vertex_ids, contact.obstacle, contact.kind, contact.element);
}

/// Edge and face contacts that pressed at the end of the last step and that the search by features misses.
/// The check after the solve had found them.
class RememberedPairs {
  public:
    RememberedPairs(const Scene& scene, const State& state, const std::vector<ObstacleStep>& steps)
        : scene_(scene), state_(state), steps_(steps)
    {
    }

    void append(std::vector<ObstacleContact>& found, int obstacle)
    {
        const std::size_t known = found.size();
        for (const ActiveContact& active : state_.active) {
            if (active.obstacle != obstacle || active.kind == ContactKind::Vertex) continue;
            std::array<int, 3> vertices = {-1, -1, -1};
            bool is_there = true;
            for (int i = 0; i < 3 && active.vertex_ids[i] != ActiveContact::kNoVertex; ++i) {
                vertices[i] = state_.index_of(active.vertex_ids[i]);
                is_there = is_there && vertices[i] >= 0;
            }
            const auto is_same = [&](const ObstacleContact& c) {
                return c.kind == active.kind && c.vertices == vertices && c.element == active.element;
            };
            if (!is_there ||
                std::any_of(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(known), is_same))
                continue;
            if (const auto contact = make(vertices, active)) found.push_back(*contact);
        }
    }

  private:
    std::optional<ObstacleContact> make(const std::array<int, 3>& vertices, const ActiveContact& active)
    {
        const Obstacle& obstacle = scene_.obstacles[active.obstacle];
        const ObstacleStep& step = steps_[active.obstacle];
        if (active.kind == ContactKind::Edge)
            return make_edge_contact(obstacle, step.motion, step.reference, {vertices[0], vertices[1]},
                                     active.element, scene_.material.thickness);
        const int face = find_face(vertices);
        if (face < 0) return std::nullopt;
        return make_face_contact(obstacle, step.motion, step.reference, face, active.element,
                                 scene_.material.thickness);
    }

    /// A face with these vertices (an edge may have two); -1 where the mesh no longer has one.
    int find_face(const std::array<int, 3>& vertices)
    {
        if (faces_at_.empty()) faces_at_ = VertexFaces(state_.mesh.vertex_count(), state_.mesh.faces);
        for (const int f : faces_at_[vertices[0]]) {
            const Face& face = state_.mesh.faces[f];
            const auto is_in_face = [&](int v) {
                return v < 0 || std::find(face.begin(), face.end(), v) != face.end();
            };
            if (std::all_of(vertices.begin(), vertices.end(), is_in_face)) return f;
        }
        return -1;
    }

    const Scene& scene_;
    const State& state_;
    const std::vector<ObstacleStep>& steps_;
    VertexFaces faces_at_;  ///< of each vertex; filled on first use
};

void update_gap(const ObstacleStep& step, const Prediction& prediction, Contact& contact)
{
    const ObstacleContact& local = contact.in_frame;
    contact.gap = contact.normal.dot(local.at(prediction.position) - step.end(local.point)) - local.least_gap;
}

/// Components of q~ and v~ along the contact's normal if its point had ridden on the obstacle for two steps.
struct RiddenHistory {
    double position, velocity;
};

RiddenHistory find_ridden(const Obstacle& obstacle, const ObstacleStep& step, const State& state,
                          double forward, const Contact& contact)
{
    const double previous_time = state.time - state.previous_dt;
    Vec3 position = Vec3::Zero(), velocity = Vec3::Zero();
    for (int i = 0; i < 3 && contact.in_frame.vertices[i] >= 0; ++i) {
        const int v = contact.in_frame.vertices[i];
        const Vec3& now = state.mesh.world[v];
        const Vec3 before = step.before(step.motion.begin[v]);
        const Vec3 gained =
            obstacle.velocity_after(state.time, now) - obstacle.velocity_after(previous_time, before);
        position += contact.in_frame.weights[i] * ridden_position(step, state, forward, v);
        velocity += contact.in_frame.weights[i] * (state.velocity[v] + forward * gained);
    }
    return {contact.normal.dot(position), contact.normal.dot(velocity)};
}

/// Whether the extrapolated history runs into the contact, or the contact pressed.
bool runs_into(const ObstacleStep& step, const Contact& contact, double shift)
{
    const ObstacleContact& local = contact.in_frame;
    if (contact.was_active()) return true;
    const double now = local.normal.dot(local.at(step.motion.begin) - local.point);
    const double end = local.normal.dot(local.at(step.motion.end) - local.point);
    return now + shift < local.least_gap && end < local.least_gap;
}

/// Changes a field and its material counterpart by `amount` along the contact's normal, with the least
/// change.
void shift_along(const std::vector<EolCoordinates>& eol, const Contact& contact, double amount,
                 std::vector<Vec3>& world, std::vector<Vec2>& material)
{
    if (contact.eol < 0) return contact.in_frame.shift(amount * contact.normal, world);
    const EolCoordinates& at = eol[contact.eol];
    world[at.vertex] += amount * (at.basis * at.opening);
    material[at.vertex] += amount * (at.material_basis * at.opening);
}

ContactFriction rotate(const Mat3& rotation, const ContactFriction& friction)
{
    return {rotation * friction.force, rotation * friction.slip, friction.budget};
}

/// Shares the room between two contacts of one vertex whose normals are opposite.
SharedRoom share_room(const std::vector<ObstacleStep>& steps, const Prediction& prediction, Contact& a,
                      Contact& b)
{
    constexpr double kOpposite = -0.9;       // cosine between the normals
    constexpr double kFacing = -1.0 + 1e-9;  // cosine below which they face each other exactly
    constexpr double kShared = 0.99;         // of the room, so that the two contacts do not conflict
    constexpr double kNoRoom = 1e-6;         // of the stand-offs: a smaller room is round-off
    const double cosine = a.normal.dot(b.normal);
    const double wanted = a.in_frame.least_gap + b.in_frame.least_gap;
    if (!(cosine < kOpposite) || !(wanted > 0.0)) return {};
    // Measured at the vertex: planes that do not face each other exactly have no single distance.
    const Vec3 place = steps[a.obstacle].end(steps[a.obstacle].reference[a.in_frame.vertices[0]]);
    const double room = a.normal.dot(place - steps[a.obstacle].end(a.in_frame.point)) +
                        b.normal.dot(place - steps[b.obstacle].end(b.in_frame.point));
    if (kShared * room >= wanted) return {};
    for (Contact* contact : {&a, &b}) {
        contact->in_frame.least_gap *= std::max(kShared * room / wanted, 0.0);
        contact->may_grow = false;
        update_gap(steps[contact->obstacle], prediction, *contact);
    }
    const bool is_overconstrained = !(room > kNoRoom * wanted) && cosine < kFacing;
    return {true, is_overconstrained ? std::optional(a.in_frame.vertices[0]) : std::nullopt};
}

}  // namespace

std::vector<ObstacleStep> move_obstacles(const Scene& scene, const State& state,
                                         const std::vector<MeshEdge>& edges, const Prediction& prediction,
                                         const std::vector<PinTarget>& held, double end)
{
    std::vector<ObstacleStep> steps;
    if (scene.obstacles.empty()) return steps;
    const std::size_t n = state.mesh.world.size();
    std::vector<Vec3> free_end(n);
    for (std::size_t v = 0; v < n; ++v)
        free_end[v] = prediction.position[v] + prediction.gamma * state.velocity[v];
    hold_in_place(held, free_end);

    for (const Obstacle& obstacle : scene.obstacles) {
        ObstacleStep step;
        step.before = obstacle.at(state.time - state.previous_dt);
        step.begin = obstacle.at(state.time);
        step.end = obstacle.at(end);
        step.motion = {&state.mesh.faces, &edges, to_frame(step.begin, state.mesh.world),
                       to_frame(step.end, free_end)};
        steps.push_back(std::move(step));
    }
    return steps;
}

void update_gaps(const std::vector<ObstacleStep>& steps, const Prediction& prediction,
                 std::vector<Contact>& contacts)
{
    for (Contact& contact : contacts) update_gap(steps[contact.obstacle], prediction, contact);
}

Vec3 ridden_position(const ObstacleStep& step, const State& state, double forward, int vertex)
{
    const Vec3& now = state.mesh.world[vertex];
    return now + forward * (now - step.before(step.motion.begin[vertex]));
}

void recall(const State& state, const ObstacleStep& step, Contact& contact)
{
    constexpr double kSameNormal = 0.7;
    const VertexIds ids = ids_of(state, contact.in_frame.vertices);
    const std::pair<VertexIds, std::int32_t> key(ids, contact.obstacle);
    auto active = std::lower_bound(state.active.begin(), state.active.end(), key,
                                   [](const ActiveContact& a, const auto& wanted) {
                                       return std::pair(a.vertex_ids, a.obstacle) < wanted;
                                   });
    for (; active != state.active.end() && std::pair(active->vertex_ids, active->obstacle) == key; ++active)
        if (active->kind == contact.in_frame.kind &&
            (contact.is_vertex() ? active->normal.dot(contact.in_frame.normal) > kSameNormal
                                 : active->element == contact.in_frame.element)) {
            contact.last_multiplier = active->multiplier;
            contact.last_friction = active->friction;
            if (contact.eol < 0) contact.last_friction = rotate(step.end.rotation, contact.last_friction);
            contact.friction = contact.last_friction;
            return;
        }
}

double way_along(const ObstacleStep& step, const Contact& contact)
{
    const Vec3 place = contact.in_frame.at(step.motion.begin);
    return contact.normal.dot(step.end(place) - step.begin(place));
}

Contact place_contact(const ObstacleContact& contact, int obstacle, const ObstacleStep& step,
                      const Prediction& prediction)
{
    Contact placed = {
        .in_frame = contact, .obstacle = obstacle, .normal = step.end.rotation * contact.normal, .gap = 0.0};
    update_gap(step, prediction, placed);
    return placed;
}

std::vector<Contact> find_contacts(const Scene& scene, const State& state, const Prediction& prediction,
                                   std::vector<ObstacleStep>& steps)
{
    std::vector<Contact> contacts;
    const double thickness = scene.material.thickness;
    for (std::size_t o = 0; o < steps.size(); ++o) {
        const Obstacle& obstacle = scene.obstacles[o];
        steps[o].reference = slide(obstacle, steps[o].motion, thickness);
    }
    RememberedPairs remembered(scene, state, steps);
    for (std::size_t o = 0; o < steps.size(); ++o) {
        const Obstacle& obstacle = scene.obstacles[o];
        const ClothMotion& motion = steps[o].motion;
        const std::vector<Vec3>& reference = steps[o].reference;
        std::vector<ObstacleContact> found = find_edge_contacts(obstacle, motion, reference, thickness);
        const std::vector<ObstacleContact> of_faces =
            find_face_contacts(obstacle, motion, reference, thickness);
        found.insert(found.end(), of_faces.begin(), of_faces.end());
        remembered.append(found, static_cast<int>(o));
        const std::vector<ObstacleContact> of_vertices =
            find_vertex_contacts(obstacle, motion, reference, thickness);
        found.insert(found.begin(), of_vertices.begin(), of_vertices.end());
        for (const ObstacleContact& contact : found) {
            contacts.push_back(place_contact(contact, static_cast<int>(o), steps[o], prediction));
            recall(state, steps[o], contacts.back());
        }
    }
    return contacts;
}

SharedRoom share_room(const std::vector<ObstacleStep>& steps, const Prediction& prediction,
                      std::vector<Contact>& contacts)
{
    std::vector<Contact*> of_vertices;
    for (Contact& contact : contacts)
        if (contact.is_vertex() && !contact.is_fold()) of_vertices.push_back(&contact);
    const auto vertex_of = [](const Contact* contact) { return contact->in_frame.vertices[0]; };
    std::stable_sort(of_vertices.begin(), of_vertices.end(),
                     [&](const Contact* a, const Contact* b) { return vertex_of(a) < vertex_of(b); });
    SharedRoom shared;
    for (std::size_t i = 0; i < of_vertices.size(); ++i)
        for (std::size_t j = i + 1;
             j < of_vertices.size() && vertex_of(of_vertices[j]) == vertex_of(of_vertices[i]); ++j) {
            const SharedRoom pair = share_room(steps, prediction, *of_vertices[i], *of_vertices[j]);
            shared.is_changed = shared.is_changed || pair.is_changed;
            if (!shared.overconstrained) shared.overconstrained = pair.overconstrained;
        }
    return shared;
}

bool yield_stand_off(const std::vector<ObstacleStep>& steps, const Prediction& prediction, double thickness,
                     Contact& contact)
{
    constexpr double kNothingLeft = 1e-3;  // of the thickness
    constexpr double kFree = 1e3;          // m: farther than any step moves
    const ObstacleStep& step = steps[contact.obstacle];
    ObstacleContact& local = contact.in_frame;
    const double now = local.normal.dot(local.at(step.motion.begin) - local.point);
    if (contact.is_fold()) {  // only a help: the check finds cloth that passes without it
        if (local.least_gap <= -kFree) return false;
        local.least_gap = -kFree;
    } else {
        if (!(local.least_gap > kNothingLeft * thickness)) return false;
        local.least_gap = now < local.least_gap ? now : 0.5 * local.least_gap;
    }
    contact.may_grow = false;
    update_gap(step, prediction, contact);
    return true;
}

bool flatten_history(const Scene& scene, const State& state, const std::vector<ObstacleStep>& steps,
                     const std::vector<EolCoordinates>& eol, std::size_t first,
                     std::vector<Contact>& contacts, Prediction& prediction)
{
    constexpr int kPasses = 3;  // contacts of a vertex with oblique normals affect each other
    bool is_changed = false;
    for (int pass = 0; prediction.has_history && pass < kPasses; ++pass)
        for (std::size_t c = first; c < contacts.size(); ++c) {
            const Contact& contact = contacts[c];
            const ObstacleStep& step = steps[contact.obstacle];
            const RiddenHistory ridden =
                find_ridden(scene.obstacles[contact.obstacle], step, state, prediction.forward, contact);
            const double shift =
                contact.normal.dot(contact.in_frame.at(prediction.position)) - ridden.position;
            if (!runs_into(step, contact, shift)) continue;
            const double gained =
                ridden.velocity - contact.normal.dot(contact.in_frame.at(prediction.velocity));
            shift_along(eol, contact, -shift, prediction.position, prediction.material);
            shift_along(eol, contact, gained, prediction.velocity, prediction.material_velocity);
            is_changed = true;
        }
    if (is_changed) update_gaps(steps, prediction, contacts);
    return is_changed;
}

std::vector<ActiveContact> active_contacts(const State& state, const std::vector<ObstacleStep>& steps,
                                           const std::vector<Contact>& contacts,
                                           const std::vector<double>& multiplier)
{
    std::vector<ActiveContact> active;
    for (std::size_t c = 0; c < contacts.size(); ++c) {
        const Contact& contact = contacts[c];
        const ObstacleContact& local = contact.in_frame;
        if (!(multiplier[c] > 0.0)) continue;
        const Mat3 to_frame = contact.eol >= 0 ? Mat3(Mat3::Identity())
                                               : Mat3(steps[contact.obstacle].end.rotation.transpose());
        active.push_back({ids_of(state, local.vertices), local.kind, contact.obstacle, local.element,
                          local.normal, multiplier[c], rotate(to_frame, contact.friction)});
    }
    std::sort(active.begin(), active.end(), [](const ActiveContact& a, const ActiveContact& b) {
        return key_of(a) < key_of(b) || (key_of(a) == key_of(b) && a.multiplier > b.multiplier);
    });
    const auto is_twin = [](const ActiveContact& a, const ActiveContact& b) {
        return key_of(a) == key_of(b);
    };
    active.erase(std::unique(active.begin(), active.end(), is_twin), active.end());
    return active;
}

}  // namespace arris
