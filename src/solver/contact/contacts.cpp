// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/contact/contacts.h"

#include <algorithm>
#include <tuple>

#include "geometry/batches.h"
#include "geometry/self_contact/self_contact_search.h"

namespace arris {

namespace {

ContactVertexIds ids_of(const State& state, const ClothPoints& points)
{
    ContactVertexIds ids;
    for (int i = 0; i < 4 && points.vertices[i] >= 0; ++i) ids[i] = state.ids[points.vertices[i]];
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
    RememberedPairs(const Scene& scene, const State& state, const Carriers& carriers)
        : scene_(scene), state_(state), carriers_(carriers)
    {
    }

    void append(std::vector<ObstacleContact>& found, int obstacle)
    {
        const std::size_t known = found.size();
        for (const ActiveContact& active : state_.active) {
            if (active.obstacle != obstacle || active.kind == ContactKind::Vertex) continue;
            std::array<int, 3> vertices = {-1, -1, -1};
            bool is_there = true;
            for (int i = 0; i < 3 && active.vertex_ids[i] != ContactVertexIds::kNoVertex; ++i) {
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
        const Carrier& carrier = carriers_[active.obstacle];
        const Obstacle& obstacle = *carrier.obstacle;
        if (active.kind == ContactKind::Edge)
            return make_edge_contact(obstacle, carrier.motion, carrier.reference, {vertices[0], vertices[1]},
                                     active.element, scene_.materials.thickness());
        const int face = find_face(vertices);
        if (face < 0) return std::nullopt;
        return make_face_contact(obstacle, carrier.motion, carrier.reference, face, active.element,
                                 scene_.materials.thickness());
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
    const Carriers& carriers_;
    VertexFaces faces_at_;  ///< of each vertex; filled on first use
};

ContactFriction rotate(const Mat3& rotation, const ContactFriction& friction)
{
    return {rotation * friction.force, rotation * friction.slip, friction.budget};
}

double longest_edge(const std::vector<Vec3>& world, const std::vector<MeshEdge>& edges)
{
    double longest = 0.0;
    for (const MeshEdge& edge : edges) longest = std::max(longest, (world[edge.b] - world[edge.a]).norm());
    return longest;
}

/// Lets the cloth near an obstacle that deforms ride on it: each vertex with the nearest place of the
/// surface. So gaps above faces stay, and the search for contacts, which knows the obstacle at the step's end
/// only, finds what rests or slides there. What the search misses the check after the solve finds. `cell`:
/// the longest edge of the cloth, m.
void ride(double end, double cell, Carrier& carrier)
{
    const MovingObstacle& obstacle = *carrier.moving;
    const ObstaclePose from = obstacle.at(carrier.time), to = obstacle.at(end),
                       earlier = obstacle.at(carrier.previous_time);
    const double reach = 2.0 * (cell + longest_way(from->mesh().points, to->mesh().points));
    const auto sides = std::make_shared<const MovingSides>(MovingSides{from.shape, carrier.motion.begin});
    const std::vector<Vec3>& world = sides->cloth;  // the obstacle's frame is the world
    carrier.motion.sides = sides;
    carrier.rides.resize(world.size());
    for_each_in_batches(static_cast<int>(world.size()), [&](int v) {
        const Vec3& place = world[v];
        carrier.rides[v] = {place, place, Mat3::Identity(), Vec3::Zero()};
        if (from->bounds().squaredExteriorDistance(place) > reach * reach) return;
        const std::optional<SurfacePlace> on = find_nearest(from, place, reach);
        if (!on) return;
        const Placement way = find_way(from, to, *on);
        const Vec3 before = find_way(from, earlier, *on)(place);
        carrier.motion.begin[v] = way(place);
        carrier.rides[v] = {place, before, way.rotation,
                            riding_velocity(from, *from.velocities, *on, place) -
                                riding_velocity(earlier, *earlier.velocities, *on, before)};
    });
}

std::vector<Vec3> find_free_end(const State& state, const Prediction& prediction,
                                const std::vector<PinTarget>& held)
{
    std::vector<Vec3> end(prediction.position.size());
    for (std::size_t v = 0; v < end.size(); ++v)
        end[v] = prediction.position[v] + prediction.gamma * state.velocity[v];
    hold_in_place(held, end);
    return end;
}

}  // namespace

Vec3 Carrier::one_step_ago(int vertex) const
{
    return rides.empty() ? before(motion.begin[vertex]) : rides[vertex].before;
}

Vec3 Carrier::velocity_gained(int vertex, const Vec3& at_start) const
{
    if (!moving) return Vec3::Zero();
    if (!rides.empty()) return rides[vertex].gained;
    return moving->velocity_after(time, at_start) -
           moving->velocity_after(previous_time, one_step_ago(vertex));
}

Vec3 Carrier::at_begin(const ClothPoints& points) const
{
    if (rides.empty()) return begin(points.at(motion.begin));
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < 4 && points.vertices[i] >= 0; ++i)
        sum += points.weights[i] * rides[points.vertices[i]].begin;
    return sum;
}

Vec3 Carrier::at_end(const ClothPoints& points) const
{
    return end(points.at(motion.begin));
}

Mat3 Carrier::turn(const ClothPoints& points) const
{
    if (rides.empty()) return end.rotation;
    int heaviest = 0;
    for (int i = 1; i < 4 && points.vertices[i] >= 0; ++i)
        if (points.weights[i] > points.weights[heaviest]) heaviest = i;
    return rides[points.vertices[heaviest]].turn;
}

void ClothPoints::shift(const Vec3& change, const std::vector<double>& mobility,
                        std::vector<Vec3>& field) const
{
    double squares = 0.0;
    for (int i = 0; i < 4 && vertices[i] >= 0; ++i)
        squares += weights[i] * weights[i] * mobility[vertices[i]];
    if (!(squares > 0.0)) return;
    for (int i = 0; i < 4 && vertices[i] >= 0; ++i)
        field[vertices[i]] += (weights[i] * mobility[vertices[i]] / squares) * change;
}

Carriers move_obstacles(const Scene& scene, const State& state, const std::vector<MeshEdge>& edges,
                        const Prediction& prediction, const std::vector<PinTarget>& held, double end)
{
    Carriers carriers;
    if (scene.self_contact) carriers.cloth.motion = {&state.mesh.faces, &edges, state.mesh.world, {}};
    if (scene.obstacles.empty()) return carriers;
    const std::vector<Vec3> free_end = find_free_end(state, prediction, held);
    for (const MovingObstacle& obstacle : scene.obstacles) {
        Carrier carrier;
        carrier.moving = &obstacle;
        carrier.previous_time = state.time - state.previous_dt;
        carrier.time = state.time;
        carrier.before = obstacle.at(carrier.previous_time).placement;
        carrier.begin = obstacle.at(carrier.time).placement;
        const ObstaclePose pose = obstacle.at(end);
        carrier.obstacle = pose.shape;
        carrier.end = pose.placement;
        carrier.motion = {&state.mesh.faces, &edges, to_local(carrier.begin, state.mesh.world),
                          to_local(carrier.end, free_end), nullptr};
        if (obstacle.is_deforming()) ride(end, longest_edge(state.mesh.world, edges), carrier);
        carriers.obstacles.push_back(std::move(carrier));
    }
    return carriers;
}

void update_gaps(const Carriers& carriers, const Prediction& prediction, std::vector<Contact>& contacts)
{
    for (Contact& contact : contacts) update_gap(carriers[contact.obstacle], prediction, contact);
}

Vec3 ridden_position(const Carrier& carrier, const State& state, double forward, int vertex)
{
    const Vec3& now = state.mesh.world[vertex];
    return now + forward * (now - carrier.one_step_ago(vertex));
}

void recall(const State& state, const Carriers& carriers, Contact& contact)
{
    constexpr double kSameNormal = 0.7;
    const ContactVertexIds ids = ids_of(state, contact);
    const bool is_vertex = contact.kind == ContactKind::Vertex;
    const ActiveContact* last = nullptr;
    double best_cosine = kSameNormal;
    const Carrier& carrier = carriers[contact.obstacle];
    const auto normal_of = [&](const ActiveContact& active) {
        return carrier.rides.empty() ? active.normal : Vec3(carrier.turn(contact) * active.normal);
    };
    auto active =
        std::lower_bound(state.active.begin(), state.active.end(), ids[0],
                         [](const ActiveContact& a, std::uint32_t first) { return a.vertex_ids[0] < first; });
    for (; active != state.active.end() && active->vertex_ids[0] == ids[0]; ++active) {
        if (active->obstacle != contact.obstacle || active->kind != contact.kind) continue;
        const bool is_same = active->vertex_ids == ids && active->element == contact.element;
        const double cosine = is_vertex ? normal_of(*active).dot(contact.local_normal) : is_same ? 1.0 : 0.0;
        if (!(cosine > best_cosine)) continue;
        last = &*active;
        best_cosine = cosine;
    }
    if (!last) return;
    contact.last_multiplier = last->multiplier;
    contact.was_squeezed = last->is_squeezed;
    contact.last_friction = last->friction;
    if (contact.eol < 0) contact.last_friction = rotate(carrier.turn(contact), contact.last_friction);
    contact.friction = contact.last_friction;
}

double way_along(const Carriers& carriers, const Contact& contact)
{
    const Carrier& carrier = carriers[contact.obstacle];
    return contact.normal.dot(carrier.at_end(contact) - carrier.at_begin(contact));
}

void update_gap(const Carrier& carrier, const Prediction& prediction, Contact& contact)
{
    contact.gap = contact.normal.dot(contact.at(prediction.position) - carrier.end(contact.local_point)) -
                  contact.least_gap;
}

Contact place_contact(const ObstacleContact& found, int obstacle, double thickness, const Carriers& carriers,
                      const Prediction& prediction)
{
    Contact contact;
    std::copy(found.vertices.begin(), found.vertices.end(), contact.vertices.begin());
    std::copy(found.weights.begin(), found.weights.end(), contact.weights.begin());
    contact.kind = found.kind;
    contact.obstacle = obstacle;
    contact.element = found.element;
    contact.normal = carriers[obstacle].end.rotation * found.normal;
    contact.local_normal = found.normal;
    contact.local_point = found.point;
    contact.least_gap = found.least_gap;
    contact.stand_off = thickness;
    update_gap(carriers[obstacle], prediction, contact);
    return contact;
}

Contact place_contact(const SelfContact& found, const Carriers& carriers, const Prediction& prediction)
{
    Contact contact;
    contact.vertices = found.vertices;
    contact.weights = found.weights;
    contact.kind = found.kind == SelfContactKind::VertexFace ? ContactKind::Vertex : ContactKind::Edge;
    contact.obstacle = kClothItself;
    contact.normal = contact.local_normal = found.normal;
    contact.local_point = Vec3::Zero();
    contact.least_gap = found.least_gap;
    contact.stand_off = found.thickness;
    update_gap(carriers.cloth, prediction, contact);
    return contact;
}

std::vector<Contact> find_contacts_with_obstacles(const Scene& scene, const State& state,
                                                  const Prediction& prediction, Carriers& carriers)
{
    std::vector<Contact> contacts;
    const double thickness = scene.materials.thickness();
    for (Carrier& carrier : carriers.obstacles)
        carrier.reference = slide(*carrier.obstacle, carrier.motion, thickness);
    RememberedPairs remembered(scene, state, carriers);
    for (int o = 0; o < static_cast<int>(carriers.obstacles.size()); ++o) {
        const auto& [obstacle, motion, reference] =
            std::tie(*carriers[o].obstacle, carriers[o].motion, carriers[o].reference);
        std::vector<ObstacleContact> found = find_edge_contacts(obstacle, motion, reference, thickness);
        const std::vector<ObstacleContact> of_faces =
            find_face_contacts(obstacle, motion, reference, thickness);
        found.insert(found.end(), of_faces.begin(), of_faces.end());
        remembered.append(found, o);
        const std::vector<ObstacleContact> of_vertices =
            find_vertex_contacts(obstacle, motion, reference, thickness);
        found.insert(found.begin(), of_vertices.begin(), of_vertices.end());
        for (const ObstacleContact& contact : found)
            contacts.push_back(place_contact(contact, o, thickness, carriers, prediction));
    }
    for (Contact& contact : contacts) recall(state, carriers, contact);
    return contacts;
}

std::vector<Contact> find_contacts_with_itself(const Scene& scene, const State& state,
                                               const Prediction& prediction,
                                               const std::vector<PinTarget>& held, const SelfSurface& surface,
                                               Carriers& carriers)
{
    std::vector<Contact> contacts;
    if (!scene.self_contact) return contacts;
    const double thickness = scene.self_contact->thickness;
    carriers.cloth.motion.end = find_free_end(state, prediction, held);
    for (const SelfContact& found :
         find_self_contacts(surface, {state.mesh.world, carriers.cloth.motion.end}, thickness))
        contacts.push_back(place_contact(found, carriers, prediction));
    for (Contact& contact : contacts) recall(state, carriers, contact);
    return contacts;
}

double friction_at(const Scene& scene, const ClothMesh& mesh, const Contact& contact)
{
    if (!scene.friction) return 0.0;
    const int piece = piece_of(scene, mesh, contact.vertices[0]);
    if (!contact.is_with_itself()) return scene.friction->with_obstacle(contact.obstacle, piece);
    return scene.friction->between(piece, piece_of(scene, mesh, contact.vertices[contact.first_count()]));
}

std::vector<double> find_mobility(const Materials& materials, const ClothElements& elements,
                                  const std::vector<PinTarget>& held)
{
    std::vector<double> mobility = lump_masses(materials, elements);
    for (double& value : mobility) value = 1.0 / value;
    for (const PinTarget& vertex : held)
        if (vertex.held[0] && vertex.held[1] && vertex.held[2]) mobility[vertex.vertex] = 0.0;
    return mobility;
}

std::vector<ActiveContact> active_contacts(const State& state, const Carriers& carriers,
                                           const std::vector<Contact>& contacts,
                                           const std::vector<double>& multiplier)
{
    std::vector<ActiveContact> active;
    for (std::size_t c = 0; c < contacts.size(); ++c) {
        const Contact& contact = contacts[c];
        if (!(multiplier[c] > 0.0)) continue;
        const Mat3 to_local = contact.eol >= 0 ? Mat3(Mat3::Identity())
                                               : Mat3(carriers[contact.obstacle].end.rotation.transpose());
        active.push_back({ids_of(state, contact), contact.kind, contact.obstacle, contact.element,
                          contact.local_normal, multiplier[c], rotate(to_local, contact.friction),
                          contact.is_squeezed() || contact.is_floor});
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
