// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <vector>

#include "solver/model/constraint_cause.h"
#include "solver/model/state.h"

namespace arris {

/// Collects the contacts of a state that pressed on a feature and are constraints in the step, with their
/// causes.
class RefusedContacts {
  public:
    explicit RefusedContacts(const State& state) : state_(state) {}

    /// Notes that vertex `v` was inserted for contact `contact` (index in State::active).
    void note_inserted(VertexId v, int contact) { contact_of_[v] = contact; }

    void refuse(int contact, ConstraintCause cause);
    /// Refuses the contact of an EOL vertex, one of the state or an inserted one.
    void refuse_vertex(VertexId v, ConstraintCause cause);

    const std::vector<RefusedContact>& list() const { return refused_; }

  private:
    const State& state_;
    std::map<VertexId, int> contact_of_;
    std::vector<RefusedContact> refused_;
};

}  // namespace arris
