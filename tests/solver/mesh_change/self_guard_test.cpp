// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh_change/self_guard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/self_contact/self_intersection.h"

namespace arris {
namespace {

/// Faces of the cloth as the operations leave it, by brute force.
class LiveFaces {
  public:
    explicit LiveFaces(const State& state) : world_(state.mesh.world), faces_(state.mesh.faces) {}

    /// Whether moving vertex v to `place` makes any face around it cross the cloth.
    bool crosses(int v, const Vec3& place) const
    {
        std::vector<Vec3> world = world_;
        world[v] = place;
        std::vector<int> around;
        for (std::size_t f = 0; f < faces_.size(); ++f)
            if (std::find(faces_[f].begin(), faces_[f].end(), v) != faces_[f].end())
                around.push_back(static_cast<int>(f));
        return !find_self_intersections(world, faces_, around).empty();
    }

    SurgeryEvent event_of_move(int v, const Vec3& place) const
    {
        SurgeryEvent event;
        event.operation = SurgeryOperation::Move;
        for (const Face& face : faces_) {
            if (std::find(face.begin(), face.end(), v) == face.end()) continue;
            PatchFace before;
            for (int i = 0; i < 3; ++i) {
                before.vertices[i] = before.cloth_vertices[i] = static_cast<VertexId>(face[i]);
                before.world[i] = world_[face[i]];
                before.material[i] = Vec2::Zero();
            }
            PatchFace after = before;
            for (int i = 0; i < 3; ++i)
                if (face[i] == v) after.world[i] = place;
            event.before.push_back(before);
            event.after.push_back(after);
        }
        return event;
    }

    void move(int v, const Vec3& place) { world_[v] = place; }

  private:
    std::vector<Vec3> world_;
    std::vector<Face> faces_;
};

TEST(SelfGuard, AllowsWhatCrossesNothingHoweverManyOperationsCameBefore)
{
    ClothGrid grid;
    grid.resolution = {5, 5};
    State state;
    state.mesh = make_cloth_grid(grid);
    const int layer = state.mesh.vertex_count();
    for (const Face& f : std::vector<Face>(state.mesh.faces))
        state.mesh.faces.push_back({f[0] + layer, f[1] + layer, f[2] + layer});
    for (int v = 0; v < layer; ++v) {
        const Vec2 at = state.mesh.material[v];
        state.mesh.material.push_back(at + Vec2(2.0, 0.0));
        state.mesh.world[v] = {at.x(), at.y(), 0.0};
        state.mesh.world.push_back({at.x(), at.y(), 0.1});
    }
    for (int v = 0; v < 2 * layer; ++v) state.ids.push_back(static_cast<std::uint32_t>(v));

    LiveFaces faces(state);
    SelfGuard guard(state);
    std::vector<SurgeryEvent> events;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> height(-0.15, 0.25);
    int refused = 0;
    for (int k = 0; k < 600; ++k) {
        const int v = static_cast<int>(random() % (2 * layer));
        Vec3 place = state.mesh.world[v];
        place.z() = height(random);
        const SurgeryEvent event = faces.event_of_move(v, place);
        const bool is_allowed = guard.allows(event, events);
        ASSERT_EQ(is_allowed, !faces.crosses(v, place)) << k;
        refused += !is_allowed;
        if (!is_allowed) continue;
        faces.move(v, place);
        events.push_back(event);
    }
    EXPECT_GT(refused, 100);
    EXPECT_GT(events.size(), 100u);
}

}  // namespace
}  // namespace arris
