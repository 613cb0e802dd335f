// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "geometry/cloth/cloth_mesh.h"
#include "geometry/contact/obstacle_contact.h"
#include "geometry/obstacle/surface_ride.h"
#include "solver/model/feature_id.h"
#include "solver/model/sewing.h"

namespace arris {

/// Friction at a contact that presses, in the obstacle's frame. At an EOL vertex: components along the
/// feature and across, at corners in the material. The force tells how far the contact's spring is strained
/// (velocity_solve/slip_law.h).
struct ContactFriction {
    Vec3 force = Vec3::Zero();  ///< N
    Vec3 slip = Vec3::Zero();   ///< m/s; zero where it sticks
    double budget = 0.0;        ///< N, greatest force
};

/// Ids of a contact's vertices, at most four; the last ones are kNoVertex where there are fewer.
struct ContactVertexIds : std::array<std::uint32_t, 4> {
    static constexpr std::uint32_t kNoVertex = 0xffffffffu;

    ContactVertexIds(std::initializer_list<std::uint32_t> ids = {})
    {
        fill(kNoVertex);
        std::copy(ids.begin(), ids.end(), begin());
    }
};

/// A contact that pressed at the end of a step, with its multiplier. The next solve starts from it, and the
/// next search tests it again.
struct ActiveContact {
    ContactVertexIds vertex_ids;  ///< as Contact's vertices
    ContactKind kind;
    std::int32_t obstacle;  ///< index in the scene, or kClothItself
    std::int32_t element;   ///< as ObstacleContact's
    Vec3 normal;            ///< in the obstacle's frame
    double multiplier;      ///< N s
    ContactFriction friction = {};
    bool is_squeezed =
        false;  ///< the cloth is squeezed there, or at its least thickness (contact/squeezed.h)
};

/// A vertex on a sharp feature of an obstacle, through which the material flows (Eulerian on Lagrangian).
struct EolVertex {
    std::uint32_t vertex_id;
    FeatureId on;
    Vec3 outward;            ///< unit, from the feature, in the obstacle's frame
    std::int32_t idle;       ///< consecutive steps at whose end it did not press
    std::int32_t side = 0;   ///< at a wire or point: 1 if the normals of the cloth's faces point outward, -1
                             ///< if inward, 0 if unknown
    double gathering = 0.0;  ///< growth of a pleat along the feature (sites/gathering.h)
    Vec3 force = Vec3::Zero();  ///< N, of the feature on it in the last step, in the world; for readers alone
};

/// A vertex that a pin has taken hold of, and the point that the pin's placement maps to the vertex's target.
struct PinAnchor {
    std::uint32_t pin;  ///< index in the scene
    std::uint32_t vertex_id;
    Vec3 origin;           ///< m; x(0) where the pin holds from time 0
    SurfacePlace on = {};  ///< of the obstacle that the pin follows, where that deforms
};

/// An edge of the mesh that remeshing has tried to split or merge, and that was refused.
struct RefusedEdge {
    std::array<std::uint32_t, 2> vertex_ids;  ///< ascending
    std::int32_t refusals = 0;                ///< at least 1
    std::int64_t until = 0;                   ///< step before which it is not tried again
};

/// Exactly the data that a resumed run needs, and nothing that could be computed from them.
struct State {
    double time = 0.0;      ///< s
    std::int64_t step = 0;  ///< planned steps made
    ClothMesh mesh;
    std::vector<std::uint32_t> ids;       ///< persistent, one a vertex, ascending
    std::vector<std::uint32_t> seam_ids;  ///< of the mesh's further points, ascending; unlike `ids`
    std::uint32_t next_id = 0;
    std::vector<Vec3> velocity;  ///< v_k, m/s
    /// V_k, m/s, of each point of the material: velocity of X; zero except at EOL vertices.
    std::vector<Vec2> material_velocity;

    // One step back, for BDF2; meaningless where `previous_dt` is 0 (first step, after a jump of the input).
    double previous_dt = 0.0;  ///< s
    std::vector<Vec3> previous_world;
    std::vector<Vec3> previous_velocity;
    std::vector<Vec2> previous_material;
    std::vector<Vec2> previous_material_velocity;

    std::vector<EolVertex> eol;         ///< ascending by vertex_id
    std::vector<PinAnchor> anchors;     ///< ascending by (pin, vertex_id), of pins that hold
    std::vector<ActiveContact> active;  ///< ascending by (vertex_ids, obstacle, kind, element)
    /// Pairs of vertices that contacts of the cloth with itself couple in the matrix, ascending: they decide
    /// the order of elimination, and so the last bits of a step.
    std::vector<std::array<int, 2>> coupled;
    /// Target edge lengths at the nodes of the scene's remeshing grid, m; empty without remeshing.
    std::vector<float> sizing_field;
    std::vector<RefusedEdge> refused_edges;  ///< ascending by vertex_ids
    std::vector<SeamPair> seam_pairs;        ///< of seams that are not welded, in the order of the scene's
    Closing closing;
    double sewn_at = std::numeric_limits<double>::infinity();  ///< s, when the last seam was closed
    double sewn_energy = 0.0;                                  ///< J, that welding has taken out so far
    std::int64_t crossings = 0;                                ///< passages through obstacles so far

    /// Index of the vertex with this id; -1 without such a vertex.
    int index_of(std::uint32_t id) const { return find_place(ids, id); }

    /// Index of the point of the material with this id; -1 without such a point.
    int point_with(std::uint32_t id) const
    {
        const int vertex = index_of(id);
        if (vertex >= 0 || seam_ids.empty()) return vertex;
        const int further = find_place(seam_ids, id);
        return further < 0 ? -1 : mesh.vertex_count() + further;
    }

    /// Entry in `eol` of the vertex with this id; -1 where it is not EOL.
    int eol_entry(std::uint32_t id) const
    {
        const auto found = std::lower_bound(
            eol.begin(), eol.end(), id, [](const EolVertex& e, std::uint32_t i) { return e.vertex_id < i; });
        return found != eol.end() && found->vertex_id == id ? static_cast<int>(found - eol.begin()) : -1;
    }

  private:
    static int find_place(const std::vector<std::uint32_t>& ascending, std::uint32_t id)
    {
        const auto found = std::lower_bound(ascending.begin(), ascending.end(), id);
        return found != ascending.end() && *found == id ? static_cast<int>(found - ascending.begin()) : -1;
    }
};

}  // namespace arris
