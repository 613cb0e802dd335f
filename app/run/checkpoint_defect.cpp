// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/checkpoint_defect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "app/files/keyframe_stream.h"
#include "geometry/cloth/mesh_topology.h"

namespace arris {

namespace {

bool is_finite(const ActiveContact& contact)
{
    const ContactFriction& friction = contact.friction;
    return contact.normal.allFinite() && std::isfinite(contact.multiplier) && friction.force.allFinite() &&
           friction.slip.allFinite() && friction.budget >= 0.0 && std::isfinite(friction.budget);
}

/// Describes the first invalid contact on vertices `ids`; empty if there is none.
std::string find_defect(const std::vector<ActiveContact>& contacts, const std::vector<std::uint32_t>& ids)
{
    const auto order = [](const ActiveContact& contact) {
        return std::tuple(contact.vertex_ids, contact.obstacle, contact.kind, contact.element);
    };
    for (std::size_t k = 0; k < contacts.size(); ++k) {
        const ActiveContact& contact = contacts[k];
        if (k > 0 && !(order(contacts[k - 1]) < order(contact))) return "contacts are not in ascending order";
        if (!is_finite(contact)) return fmt::format("contact {} is not finite", k);
        if (contact.kind < ContactKind::Vertex || contact.kind > ContactKind::Triangle)
            return fmt::format("contact {} has an unknown kind", k);
        const auto is_known = [&](std::uint32_t id) {
            return std::binary_search(ids.begin(), ids.end(), id);
        };
        for (std::size_t i = 0; i < contact.vertex_ids.size(); ++i) {
            const bool may_be_missing = i > 0 && contact.obstacle != kClothItself;
            const bool is_missing = contact.vertex_ids[i] == ContactVertexIds::kNoVertex;
            if (is_missing ? !may_be_missing : !is_known(contact.vertex_ids[i]))
                return fmt::format("contact {} refers to an unknown vertex", k);
        }
    }
    return {};
}

/// Describes the first invalid EOL vertex; empty if there is none.
std::string find_defect(const std::vector<EolVertex>& eol, const std::vector<std::uint32_t>& ids)
{
    for (std::size_t k = 0; k < eol.size(); ++k) {
        if (k > 0 && eol[k].vertex_id <= eol[k - 1].vertex_id)
            return "EOL vertices are not in ascending order";
        const FeatureId& on = eol[k].on;
        const bool is_kind = on.kind >= FeatureId::Kind::Edge && on.kind <= FeatureId::Kind::Bend;
        const bool is_end_sound = on.is_bend() ? on.end == 0 || on.end == 1 : on.end == -1;
        if (!eol[k].outward.allFinite() || !eol[k].force.allFinite() || !(eol[k].gathering >= 0.0) ||
            !std::isfinite(eol[k].gathering) || eol[k].idle < 0 || std::abs(eol[k].side) > 1 || !is_kind ||
            !is_end_sound)
            return fmt::format("EOL vertex {} has an invalid value", k);
        if (!std::binary_search(ids.begin(), ids.end(), eol[k].vertex_id))
            return fmt::format("EOL vertex {} refers to an unknown vertex", k);
    }
    return {};
}

/// Describes the first invalid edge that remeshing was refused; empty if there is none.
std::string find_defect(const std::vector<RefusedEdge>& edges, const std::vector<std::uint32_t>& ids)
{
    for (std::size_t k = 0; k < edges.size(); ++k) {
        const auto& [a, b] = edges[k].vertex_ids;
        if (k > 0 && edges[k].vertex_ids <= edges[k - 1].vertex_ids)
            return "refused edges are not in ascending order";
        if (!(a < b) || edges[k].refusals < 1 || edges[k].until < 0)
            return fmt::format("refused edge {} has an invalid value", k);
        if (!std::binary_search(ids.begin(), ids.end(), a) || !std::binary_search(ids.begin(), ids.end(), b))
            return fmt::format("refused edge {} refers to an unknown vertex", k);
    }
    return {};
}

/// Describes the first invalid pair of a seam, or label; empty if there is none.
std::string find_sewing_defect(const Checkpoint& checkpoint)
{
    const State& state = checkpoint.state;
    const auto is_known = [&](std::uint32_t id) {
        return std::binary_search(state.ids.begin(), state.ids.end(), id);
    };
    for (std::size_t k = 0; k < state.seam_pairs.size(); ++k) {
        const SeamPair& pair = state.seam_pairs[k];
        if (!is_known(pair.vertex_ids[0]) || !is_known(pair.vertex_ids[1]) ||
            pair.vertex_ids[0] == pair.vertex_ids[1] || pair.seam < 0 ||
            pair.seam >= static_cast<std::int32_t>(checkpoint.seams.size()) || !(pair.gap >= 0.0) ||
            !std::isfinite(pair.gap))
            return fmt::format("pair {} of seams is invalid", k);
    }
    const Closing& closing = state.closing;
    if (!std::isfinite(closing.begin) || !std::isfinite(closing.end) || closing.end < closing.begin ||
        std::isnan(state.sewn_at) || !(checkpoint.assembly_duration >= 0.0) ||
        !std::isfinite(checkpoint.assembly_duration) || !std::isfinite(state.sewn_energy))
        return "the times of seams are invalid";
    for (std::size_t k = 0; k < checkpoint.labels.size(); ++k)
        for (const auto& line : checkpoint.labels[k].lines)
            if (!line[0].allFinite() || !line[1].allFinite()) return fmt::format("label {} is not finite", k);
    return {};
}

bool is_sound(const GivenMotion& given)
{
    const std::vector<Keyframe>& keys = given.keyframes;
    return given.mover.index >= 0 && (given.is_driven || !keys.empty()) && given.velocity.allFinite() &&
           given.angular_velocity.allFinite() && given.pivot.allFinite() && std::isfinite(given.pivot_time) &&
           given.last_velocity.allFinite() && given.last_turn.allFinite() && are_sound(keys) &&
           std::all_of(keys.begin(), keys.end(),
                       [](const Keyframe& key) { return std::abs(key.rotate.norm() - 1.0) < 1e-6; });
}

}  // namespace

std::string find_defect(const Checkpoint& checkpoint)
{
    const State& state = checkpoint.state;
    const std::size_t n = state.mesh.world.size();
    const std::size_t points = n + state.mesh.seam_vertices.size();
    if (state.ids.size() != n || state.velocity.size() != n || state.previous_world.size() != n ||
        state.previous_velocity.size() != n || state.seam_ids.size() != state.mesh.seam_vertices.size() ||
        state.mesh.material.size() != points || state.material_velocity.size() != points ||
        state.previous_material.size() != points || state.previous_material_velocity.size() != points)
        return "its arrays differ in length";
    for (std::size_t v = 1; v < n; ++v)
        if (state.ids[v] <= state.ids[v - 1]) return "vertex ids are not in ascending order";
    for (std::size_t k = 1; k < state.seam_ids.size(); ++k)
        if (state.seam_ids[k] <= state.seam_ids[k - 1])
            return "ids of seams' points are not in ascending order";
    for (std::size_t v = 0; v < n; ++v)
        if (!state.velocity[v].allFinite() || !state.previous_world[v].allFinite() ||
            !state.previous_velocity[v].allFinite())
            return fmt::format("vertex {} is not finite", v);
    for (std::size_t p = 0; p < state.mesh.material.size(); ++p)
        if (!state.previous_material[p].allFinite() || !state.material_velocity[p].allFinite() ||
            !state.previous_material_velocity[p].allFinite())
            return fmt::format("point {} of the material is not finite", p);
    if (const std::string defect = find_defect(state.active, state.ids); !defect.empty()) return defect;
    for (std::size_t k = 0; k < state.coupled.size(); ++k) {
        const auto& [v, w] = state.coupled[k];
        if (v < 0 || v >= w || w >= static_cast<int>(n) ||
            (k > 0 && state.coupled[k] <= state.coupled[k - 1]))
            return fmt::format("coupled pair {} is invalid", k);
    }
    if (const std::string defect = find_defect(state.eol, state.ids); !defect.empty()) return defect;
    for (std::size_t k = 0; k < state.anchors.size(); ++k) {
        const PinAnchor& anchor = state.anchors[k];
        const std::array<double, 3>& weights = anchor.on.weights;
        const bool is_finite =
            anchor.origin.allFinite() &&
            std::all_of(weights.begin(), weights.end(), [](double weight) { return std::isfinite(weight); });
        if (!is_finite) return fmt::format("anchor {} is not finite", k);
        if (!std::binary_search(state.ids.begin(), state.ids.end(), anchor.vertex_id))
            return fmt::format("anchor {} refers to an unknown vertex", k);
        if (k > 0 && std::pair(anchor.pin, anchor.vertex_id) <=
                         std::pair(state.anchors[k - 1].pin, state.anchors[k - 1].vertex_id))
            return "anchors are not in ascending order";
    }
    for (std::size_t k = 0; k < state.sizing_field.size(); ++k)
        if (!(state.sizing_field[k] > 0.0f) || !std::isfinite(state.sizing_field[k]))
            return fmt::format("cell length {} is not positive", k);
    if (const std::string defect = find_defect(state.refused_edges, state.ids); !defect.empty())
        return defect;
    if (const std::string defect = find_sewing_defect(checkpoint); !defect.empty()) return defect;
    if (!std::isfinite(state.time) || !(state.previous_dt >= 0.0) ||
        !std::isfinite(checkpoint.position.begin) || !(checkpoint.gamma >= 0.0) ||
        checkpoint.position.begin < 0.0 || checkpoint.position.done < 0 || checkpoint.frames < 0 ||
        checkpoint.rows < 1 || checkpoint.touching_rows < 0 || checkpoint.strain.plane_rows < 0 ||
        state.crossings < 0)
        return "a time or a count is invalid";
    for (std::size_t i = 0; i < checkpoint.pieces.size(); ++i) {
        const ClothPiece& piece = checkpoint.pieces[i];
        const bool is_first = i == 0, is_last = i + 1 == checkpoint.pieces.size();
        if (!std::isfinite(piece.shift) || std::isfinite(piece.begin) == is_first ||
            std::isfinite(piece.end) == is_last || !(piece.begin < piece.end) ||
            (!is_last && piece.end != checkpoint.pieces[i + 1].begin))
            return fmt::format("piece {} has no place", i);
        if (std::any_of(piece.file_vertices.begin(), piece.file_vertices.end(), [](int v) { return v < -1; }))
            return fmt::format("piece {} has an invalid vertex of its file", i);
    }
    for (std::size_t i = 0; i < checkpoint.given.size(); ++i)
        if (!is_sound(checkpoint.given[i])) return fmt::format("given motion {} is invalid", i);
    const FrictionPeak& friction = checkpoint.friction;
    if (!std::isfinite(friction.residual) || !std::isfinite(friction.time) || !friction.world.allFinite() ||
        friction.rows < 0)
        return "the friction's peak is not valid";
    for (const StrainPeak* peak :
         {&checkpoint.strain.stretch, &checkpoint.strain.compression, &checkpoint.strain.in_plane,
          &checkpoint.strain.last_stretch, &checkpoint.strain.last_compression})
        if (!std::isfinite(peak->strain) || !std::isfinite(peak->time) || !peak->world.allFinite() ||
            !peak->material.allFinite())
            return "a strain is not finite";
    return validate(state.mesh);
}

}  // namespace arris
