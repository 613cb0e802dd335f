// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh_change/self_guard.h"

#include <algorithm>

#include "geometry/from_least.h"
#include "geometry/self_contact/self_intersection.h"

namespace arris {

namespace {

BoxTree::Box box_of(const PatchFace& face)
{
    BoxTree::Box box;
    for (const Vec3& x : face.world) box.extend(x);
    return box;
}

bool is_crossing(const PatchFace& first, const PatchFace& second)
{
    std::vector<Vec3> positions(first.world.begin(), first.world.end());
    Face other;
    for (int i = 0; i < 3; ++i) {
        const IdFace& corners = first.cloth_vertices;
        const auto shared = std::find(corners.begin(), corners.end(), second.cloth_vertices[i]);
        other[i] = static_cast<int>(shared != corners.end() ? shared - corners.begin()
                                                            : static_cast<std::ptrdiff_t>(positions.size()));
        if (shared == corners.end()) positions.push_back(second.world[i]);
    }
    return arris::is_crossing(positions, Face{0, 1, 2}, other);
}

}  // namespace

SelfGuard::SelfGuard(const State& state)
{
    for (const Face& face : state.mesh.faces) {
        PatchFace made;
        for (int i = 0; i < 3; ++i) {
            made.cloth_vertices[i] = state.ids[face[i]];
            made.world[i] = state.mesh.world[face[i]];
        }
        add(made);
    }
    group_parts();
}

void SelfGuard::add(const PatchFace& face)
{
    index_of_[from_least(face.cloth_vertices)] = static_cast<int>(parts_.size());
    parts_.push_back({face, box_of(face)});
}

void SelfGuard::follow(const std::vector<SurgeryEvent>& events)
{
    for (; followed_ < events.size(); ++followed_) {
        for (const PatchFace& face : events[followed_].before)
            if (const auto known = index_of_.find(from_least(face.cloth_vertices));
                known != index_of_.end()) {
                parts_[known->second].is_there = false;
                index_of_.erase(known);
            }
        for (const PatchFace& face : events[followed_].after) add(face);
    }
    group_parts();
}

/// Puts new parts into a tree, together with groups that are no larger: each part enters log n trees (Bentley
/// and Saxe 1980, "Decomposable searching problems").
void SelfGuard::group_parts()
{
    constexpr std::size_t kFew = 32;  // parts that are faster without a tree
    if (parts_.size() < grouped_ + kFew) return;
    std::size_t first = grouped_;
    for (; !groups_.empty() && groups_.back().count <= parts_.size() - first; groups_.pop_back())
        first = groups_.back().first;
    std::vector<BoxTree::Box> boxes;
    for (std::size_t p = first; p < parts_.size(); ++p) boxes.push_back(parts_[p].box);
    groups_.push_back({first, boxes.size(), BoxTree(boxes)});
    grouped_ = parts_.size();
}

bool SelfGuard::crosses(const PatchFace& made, const SurgeryEvent& event)
{
    const BoxTree::Box box = box_of(made);
    const auto meets = [&](const Part& part) {
        if (!part.is_there || !part.box.intersects(box)) return false;
        const IdFace face = from_least(part.face.cloth_vertices);
        const bool is_replaced =
            std::any_of(event.before.begin(), event.before.end(),
                        [&](const PatchFace& old) { return from_least(old.cloth_vertices) == face; });
        return !is_replaced && is_crossing(made, part.face);
    };
    for (const Group& group : groups_) {
        group.tree.find(box, found_);
        if (std::any_of(found_.begin(), found_.end(), [&](int p) { return meets(parts_[group.first + p]); }))
            return true;
    }
    return std::any_of(parts_.begin() + static_cast<std::ptrdiff_t>(grouped_), parts_.end(), meets);
}

bool SelfGuard::allows(const SurgeryEvent& event, const std::vector<SurgeryEvent>& events)
{
    if (event.operation == SurgeryOperation::SplitEdge || event.operation == SurgeryOperation::SplitFace)
        return true;
    follow(events);
    for (std::size_t i = 0; i < event.after.size(); ++i) {
        if (crosses(event.after[i], event)) return false;
        for (std::size_t j = i + 1; j < event.after.size(); ++j)
            if (is_crossing(event.after[i], event.after[j])) return false;
    }
    return true;
}

}  // namespace arris
