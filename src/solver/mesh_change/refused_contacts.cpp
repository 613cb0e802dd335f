// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh_change/refused_contacts.h"

namespace arris {

void RefusedContacts::refuse(int contact, ConstraintCause cause)
{
    const ActiveContact& active = state_.active[contact];
    refused_.push_back({active.vertex_ids, active.kind, active.obstacle, active.element, cause});
}

void RefusedContacts::refuse_vertex(VertexId v, ConstraintCause cause)
{
    const int entry = state_.eol_entry(v);
    const auto inserted = contact_of_.find(v);
    if (entry >= 0)
        refused_.push_back({{v}, ContactKind::Vertex, state_.eol[entry].on.obstacle, -1, cause});
    else if (inserted != contact_of_.end())
        refuse(inserted->second, cause);
}

}  // namespace arris
