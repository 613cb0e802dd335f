// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/elements/materials.h"

#include <cassert>

namespace arris {

void Materials::add(double begin, const Material& material)
{
    assert(begins_.empty() || begin > begins_.back());
    begins_.push_back(begin);
    materials_.push_back(material);
}

double Materials::thickness() const
{
    double greatest = 0.0;
    for (const Material& material : materials_) greatest = std::max(greatest, material.thickness);
    return greatest;
}

}  // namespace arris
