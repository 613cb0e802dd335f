// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh_change/patch_relaxation.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <optional>
#include <unordered_map>
#include <utility>

#include "geometry/check/sweep_check.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/cloth/sub_mesh.h"
#include "geometry/obstacle/obstacle_distance.h"
#include "geometry/self_contact/self_sweep.h"
#include "geometry/tolerances.h"
#include "physics/elements/term.h"
#include "physics/forces/energies.h"
#include "physics/forces/make_terms.h"
#include "solver/mesh_change/patch_equations.h"
#include "solver/mesh_change/strain_allowance.h"
#include "solver/model/target_length.h"

namespace arris {

namespace {

constexpr int kMostSteps = 8;

/// Terms that have an energy, and mass.
Terms make_energy_terms(const Scene& scene)
{
    return make_terms(scene.materials, scene.gravity, {}, {});
}

/// Time of each step, s. In all steps together nothing falls by more than about `kAllowedStrain` of a cell.
/// Without gravity nothing falls, and mass only holds vertices without stiffness in place.
double find_step_time(const Scene& scene)
{
    const double weight = scene.gravity ? scene.gravity->acceleration.norm() : 0.0;
    if (!(weight > 0.0) || !changes_mesh(scene)) return 1.0;
    const std::vector<double>& lengths = initial_target(scene).mean_lengths;
    const double least = *std::min_element(lengths.begin(), lengths.end());
    return std::min(1.0, std::sqrt(kAllowedStrain * least / (kMostSteps * weight)));
}

/// Creases within a part of the cloth, whose vertex i is `vertices[i]` of the whole.
Creases find_part(const Creases& creases, const std::vector<int>& vertices)
{
    Creases part{creases.widths, {}};
    if (creases.edges.empty()) return part;
    std::unordered_map<int, int> local;  // only for look-up
    for (std::size_t i = 0; i < vertices.size(); ++i) local[vertices[i]] = static_cast<int>(i);
    for (const auto& [a, b] : creases.edges) {
        const auto at_a = local.find(a), at_b = local.find(b);
        if (at_a == local.end() || at_b == local.end()) continue;
        const auto [first, second] = std::minmax(at_a->second, at_b->second);
        part.edges.push_back({first, second});
    }
    std::sort(part.edges.begin(), part.edges.end());
    return part;
}

/// The patch as a small cloth of its own, at rest.
class Relaxation {
  public:
    Relaxation(const Scene& scene, LoosePatch patch)
        : scene_(scene),
          patch_(std::move(patch)),
          terms_(make_energy_terms(scene)),
          step_time_(find_step_time(scene))
    {
        place_.assign(patch_.is_free.size(), -1);
        for (std::size_t v = 0; v < patch_.is_free.size(); ++v) {
            if (!patch_.is_free[v]) continue;
            place_[v] = static_cast<int>(free_.size());
            free_.push_back(static_cast<int>(v));
        }
        MeshTopology topology = make_topology(patch_.mesh.vertex_count(), patch_.mesh.faces);
        elements_ = list_elements(patch_.mesh, topology, HingeUse::Terms, terms_.materials);
        mark_creases(patch_.creases, patch_.mesh, elements_);
        // A coupled hinge depends on all others, so that no energy is constant.
        const ClothElements held = terms_.coupled_hinges() ? ClothElements{} : take_held();
        edges_ = std::move(topology.edges);
        held_energy_ = compute_energies(held, terms_, patch_.mesh.world).sum();
        energy_ = energy_at(patch_.mesh.world);
    }

    /// Lowers the energy to `wanted`; false once a few steps are known not to reach it. As every mode decays,
    /// a full step lowers the energy by less than the one before. The remaining steps therefore lower it by
    /// less than their number times the last decrease. Rarely they lower it by more than twice that decrease
    /// (3 of 3400 patches before a sliding box). After a shortened step the bound is a guess, which errs
    /// towards false.
    bool run(double wanted)
    {
        constexpr double kMostToCome = 2.0;  // times the last step's decrease
        for (int left = kMostSteps - 1; left >= 0 && energy_ > wanted; --left) {
            const double before = energy_;
            if (!descend(wanted)) return false;
            if (energy_ - wanted > std::min(double(left), kMostToCome) * (before - energy_)) return false;
        }
        return energy_ <= wanted;
    }

    /// Lowers the energy to `wanted`, or as far as the steps go.
    void run_on(double wanted)
    {
        for (int left = kMostSteps; left > 0 && energy_ > wanted; --left)
            if (!descend(wanted)) return;
    }

    /// Goes back along the last step to where the energy has just fallen to `wanted`: strain that the cloth
    /// had before must remain.
    void rise_to(double wanted)
    {
        if (!(energy_ < wanted) || before_last_.empty()) return;
        const std::vector<Vec3> end = std::move(patch_.mesh.world);
        const auto energy_along = [&](double share) {
            patch_.mesh.world = before_last_;
            for (std::size_t v = 0; v < end.size(); ++v)
                patch_.mesh.world[v] += share * (end[v] - before_last_[v]);
            return energy_at(patch_.mesh.world);
        };
        constexpr int kBits = 12;  // of the share
        std::uintmax_t most_evaluations = 50;
        const auto [above, below] = boost::math::tools::toms748_solve(
            [&](double share) { return energy_along(share) - wanted; }, 0.0, 1.0,
            energy_before_last_ - wanted, energy_ - wanted, boost::math::tools::eps_tolerance<double>(kBits),
            most_evaluations);
        energy_ = energy_along(below);
    }

    double energy() const { return energy_; }
    const std::vector<Vec3>& world() const { return patch_.mesh.world; }

    /// Faces that meet an obstacle on the way from `begin`.
    std::vector<int> find_met_faces(const std::vector<Vec3>& begin, double time) const
    {
        std::vector<int> met;
        for (const MovingObstacle& obstacle : scene_.obstacles) {
            const ObstaclePose pose = obstacle.at(time);
            const ClothMotion motion = {&patch_.mesh.faces, &edges_, to_local(pose.placement, begin),
                                        to_local(pose.placement, patch_.mesh.world)};
            const SweepReport swept = check_sweep(pose, motion, scene_.materials.thickness());
            met.insert(met.end(), swept.faces.begin(), swept.faces.end());
        }
        return met;
    }

    /// Moves vertices that came within the stand-off back towards `begin` by halves, at last all the way,
    /// until they are as far from the obstacles as before. Cloth that sinks in would be pushed out again.
    void keep_off(const std::vector<Vec3>& begin, double time)
    {
        for (const MovingObstacle& obstacle : scene_.obstacles) {
            const ObstaclePose pose = obstacle.at(time);
            const auto gap_at = [&](const Vec3& place) {
                return distance_to(pose, pose.placement.inverse(place), scene_.materials.thickness());
            };
            for (const int v : free_) keep_off(gap_at, begin[v], patch_.mesh.world[v]);
        }
        energy_ = energy_at(patch_.mesh.world);
    }

    void go_back_half(const std::vector<Vec3>& begin)
    {
        for (std::size_t v = 0; v < begin.size(); ++v)
            patch_.mesh.world[v] = 0.5 * (patch_.mesh.world[v] + begin[v]);
        energy_ = energy_at(patch_.mesh.world);
    }

  private:
    /// Removes the elements without a free vertex from `elements_` and returns them.
    ClothElements take_held()
    {
        ClothElements held;
        take_held(elements_.faces, held.faces);
        take_held(elements_.hinges, held.hinges);
        return held;
    }

    template <typename Element>
    void take_held(std::vector<Element>& elements, std::vector<Element>& held) const
    {
        const auto is_held = [this](const Element& element) {
            return std::all_of(element.vertices.begin(), element.vertices.end(),
                               [this](int v) { return place_[v] < 0; });
        };
        std::copy_if(elements.begin(), elements.end(), std::back_inserter(held), is_held);
        std::erase_if(elements, is_held);
    }

    template <typename Gap>
    void keep_off(const Gap& gap_at, const Vec3& begin, Vec3& place) const
    {
        constexpr int kMostHalvings = 5;
        constexpr double kRounding = 1e-3;
        if (place == begin || !(gap_at(place) < scene_.materials.thickness())) return;
        const double least = (1.0 - kRounding) * gap_at(begin);
        for (int k = 0; k < kMostHalvings && gap_at(place) < least; ++k) place = 0.5 * (place + begin);
        if (gap_at(place) < least) place = begin;
    }

    /// Takes one step from rest that lowers the energy; false where none does.
    bool descend(double wanted)
    {
        constexpr int kMostHalvings = 8;
        constexpr double kWorthwhile = 1e-3;  // of the energy still to lower
        const std::vector<Vec3> way = find_way();
        double share = 1.0;
        for (int k = 0; k < kMostHalvings; ++k, share *= 0.5) {
            std::vector<Vec3> next = patch_.mesh.world;
            for (std::size_t v = 0; v < next.size(); ++v) next[v] += share * way[v];
            const double reached = energy_at(next);
            if (!(reached < energy_ - kWorthwhile * (energy_ - wanted))) continue;
            before_last_ = std::exchange(patch_.mesh.world, std::move(next));
            energy_before_last_ = std::exchange(energy_, reached);
            return true;
        }
        return false;
    }

    double energy_at(const std::vector<Vec3>& world) const
    {
        return held_energy_ + compute_energies(elements_, terms_, world).sum();
    }

    std::vector<Vec3> find_way()
    {
        std::vector<Vec3> way(patch_.mesh.world.size(), Vec3::Zero());
        if (free_.empty()) return way;
        if (!equations_) equations_.emplace(place_, free_, step_time_);  // many patches never move
        const auto found = equations_->find_way(patch_.mesh, elements_, terms_, patch_.normals);
        if (!found) return way;
        for (std::size_t k = 0; k < free_.size(); ++k)
            way[free_[k]] = found->segment<3>(static_cast<Eigen::Index>(3 * k));
        return way;
    }

    const Scene& scene_;
    LoosePatch patch_;
    std::vector<int> free_;   ///< vertices, ascending
    std::vector<int> place_;  ///< place of each vertex in `free_`; -1 where it is held
    std::vector<MeshEdge> edges_;
    ClothElements elements_;  ///< with a free vertex, and invalid face indices of hinges; or all elements
    Terms terms_;
    double step_time_;                 ///< s
    double held_energy_ = 0.0;         ///< J, of elements without a free vertex
    double energy_ = 0.0;              ///< J, at the current positions
    std::vector<Vec3> before_last_;    ///< positions before the last step
    double energy_before_last_ = 0.0;  ///< J, at these positions
    std::optional<PatchEquations> equations_;
};

/// Whether vertices of the state can move from `begin` to `end` without meeting the rest of the cloth. Only
/// the cloth near them is looked at.
bool is_way_free_of_cloth(const Scene& scene, const State& state, const std::vector<int>& vertices,
                          const std::vector<Vec3>& begin, const std::vector<Vec3>& end)
{
    if (!scene.self_contact) return true;
    std::vector<Vec3> world = state.mesh.world;
    for (std::size_t i = 0; i < vertices.size(); ++i) world[vertices[i]] += end[i] - begin[i];
    std::vector<char> is_moved(world.size(), 0);
    for (std::size_t v = 0; v < world.size(); ++v) is_moved[v] = world[v] != state.mesh.world[v];
    std::vector<BoxTree::Box> boxes;
    BoxTree::Box reach;
    for (const Face& face : state.mesh.faces) {
        BoxTree::Box& box = boxes.emplace_back();
        for (const int v : face) box.extend(state.mesh.world[v]).extend(world[v]);
        if (is_moved[face[0]] || is_moved[face[1]] || is_moved[face[2]]) reach.extend(box);
    }
    std::vector<int> near;
    for (std::size_t f = 0; f < boxes.size(); ++f)
        if (boxes[f].intersects(reach)) near.push_back(static_cast<int>(f));
    const SubMesh part = extract_faces(state.mesh, near);
    std::vector<Vec3> part_end;
    for (const int v : part.vertices) part_end.push_back(world[v]);
    const int n = part.mesh.vertex_count();
    const SelfSurface surface(n, part.mesh.faces, make_topology(n, part.mesh.faces));
    return check_self_sweep(surface, {part.mesh.world, part_end}, scene.self_contact->thickness).is_clean();
}

}  // namespace

namespace {

/// Calls visit(contact) for the vertex's own contacts with obstacles that pressed at the end of the last
/// step.
template <typename Visit>
void visit_contacts(const State& state, std::uint32_t vertex_id, const Visit& visit)
{
    auto contact = std::lower_bound(
        state.active.begin(), state.active.end(), vertex_id,
        [](const ActiveContact& active, std::uint32_t id) { return active.vertex_ids[0] < id; });
    for (; contact != state.active.end() && contact->vertex_ids[0] == vertex_id; ++contact)
        if (contact->kind == ContactKind::Vertex && contact->obstacle != kClothItself) visit(*contact);
}

}  // namespace

Vec3 find_kept_normal(const Scene& scene, const State& state, std::uint32_t vertex_id)
{
    Vec3 normal = Vec3::Zero();
    visit_contacts(state, vertex_id, [&](const ActiveContact& contact) {
        normal = scene.obstacles[contact.obstacle].at(state.time).placement.rotation * contact.normal;
    });
    return normal;
}

bool is_stuck(const State& state, std::uint32_t vertex_id)
{
    bool is_stuck = false;
    visit_contacts(state, vertex_id, [&](const ActiveContact& contact) {
        is_stuck |= contact.friction.budget > 0.0 && contact.friction.slip.isZero(0.0);
    });
    return is_stuck;
}

double relax(const Scene& scene, const Creases& creases, const RelaxedPatch& patch, State& state)
{
    constexpr int kMostRetreats = 4;
    SubMesh part = extract_faces(state.mesh, patch.faces);
    LoosePatch loose{std::move(part.mesh), {}, {}, find_part(creases, part.vertices)};
    for (const int v : part.vertices) {
        loose.is_free.push_back(patch.is_free[v]);
        loose.normals.push_back(patch.normals[v]);
    }
    const std::vector<Vec3> begin = loose.mesh.world;
    for (int k = 0; k < kMostRetreats; ++k) {
        Relaxation relaxation(scene, loose);
        const double before = relaxation.energy();
        if (before - patch.wanted <= kAccumulated * std::abs(patch.wanted)) return before;
        relaxation.run_on(patch.wanted);
        relaxation.rise_to(patch.wanted);
        relaxation.keep_off(begin, state.time);
        if (!(relaxation.energy() < before)) return before;
        std::vector<int> met = relaxation.find_met_faces(begin, state.time);
        // Faces that meet an obstacle stay where they are, and the others give way once more.
        for (const int f : met)
            for (const int v : loose.mesh.faces[f]) loose.is_free[v] = 0;
        if (!met.empty()) continue;
        for (int halvings = 0; !is_way_free_of_cloth(scene, state, part.vertices, begin, relaxation.world());
             ++halvings) {
            if (halvings == kMostRetreats) return before;
            relaxation.go_back_half(begin);
        }
        for (std::size_t i = 0; i < begin.size(); ++i) {
            const Vec3 moved = relaxation.world()[i] - begin[i];
            state.mesh.world[part.vertices[i]] += moved;
            state.previous_world[part.vertices[i]] += moved;
        }
        return relaxation.energy();
    }
    return find_patch_energy(scene, creases, state.mesh, patch.faces);
}

bool can_relax_by(const Scene& scene, const LoosePatch& patch, double drop)
{
    Relaxation relaxation(scene, patch);
    const double wanted = relaxation.energy() - drop;
    return relaxation.run(wanted);
}

Energies find_energies(const Scene& scene, const Creases& creases, const ClothMesh& mesh)
{
    ClothElements elements =
        list_elements(mesh, make_topology(mesh.vertex_count(), mesh.faces), HingeUse::Terms, scene.materials);
    mark_creases(creases, mesh, elements);
    return compute_energies(elements, make_energy_terms(scene), mesh.world);
}

double find_patch_energy(const Scene& scene, const Creases& creases, const ClothMesh& mesh)
{
    return find_energies(scene, creases, mesh).sum();
}

double find_patch_energy(const Scene& scene, const Creases& creases, const ClothMesh& cloth,
                         const std::vector<int>& faces)
{
    const SubMesh part = extract_faces(cloth, faces);
    return find_patch_energy(scene, find_part(creases, part.vertices), part.mesh);
}

}  // namespace arris
