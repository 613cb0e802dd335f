// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/contact/squeezed.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "solver/model/hysteresis.h"

namespace arris {

namespace {

/// The cloth's area at a contact, m^2. A vertex has its own. A sharp edge presses on a strip as wide as the
/// cloth is thick, a point on a square: the vertices around them have the rest.
double area_at(const Cushion& cushion, const Contact& contact)
{
    double area = 0.0;
    for (int i = 0; i < 4 && contact.vertices[i] >= 0; ++i)
        area += std::abs(contact.weights[i]) * cushion.area[contact.vertices[i]];
    if (contact.is_with_itself()) return 0.5 * area;  // weights of both layers
    const double thick = contact.stand_off;
    if (contact.kind == ContactKind::Edge) return std::min(area, thick * std::sqrt(area));
    return contact.kind == ContactKind::Triangle ? std::min(area, thick * thick) : area;
}

/// Mean of both layers where the cloth meets itself.
double modulus_at(const Cushion& cushion, const Contact& contact)
{
    const double first = cushion.modulus[contact.vertices[0]];
    if (!contact.is_with_itself()) return first;
    return 0.5 * (first + cushion.modulus[contact.vertices[contact.first_count()]]);
}

double end_distance(const Carrier& carrier, const Contact& contact, const std::vector<Vec3>& world)
{
    return contact.normal.dot(contact.at(world) - carrier.end(contact.local_point));
}

double begin_distance(const Carrier& carrier, const Contact& contact)
{
    return contact.local_normal.dot(contact.at(carrier.motion.begin) - contact.local_point);
}

/// Whether squeezed cloth is thinner than a share of its stand-off. A plane borrowed from an edge does not
/// tell.
bool is_thinner(double share, const Contact& contact, double distance)
{
    return contact.is_squeezed() && !contact.is_beside_rim && distance < share * contact.stand_off;
}

/// Whether squeezed cloth is thinner than the least thickness, but for the round-off of a solve.
bool is_too_thin(const Contact& contact, double distance)
{
    constexpr double kRoundOff = 1e-9;  // of the stand-off
    return is_thinner(kLeastThickness - kRoundOff, contact, distance);
}

/// Whether two contacts keep the least thickness at the same place.
bool is_same_floor(const Contact& a, const Contact& b)
{
    return a.is_floor && b.is_floor && a.vertices == b.vertices && a.obstacle == b.obstacle &&
           a.element == b.element && a.normal == b.normal;
}

/// The contact that keeps the least thickness where `squeezed` presses.
Contact make_floor(const Carrier& carrier, const Prediction& prediction, const Contact& squeezed)
{
    Contact floor = squeezed;
    floor.stiffness = 0.0;
    floor.is_floor = true;
    floor.eol = floor.bound = floor.row = -1;
    floor.may_grow = false;
    floor.least_gap = kLeastThickness * squeezed.stand_off;
    update_gap(carrier, prediction, floor);
    return floor;
}

/// Share of both stand-offs that two opposite contacts leave to the cloth at the place of the first; nothing
/// where the cosine between their normals is not below `opposite`. Planes that do not face each other exactly
/// have no single distance.
std::optional<double> find_room(const Carriers& carriers, const Contact& a, const Contact& b, double opposite)
{
    if (!(a.normal.dot(b.normal) < opposite)) return std::nullopt;
    const Vec3 place = carriers[a.obstacle].end(a.at(carriers[a.obstacle].reference));
    const double room = a.normal.dot(place - carriers[a.obstacle].end(a.local_point)) +
                        b.normal.dot(place - carriers[b.obstacle].end(b.local_point));
    return room / (a.stand_off + b.stand_off);
}

/// Squeezes the cloth between two opposite contacts of one element where these leave too little room.
Squeezed squeeze_between(const Cushion& cushion, const Carriers& carriers, const Prediction& prediction,
                         Contact& a, Contact& b)
{
    constexpr double kOpposite = -0.9;       // cosine between the normals
    constexpr double kFacing = -1.0 + 1e-9;  // cosine below which they face each other exactly
    const std::optional<double> room = find_room(carriers, a, b, kOpposite);
    if (!room || *room >= 1.0) return {};
    Squeezed squeezed;
    for (Contact* contact : {&a, &b})
        squeezed.is_changed = squeeze(cushion, carriers, prediction, *contact) || squeezed.is_changed;
    if (!(*room > kLeastThickness) && a.normal.dot(b.normal) < kFacing)
        squeezed.overconstrained = a.vertices[0];
    return squeezed;
}

bool keeps_distance_from_obstacle(const Contact& contact)
{
    return !contact.is_with_itself() && !contact.is_fold_plane() && !contact.is_floor &&
           !contact.is_squeezed();
}

/// Contacts (indices) where the cloth is squeezed, by vertex, in their order.
std::multimap<int, std::size_t> index_squeezed(const std::vector<Contact>& contacts)
{
    std::multimap<int, std::size_t> squeezed_at;
    for (std::size_t c = 0; c < contacts.size(); ++c)
        for (int i = 0; i < 4 && contacts[c].vertices[i] >= 0; ++i)
            if (contacts[c].is_squeezed() && contacts[c].weights[i] != 0.0)
                squeezed_at.emplace(contacts[c].vertices[i], c);
    return squeezed_at;
}

/// Squeezes the cloth at contacts that press it against contacts where it is squeezed. If they kept their
/// distance there, two planes at a small angle would throw the cloth out sideways.
bool squeeze_against(const Cushion& cushion, const Carriers& carriers, const Prediction& prediction,
                     std::vector<Contact>& contacts)
{
    // Cosine between the normals: a slanted plane beside a gap would press cloth out of it as a spring.
    constexpr double kNearlyFacing = -0.99;
    const std::multimap<int, std::size_t> squeezed_at = index_squeezed(contacts);
    const auto is_pressed_against = [&](const Contact& contact) {
        for (int i = 0; i < 4 && contact.vertices[i] >= 0; ++i) {
            if (contact.weights[i] == 0.0) continue;
            const auto [first, last] = squeezed_at.equal_range(contact.vertices[i]);
            const bool is_found = std::any_of(first, last, [&](const auto& entry) {
                const std::optional<double> room =
                    find_room(carriers, contact, contacts[entry.second], kNearlyFacing);
                return room && *room < 1.0;
            });
            if (is_found) return true;
        }
        return false;
    };
    bool is_changed = false;
    for (Contact& contact : contacts)
        if (keeps_distance_from_obstacle(contact) && is_pressed_against(contact))
            is_changed = squeeze(cushion, carriers, prediction, contact) || is_changed;
    return is_changed;
}

/// A vertex about to pass a rim where its edges are squeezed has that rim in its way, at a slant. It takes
/// the plane of the edge there that presses nearest to it: a slanted one would hold cloth back at the entry
/// of a gap, or throw it out.
bool squeeze_beside_edges(const Cushion& cushion, const Carriers& carriers, const Prediction& prediction,
                          std::vector<Contact>& contacts)
{
    const std::multimap<int, std::size_t> squeezed_at = index_squeezed(contacts);
    const auto find_edge_beside = [&](const Contact& vertex) {
        const Contact* nearest = nullptr;
        double most = 0.0;
        const auto [first, last] = squeezed_at.equal_range(vertex.vertices[0]);
        for (auto entry = first; entry != last; ++entry) {
            const Contact& edge = contacts[entry->second];
            if (edge.kind != ContactKind::Edge || edge.obstacle != vertex.obstacle ||
                !(edge.normal.dot(vertex.normal) > 0.0))
                continue;
            const double weight = edge.weights[edge.vertices[0] == vertex.vertices[0] ? 0 : 1];
            if (!(weight > most)) continue;
            nearest = &edge;
            most = weight;
        }
        return nearest;
    };
    bool is_changed = false;
    for (Contact& contact : contacts) {
        if (!contact.is_vertex() || !keeps_distance_from_obstacle(contact) || contact.eol >= 0) continue;
        const Contact* edge = find_edge_beside(contact);
        if (edge == nullptr) continue;
        contact.normal = edge->normal;
        contact.local_normal = edge->local_normal;
        contact.local_point = edge->local_point;
        contact.is_beside_rim = true;
        is_changed = squeeze(cushion, carriers, prediction, contact) || is_changed;
    }
    return is_changed;
}

}  // namespace

Cushion make_cushion(const Materials& materials, const ClothMesh& mesh, const ClothElements& elements)
{
    Cushion cushion{{}, lump_areas(elements)};
    for (const Vec2& X : mesh.material) cushion.modulus.push_back(materials.at(X).compression_modulus);
    return cushion;
}

bool squeeze(const Cushion& cushion, const Carriers& carriers, const Prediction& prediction, Contact& contact)
{
    if (contact.is_squeezed() || contact.is_floor) return false;
    contact.stiffness = modulus_at(cushion, contact) * area_at(cushion, contact) / contact.stand_off;
    contact.least_gap = contact.stand_off;
    update_gap(carriers[contact.obstacle], prediction, contact);
    return true;
}

Squeezed squeeze_contacts(const Cushion& cushion, const Carriers& carriers, const Prediction& prediction,
                          std::vector<Contact>& contacts)
{
    Squeezed squeezed;
    std::vector<Contact*> sorted;
    for (Contact& contact : contacts) {
        // A vertex needs its opposite contact: past a rim the springs of its last one would throw it out.
        if (contact.was_squeezed && !contact.is_vertex())
            squeezed.is_changed = squeeze(cushion, carriers, prediction, contact) || squeezed.is_changed;
        if (!contact.is_with_itself() && !contact.is_fold_plane() && !contact.is_floor)
            sorted.push_back(&contact);
    }
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const Contact* a, const Contact* b) { return a->vertices < b->vertices; });
    for (std::size_t i = 0; i < sorted.size(); ++i)
        for (std::size_t j = i + 1; j < sorted.size() && sorted[j]->vertices == sorted[i]->vertices; ++j) {
            const Squeezed pair = squeeze_between(cushion, carriers, prediction, *sorted[i], *sorted[j]);
            squeezed.is_changed = squeezed.is_changed || pair.is_changed;
            if (!squeezed.overconstrained) squeezed.overconstrained = pair.overconstrained;
        }
    squeezed.is_changed = squeeze_against(cushion, carriers, prediction, contacts) || squeezed.is_changed;
    squeezed.is_changed =
        squeeze_beside_edges(cushion, carriers, prediction, contacts) || squeezed.is_changed;
    return squeezed;
}

std::vector<Contact> expect_floors(const Carriers& carriers, const Prediction& prediction,
                                   const std::vector<Contact>& contacts)
{
    std::vector<Contact> floors;
    for (const Contact& contact : contacts) {
        const Carrier& carrier = carriers[contact.obstacle];
        if (is_thinner(kLeastThickness / kStayRatio, contact, begin_distance(carrier, contact)))
            floors.push_back(make_floor(carrier, prediction, contact));
    }
    return floors;
}

std::vector<Contact> find_floors(const Carriers& carriers, const Prediction& prediction,
                                 const std::vector<Contact>& contacts, const std::vector<Vec3>& world)
{
    std::vector<Contact> floors;
    for (const Contact& contact : contacts) {
        const Carrier& carrier = carriers[contact.obstacle];
        if (!is_too_thin(contact, end_distance(carrier, contact, world))) continue;
        const Contact floor = make_floor(carrier, prediction, contact);
        if (std::none_of(contacts.begin(), contacts.end(),
                         [&](const Contact& other) { return is_same_floor(other, floor); }))
            floors.push_back(floor);
    }
    return floors;
}

std::vector<int> list_too_thin(const Carriers& carriers, const std::vector<Contact>& contacts,
                               const std::vector<Vec3>& world)
{
    std::vector<int> rows;
    for (const Contact& contact : contacts)
        if (contact.row >= 0 &&
            is_too_thin(contact, end_distance(carriers[contact.obstacle], contact, world)))
            rows.push_back(contact.row);
    std::sort(rows.begin(), rows.end());
    return rows;
}

double energy_stored(const Carriers& carriers, const std::vector<Contact>& contacts,
                     const std::vector<Vec3>& world)
{
    double stored = 0.0;
    for (const Contact& contact : contacts) {
        if (!contact.is_squeezed()) continue;
        const Carrier& carrier = carriers[contact.obstacle];
        const double before = std::max(contact.stand_off - begin_distance(carrier, contact), 0.0),
                     after = std::max(contact.stand_off - end_distance(carrier, contact, world), 0.0);
        stored += 0.5 * contact.stiffness * (after * after - before * before);
    }
    return stored;
}

}  // namespace arris
