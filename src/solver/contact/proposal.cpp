// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/contact/proposal.h"

#include <algorithm>

#include "geometry/check/sweep_check.h"
#include "geometry/self_contact/self_sweep.h"
#include "geometry/sort_unique.h"

namespace arris {

namespace {

/// Share of its path that each vertex moves. `shrink` halves this share at every vertex of the given faces;
/// below a sixteenth it becomes zero. Once all are zero, the patch grows by the faces around it. True where
/// anything changed.
class Shares {
  public:
    Shares(const std::vector<Face>& faces, const std::vector<PinTarget>& held, std::size_t count)
        : faces_(faces), share_(count, 1.0), is_held_(count, 0), faces_at_(static_cast<int>(count), faces)
    {
        for (const PinTarget& vertex : held) is_held_[vertex.vertex] = 1;
    }

    double operator[](std::size_t v) const { return share_[v]; }

    bool shrink(const std::vector<int>& unclean)
    {
        std::vector<int> patch = vertices_of(unclean);
        if (halve(patch)) return true;
        for (std::size_t size = 0; patch.size() > size;) {  // ends: the patch grows until it is the cloth
            size = patch.size();
            std::vector<int> around;
            for (const int v : patch) around.insert(around.end(), faces_at_[v].begin(), faces_at_[v].end());
            patch = vertices_of(around);
            if (halve(patch)) return true;
        }
        return false;
    }

  private:
    std::vector<int> vertices_of(const std::vector<int>& faces) const
    {
        std::vector<int> vertices;
        for (const int f : faces) vertices.insert(vertices.end(), faces_[f].begin(), faces_[f].end());
        sort_unique(vertices);
        return vertices;
    }

    bool halve(const std::vector<int>& vertices)
    {
        constexpr double kLeastShare = 0.06;
        bool is_changed = false;
        for (const int v : vertices) {
            if (is_held_[v] || share_[v] <= 0.0) continue;
            share_[v] = 0.5 * share_[v] < kLeastShare ? 0.0 : 0.5 * share_[v];
            is_changed = true;
        }
        return is_changed;
    }

    const std::vector<Face>& faces_;
    std::vector<double> share_;
    std::vector<char> is_held_;
    VertexFaces faces_at_;
};

}  // namespace

void restore_stand_off(const std::vector<Contact>& contacts, const Carriers& carriers,
                       const std::vector<double>& mobility, double growth, std::vector<Vec3>& world)
{
    constexpr double kFoldPlaneShare = 0.1;  // of the push-out: moving aside stretches straight cloth
    constexpr int kPushes = 5;               // a layer that is pushed away from another may have to come back
    const auto push_out = [&](const Contact& contact) {
        if (contact.is_squeezed()) return;
        const Vec3 point = carriers[contact.obstacle].end(contact.local_point);
        const double gap = contact.normal.dot(contact.at(world) - point);
        const double share = contact.is_fold_plane() ? kFoldPlaneShare : 1.0;
        const double wanted = contact.least_gap + (contact.may_grow ? share * growth : 0.0);
        const double missing = std::min(contact.stand_off, wanted) - gap;
        if (missing > 0.0) contact.shift(missing * contact.normal, mobility, world);
    };
    const bool has_layers = std::any_of(contacts.begin(), contacts.end(),
                                        [](const Contact& contact) { return contact.is_with_itself(); });
    for (int pass = 0; pass < (has_layers ? kPushes : 1); ++pass)
        for (const bool is_with_itself : {true, false})
            for (const Contact& contact : contacts)
                if (contact.is_with_itself() == is_with_itself) push_out(contact);
}

bool Violations::is_clean() const
{
    return contacts.empty() && self_faces.empty() &&
           std::all_of(faces.begin(), faces.end(), [](const std::vector<int>& f) { return f.empty(); });
}

Violations check_proposal(const Scene& scene, const State& state, const SelfSurface& surface,
                          const Proposal& proposal, const Prediction& prediction, Carriers& carriers)
{
    const double thickness = scene.materials.thickness();
    Violations violations;
    for (int o = 0; o < static_cast<int>(carriers.obstacles.size()); ++o) {
        Carrier& carrier = carriers.obstacles[o];
        carrier.motion.end = to_local(carrier.end, proposal.world);
        SweepReport report = check_sweep(*carrier.obstacle, carrier.motion, thickness);
        for (const ObstacleContact& found : report.violations)
            violations.contacts.push_back(place_contact(found, o, thickness, carriers, prediction));
        violations.crossings += report.crossings;
        violations.faces.push_back(std::move(report.faces));
    }
    if (!scene.self_contact) return violations;
    carriers.cloth.motion.end = proposal.world;
    SelfSweepReport report =
        check_self_sweep(surface, {state.mesh.world, proposal.world}, scene.self_contact->thickness);
    for (const SelfContact& found : report.violations)
        violations.contacts.push_back(place_contact(found, carriers, prediction));
    violations.crossings += report.crossings;
    violations.self_faces = std::move(report.faces);
    return violations;
}

std::optional<int> rewind(const Scene& scene, const State& state, const SelfSurface& surface,
                          const std::vector<PinTarget>& held, const Prediction& prediction, double dt,
                          Carriers& carriers, Proposal& proposal)
{
    constexpr int kMostRounds = 200;
    const std::vector<Vec3> wanted = proposal.world;
    const std::size_t n = wanted.size();
    const int count = static_cast<int>(carriers.obstacles.size());
    std::vector<Shares> shares(static_cast<std::size_t>(count) + 1,  // the last of the cloth itself
                               Shares(state.mesh.faces, held, n));
    std::vector<char> is_rewound(n, 0);
    for (int round = 0; round < kMostRounds; ++round) {
        const Violations violations = check_proposal(scene, state, surface, proposal, prediction, carriers);
        if (violations.is_clean())
            return static_cast<int>(std::count(is_rewound.begin(), is_rewound.end(), 1));
        for (int o = 0; o <= count; ++o) {
            const Carrier& carrier = carriers[o < count ? o : kClothItself];
            const std::vector<int>& unclean = o < count ? violations.faces[o] : violations.self_faces;
            if (unclean.empty()) continue;
            if (!shares[o].shrink(unclean)) return std::nullopt;
            for (std::size_t v = 0; v < n; ++v) {
                if (shares[o][v] >= 1.0) continue;
                const Vec3& begin = carrier.motion.begin[v];
                const Vec3 way = carrier.end.inverse(wanted[v]) - begin;
                proposal.world[v] = carrier.end(begin + shares[o][v] * way);
                proposal.velocity[v] = (proposal.world[v] - state.mesh.world[v]) / dt;
                is_rewound[v] = 1;
            }
        }
    }
    return std::nullopt;
}

}  // namespace arris
