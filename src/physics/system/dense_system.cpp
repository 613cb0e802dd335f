// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/system/dense_system.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace arris {

DenseSystem::DenseSystem(std::vector<int> places, int count)
    : places_(std::move(places)), matrix_(3 * count, 3 * count), rhs_(3 * count)
{
}

template <int N>
void DenseSystem::scatter(const std::array<int, N>& vertices, const LocalSystem<N>& local)
{
    for (int i = 0; i < N; ++i) {
        const int v = places_[vertices[i]];
        if (v < 0) continue;
        rhs_.segment<3>(3 * v) += local.rhs(i);
        matrix_.block<3, 3>(3 * v, 3 * v) += local.matrix(i, i);
        for (int j = 0; j < i; ++j) {
            const int w = places_[vertices[j]];
            if (w < 0) continue;
            if (v > w)
                matrix_.block<3, 3>(3 * v, 3 * w) += local.matrix(i, j);
            else
                matrix_.block<3, 3>(3 * w, 3 * v) += local.matrix(i, j).transpose();
        }
    }
}

void DenseSystem::assemble(const ClothElements& elements, const Terms& terms, const Linearization& at)
{
    assert(!at.flow && terms.loads.empty() && "held cloth at rest");
    assert(std::none_of(at.has_basis.begin(), at.has_basis.end(), [](char has) { return has != 0; }));
    matrix_.setZero();
    rhs_.setZero();
    for (const FaceElement& face : elements.faces)
        scatter<3>(face.vertices, sum_terms<3>(FaceState(face, at.position), terms.faces, at));
    if (terms.hinges.empty()) return;
    const HingeStates hinges(elements, terms, at);
    for (std::size_t h = 0; h < elements.hinges.size(); ++h)
        scatter<4>(elements.hinges[h].vertices, sum_terms<4>(hinges[h], terms.hinges, at));
}

}  // namespace arris
