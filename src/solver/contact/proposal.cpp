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

void restore_stand_off(const std::vector<Contact>& contacts, const std::vector<ObstacleStep>& steps,
                       double thickness, double growth, Proposal& proposal)
{
    constexpr double kFoldShare = 0.1;  // of the push-out: moving aside stretches straight cloth
    for (const Contact& contact : contacts) {
        const ObstacleContact& local = contact.in_frame;
        const double gap =
            contact.normal.dot(local.at(proposal.world) - steps[contact.obstacle].end(local.point));
        const double share = contact.is_fold() ? kFoldShare : 1.0;
        const double wanted = local.least_gap + (contact.may_grow ? share * growth : 0.0);
        const double missing = std::min(contact.mitre * thickness, wanted) - gap;
        if (missing > 0.0) local.shift(missing * contact.normal, proposal.world);
    }
}

bool Violations::is_clean() const
{
    return self_faces.empty() &&
           std::all_of(faces.begin(), faces.end(), [](const std::vector<int>& f) { return f.empty(); });
}

Violations check_proposal(const Scene& scene, const State& state, const SelfSurface& surface,
                          const Proposal& proposal, const Prediction& prediction,
                          std::vector<ObstacleStep>& steps)
{
    Violations violations;
    for (std::size_t o = 0; o < steps.size(); ++o) {
        ObstacleStep& step = steps[o];
        step.motion.end = to_frame(step.end, proposal.world);
        SweepReport report = check_sweep(scene.obstacles[o], step.motion, scene.material.thickness);
        for (const ObstacleContact& contact : report.violations)
            violations.contacts.push_back(place_contact(contact, static_cast<int>(o), step, prediction));
        violations.crossings += report.crossings;
        violations.faces.push_back(std::move(report.faces));
    }
    if (!scene.self_contact) return violations;
    SelfSweepReport report =
        check_self_sweep(surface, {state.mesh.world, proposal.world}, scene.self_contact->thickness);
    for (const SelfContact& contact : report.violations)
        violations.self_rows.push_back(make_self_row(state, contact));
    violations.crossings += report.crossings;
    violations.self_faces = std::move(report.faces);
    return violations;
}

std::optional<int> rewind(const Scene& scene, const State& state, const SelfSurface& surface,
                          const std::vector<PinTarget>& held, const Prediction& prediction, double dt,
                          std::vector<ObstacleStep>& steps, Proposal& proposal)
{
    constexpr int kMostRounds = 200;
    const std::vector<Vec3> wanted = proposal.world;
    const std::size_t n = wanted.size();
    const std::size_t carriers = steps.size() + 1;  // the obstacles, then the world
    std::vector<Shares> shares(carriers, Shares(state.mesh.faces, held, n));
    std::vector<char> is_rewound(n, 0);
    for (int round = 0; round < kMostRounds; ++round) {
        const Violations violations = check_proposal(scene, state, surface, proposal, prediction, steps);
        if (violations.is_clean())
            return static_cast<int>(std::count(is_rewound.begin(), is_rewound.end(), 1));
        for (std::size_t o = 0; o < carriers; ++o) {
            const bool is_world = o == steps.size();
            const std::vector<int>& unclean = is_world ? violations.self_faces : violations.faces[o];
            if (unclean.empty()) continue;
            if (!shares[o].shrink(unclean)) return std::nullopt;
            const Placement end = is_world ? Placement{} : steps[o].end;
            for (std::size_t v = 0; v < n; ++v) {
                if (shares[o][v] >= 1.0) continue;
                const Vec3& begin = is_world ? state.mesh.world[v] : steps[o].motion.begin[v];
                const Vec3 way = end.inverse(wanted[v]) - begin;
                proposal.world[v] = end(begin + shares[o][v] * way);
                proposal.velocity[v] = (proposal.world[v] - state.mesh.world[v]) / dt;
                is_rewound[v] = 1;
            }
        }
    }
    return std::nullopt;
}

}  // namespace arris
