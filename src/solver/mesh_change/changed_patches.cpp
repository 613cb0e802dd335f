// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh_change/changed_patches.h"

#include <algorithm>
#include <cassert>
#include <tuple>
#include <utility>

#include "geometry/sort_unique.h"
#include "solver/mesh_change/strain_allowance.h"

namespace arris {

namespace {

/// Place of each of `ids` in `others`, or -1; both ascend.
std::vector<int> find_places(const std::vector<std::uint32_t>& ids, const std::vector<std::uint32_t>& others)
{
    std::vector<int> places(ids.size(), -1);
    for (std::size_t i = 0, k = 0; i < ids.size(); ++i) {
        while (k < others.size() && others[k] < ids[i]) ++k;
        if (k < others.size() && others[k] == ids[i]) places[i] = static_cast<int>(k);
    }
    return places;
}

class PatchFinder {
  public:
    explicit PatchFinder(const MeshChange& change)
        : change_(change),
          before_(change.before),
          after_(change.after),
          then_(find_places(change.after.ids, change.before.ids)),
          now_(find_places(change.before.ids, change.after.ids)),
          is_eol_changed_(change.after.ids.size(), 0),
          is_near_(change.after.ids.size(), 0),
          patch_(change.after.mesh.faces.size(), -1)
    {
    }

    std::vector<ChangedPatch> find()
    {
        mark_changed();
        for (int ring = 0; ring < kPatchRings; ++ring) grow();
        join();
        for (ChangedPatch& patch : patches_) complete(patch);
        add_faces_before();
        return std::move(patches_);
    }

  private:
    /// Whether the kind of a vertex's feature has changed between its entries in State::eol, after (`now`)
    /// and before (`then`). An entry is -1 where the vertex is not EOL; not both may be.
    bool is_eol_changed(int now, int then) const
    {
        if ((now < 0) != (then < 0)) return true;
        const auto kind_of = [](const EolVertex& e) {
            return std::tuple(e.on.obstacle, e.on.kind, e.on.end);
        };
        return kind_of(after_.eol[now]) != kind_of(before_.eol[then]);
    }

    /// Vertices at which a face may have changed.
    std::vector<int> touched()
    {
        std::vector<int> vertices;
        std::vector<char> is_seen(after_.next_id, 0);  // by id: events name most vertices repeatedly
        const auto add = [&](VertexId id) {
            if (std::exchange(is_seen[id], 1) != 0) return;
            if (const int v = after_.index_of(id); v >= 0) vertices.push_back(v);
        };
        for (const SurgeryEvent& event : change_.events)
            for (const auto* faces : {&event.before, &event.after})
                for (const PatchFace& face : *faces)
                    std::for_each(face.cloth_vertices.begin(), face.cloth_vertices.end(), add);
        for (const State* state : {&before_, &after_})
            for (const EolVertex& eol : state->eol) {
                add(eol.vertex_id);
                if (const int v = after_.index_of(eol.vertex_id); v >= 0)
                    is_eol_changed_[v] =
                        is_eol_changed(after_.eol_entry(eol.vertex_id), before_.eol_entry(eol.vertex_id));
            }
        return vertices;
    }

    /// Index of the face with these vertices in this cyclic order; -1 where the mesh has no such face.
    static int find_face(const ClothMesh& mesh, const VertexFaces& faces_at, const Face& vertices)
    {
        const auto [a, b, c] = vertices;
        if (a < 0 || b < 0 || c < 0) return -1;
        for (const int f : faces_at[a]) {
            const Face& face = mesh.faces[f];
            const auto first = std::find(face.begin(), face.end(), a) - face.begin();
            if (face[(first + 1) % 3] == b && face[(first + 2) % 3] == c) return f;
        }
        return -1;
    }

    static Face map(const Face& face, const std::vector<int>& to)
    {
        return {to[face[0]], to[face[1]], to[face[2]]};
    }

    /// Whether the face existed before with unchanged material coordinates and EOL states of its vertices.
    bool is_kept(int f) const
    {
        const Face& face = after_.mesh.faces[f];
        const int before = find_face(before_.mesh, change_.faces_at_before, map(face, then_));
        if (before < 0) return false;
        return std::all_of(face.begin(), face.end(), [&](int v) {
            return before_.mesh.material[before_.mesh.point_of(then_[v], before)] ==
                       after_.mesh.material[after_.mesh.point_of(v, f)] &&
                   !is_eol_changed_[v];
        });
    }

    void mark_changed()
    {
        std::vector<char> is_seen(patch_.size(), 0);
        for (const int v : touched())
            for (const int f : change_.faces_at_after[v])
                if (std::exchange(is_seen[f], 1) == 0 && !is_kept(f)) add_vertices(f);
    }

    void add_vertices(int f)
    {
        for (const int v : after_.mesh.faces[f]) {
            if (is_near_[v]) continue;
            is_near_[v] = 1;
            near_.push_back(v);
        }
    }

    void grow()
    {
        const std::vector<int> rim = near_;
        for (const int v : rim)
            for (const int f : change_.faces_at_after[v]) add_vertices(f);
    }

    bool is_in(int f) const
    {
        const Face& face = after_.mesh.faces[f];
        return is_near_[face[0]] && is_near_[face[1]] && is_near_[face[2]];
    }

    /// Collects faces with all vertices near, and joins those that share a vertex into patches.
    void join()
    {
        std::vector<int> faces;
        std::vector<char> is_found(patch_.size(), 0);
        for (const int v : near_)
            for (const int f : change_.faces_at_after[v])
                if (is_in(f) && std::exchange(is_found[f], 1) == 0) faces.push_back(f);
        std::sort(faces.begin(), faces.end());
        for (const int first : faces) {
            if (patch_[first] >= 0) continue;
            const int p = static_cast<int>(patches_.size());
            ChangedPatch& patch = patches_.emplace_back();
            std::vector<int> open = {first};
            patch_[first] = p;
            while (!open.empty()) {
                const int f = open.back();
                open.pop_back();
                patch.faces.push_back(f);
                for (const int v : after_.mesh.faces[f])
                    for (const int g : change_.faces_at_after[v]) {
                        if (patch_[g] >= 0 || !is_in(g)) continue;
                        patch_[g] = p;
                        open.push_back(g);
                    }
            }
        }
    }

    void complete(ChangedPatch& patch) const
    {
        std::sort(patch.faces.begin(), patch.faces.end());
        for (const int f : patch.faces)
            patch.vertices.insert(patch.vertices.end(), after_.mesh.faces[f].begin(),
                                  after_.mesh.faces[f].end());
        sort_unique(patch.vertices);
        for (const int v : patch.vertices) {
            const std::span<const int> around = change_.faces_at_after[v];
            patch.is_inside.push_back(std::all_of(
                around.begin(), around.end(), [&](int f) { return patch_[f] == patch_[patch.faces[0]]; }));
        }
    }

    /// Adds to each patch its faces of the old mesh: kept faces that are in the patch, and removed faces at
    /// its vertices or at removed vertices.
    void add_faces_before()
    {
        std::vector<int> open;
        std::vector<int> patch_of(before_.ids.size(), -1);  // by old vertex
        for (std::size_t p = 0; p < patches_.size(); ++p)
            for (const int v : patches_[p].vertices)
                if (const int then = then_[v]; then >= 0) {
                    patch_of[then] = static_cast<int>(p);
                    open.push_back(then);
                }
        std::vector<char> is_seen(before_.mesh.faces.size(), 0);
        while (!open.empty()) {
            const int v = open.back();
            open.pop_back();
            assert(patch_of[v] >= 0 && "what is open is of a patch");
            for (const int f : change_.faces_at_before[v]) {
                if (is_seen[f]) continue;
                const Face& face = before_.mesh.faces[f];
                const int now = find_face(after_.mesh, change_.faces_at_after, map(face, now_));
                is_seen[f] = 1;
                if (now >= 0 && patch_[now] < 0) continue;
                patches_[now >= 0 ? patch_[now] : patch_of[v]].faces_before.push_back(f);
                for (const int w : face) {
                    if (now_[w] >= 0 || patch_of[w] >= 0) continue;
                    patch_of[w] = patch_of[v];
                    open.push_back(w);
                }
            }
        }
        for (ChangedPatch& patch : patches_) std::sort(patch.faces_before.begin(), patch.faces_before.end());
    }

    const MeshChange& change_;
    const State& before_;
    const State& after_;
    std::vector<int> then_;             ///< old index of each new vertex; -1 where it is new
    std::vector<int> now_;              ///< new index of each old vertex; -1 where it is gone
    std::vector<char> is_eol_changed_;  ///< by new vertex: whether its EOL state has changed
    std::vector<int> near_;             ///< new vertices near a change
    std::vector<char> is_near_;         ///< by new vertex: whether it is in `near_`
    std::vector<int> patch_;            ///< patch of each new face; -1 outside
    std::vector<ChangedPatch> patches_;
};

}  // namespace

std::vector<ChangedPatch> find_changed_patches(const MeshChange& change)
{
    return PatchFinder(change).find();
}

}  // namespace arris
