// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <vector>

#include "geometry/box_tree.h"
#include "geometry/surgery/cloth_surgery.h"
#include "solver/model/state.h"

namespace arris {

/// Guards mesh surgery against parts of the cloth that pass through each other. The faces that an operation
/// replaces and those that it makes have a common border. So what is between them on no side reaches out
/// through the new faces, which must not cross any other face of the cloth.
class SelfGuard {
  public:
    explicit SelfGuard(const State& state);

    /// `events`: the operations made so far, in order; calls continue the list.
    bool allows(const SurgeryEvent& event, const std::vector<SurgeryEvent>& events);

  private:
    struct Part {
        PatchFace face;
        BoxTree::Box box;
        bool is_there = true;
    };
    /// Boxes of the parts from `first` on, as many as `count`.
    struct Group {
        std::size_t first, count;
        BoxTree tree;
    };
    void add(const PatchFace& face);
    void follow(const std::vector<SurgeryEvent>& events);
    void group_parts();
    bool crosses(const PatchFace& made, const SurgeryEvent& event);

    std::vector<Part> parts_;         ///< the faces at the start, then those made
    std::map<IdFace, int> index_of_;  ///< by face that begins with its least vertex
    std::vector<Group> groups_;       ///< of the first parts, each larger than all that follow
    std::size_t grouped_ = 0;         ///< parts in groups
    std::size_t followed_ = 0;        ///< events
    std::vector<int> found_;
};

}  // namespace arris
