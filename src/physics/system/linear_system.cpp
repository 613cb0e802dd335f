// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/system/linear_system.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

#include "geometry/batches.h"
#include "physics/elements/eulerian_element.h"
#include "physics/elements/momentum_flux.h"

namespace arris {

namespace {

/// Applies `visit` to each of `count` elements, colour by colour; elements of one colour in parallel. Without
/// colours, one element after the other.
template <typename Visit>
void for_each_by_color(const ElementColors& colors, std::size_t count, const Visit& visit)
{
    if (colors.start.empty())
        for (std::size_t e = 0; e < count; ++e) visit(static_cast<int>(e));
    for (std::size_t k = 0; k + 1 < colors.start.size(); ++k)
        for_each_in_batches(colors.start[k + 1] - colors.start[k],
                            [&](int i) { visit(colors.order[colors.start[k] + i]); });
}

/// Reduces an element to the coordinates of its vertices if any corner has a basis of its own.
template <int N>
void reduce(const std::array<int, N>& vertices, const Linearization& at, LocalSystem<N>& local)
{
    bool has_basis = false;
    std::array<const Mat3*, N> corner_matrices;
    for (int i = 0; i < N; ++i) {
        has_basis = has_basis || at.has_basis[vertices[i]];
        corner_matrices[i] = &at.basis[vertices[i]];
    }
    if (has_basis) local.reduce(corner_matrices);
}

/// Whether material flows through EOL vertices only.
[[maybe_unused]] bool is_consistent(const MaterialFlow& flow, const ClothMesh& mesh)
{
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        if (flow.is_eulerian[v]) continue;
        const bool stands = flow.position[v] == mesh.material[v] &&
                            flow.extrapolated.material[v] == mesh.material[v] && flow.basis[v].isZero(0.0) &&
                            flow.v_predicted[v].isZero(0.0) && flow.v_expansion[v].isZero(0.0) &&
                            flow.v_last[v].isZero(0.0) && flow.extrapolated.material_velocity[v].isZero(0.0);
        if (!stands) return false;
    }
    return true;
}

}  // namespace

void LinearSystem::make_pattern(const ClothElements& elements, std::vector<std::array<int, 2>> coupled)
{
    coupled_ = std::move(coupled);
    make_pattern(elements, std::vector<int>());
}

void LinearSystem::make_pattern(const ClothElements& elements, std::vector<int> places)
{
    places_ = std::move(places);
    make_columns(find_neighbours(elements));
    find_element_blocks(elements);
}

LinearSystem::Neighbours LinearSystem::find_neighbours(const ClothElements& elements) const
{
    const int n =
        places_.empty() ? elements.vertex_count : 1 + *std::max_element(places_.begin(), places_.end());
    const auto for_each_pair = [&](const auto& visit) {
        const auto visit_pairs = [&](auto vertices) {
            for (int& v : vertices) v = place_of(v);
            if (*std::max_element(vertices.begin(), vertices.end()) < 0)
                return;  // in a patch, most vertices are held
            for (const int i : vertices)
                for (const int j : vertices)
                    if (i > j && j >= 0) visit(i, j);
        };
        for (const FaceElement& face : elements.faces) visit_pairs(face.vertices);
        for (const std::array<int, 2>& pair : coupled_) visit_pairs(pair);
        for (const SpringElement& spring : elements.springs) visit_pairs(spring.vertices);
        if (elements.hinge_use != HingeUse::Terms) return;
        for (const HingeElement& hinge : elements.hinges) visit_pairs(hinge.vertices);
    };
    Neighbours neighbours;
    std::vector<int>& first = neighbours.first;
    first.assign(n + 1, 0);
    for_each_pair([&](int, int j) { ++first[j + 1]; });
    std::partial_sum(first.begin(), first.end(), first.begin());
    neighbours.last.assign(first.begin(), first.end() - 1);
    neighbours.below.resize(first.back());
    for_each_pair([&](int i, int j) { neighbours.below[neighbours.last[j]++] = i; });

    // A mesh edge is in up to seven elements: remove duplicates before sorting.
    std::vector<int> last_in(n, -1);  // for each row, the last column that contained it
    for (int j = 0; j < n; ++j) {
        const auto begin = neighbours.below.begin() + first[j],
                   end = neighbours.below.begin() + neighbours.last[j];
        const auto comes_again = [&](int i) { return std::exchange(last_in[i], j) == j; };
        const auto kept = std::remove_if(begin, end, comes_again);
        std::sort(begin, kept);
        neighbours.last[j] = static_cast<int>(kept - neighbours.below.begin());
    }
    return neighbours;
}

void LinearSystem::make_columns(const Neighbours& neighbours)
{
    const auto& [first, last, below] = neighbours;
    const int n = static_cast<int>(last.size());
    column_height_.assign(n, 0);
    Eigen::VectorXi heights(3 * n);
    for (int j = 0; j < n; ++j) {
        column_height_[j] = 3 * (1 + last[j] - first[j]);
        heights.segment<3>(3 * j).setConstant(column_height_[j]);
    }
    matrix_.resize(3 * n, 3 * n);
    matrix_.resizeNonZeros(heights.sum());
    int* outer = matrix_.outerIndexPtr();
    int* inner = matrix_.innerIndexPtr();
    outer[0] = 0;
    for (int j = 0; j < n; ++j)
        for (int c = 0; c < 3; ++c) {
            int entry = outer[3 * j + c];
            for (int r = 0; r < 3; ++r) inner[entry++] = 3 * j + r;
            for (int k = first[j]; k < last[j]; ++k)
                for (int r = 0; r < 3; ++r) inner[entry++] = 3 * below[k] + r;
            outer[3 * j + c + 1] = entry;
        }
    rhs_.resize(3 * n);
}

void LinearSystem::find_element_blocks(const ClothElements& elements)
{
    const auto find_blocks = [&](auto vertices, auto& blocks) {
        for (int& v : vertices) v = place_of(v);
        int k = 0;
        for (std::size_t i = 1; i < vertices.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                const auto [low, high] = std::minmax({vertices[i], vertices[j]});
                blocks[k++] = low < 0 ? -1 : find_block(high, low);
            }
    };
    face_blocks_.resize(elements.faces.size());
    for (std::size_t f = 0; f < elements.faces.size(); ++f)
        find_blocks(elements.faces[f].vertices, face_blocks_[f]);
    spring_blocks_.resize(elements.springs.size());
    for (std::size_t s = 0; s < elements.springs.size(); ++s)
        find_blocks(elements.springs[s].vertices, spring_blocks_[s]);
    hinge_blocks_.clear();
    if (elements.hinge_use != HingeUse::Terms) return;
    hinge_blocks_.resize(elements.hinges.size());
    for (std::size_t h = 0; h < elements.hinges.size(); ++h)
        find_blocks(elements.hinges[h].vertices, hinge_blocks_[h]);
}

int LinearSystem::find_block(int row, int column) const
{
    const int* begin = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[3 * column];
    const int* end = begin + column_height_[column];
    const int* found = std::lower_bound(begin, end, 3 * row);
    assert(found != end && *found == 3 * row && "every pair of an element is in the pattern");
    return static_cast<int>(found - matrix_.innerIndexPtr());
}

bool LinearSystem::has_pair(int v, int w) const
{
    const int column = std::min(place_of(v), place_of(w)), row = std::max(place_of(v), place_of(w));
    const int* begin = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[3 * column];
    return std::binary_search(begin, begin + column_height_[column], 3 * row);
}

void LinearSystem::add_to_vertex(int place, const Mat3& block)
{
    double* values = matrix_.valuePtr() + matrix_.outerIndexPtr()[3 * place];
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) values[c * column_height_[place] + r] += block(r, c);
}

template <int N>
void LinearSystem::scatter(const std::array<int, N>& vertices, const int* blocks, const LocalSystem<N>& local)
{
    double* values = matrix_.valuePtr();
    const auto add = [&](int first, int height, const auto& block) {
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r) values[first + c * height + r] += block(r, c);
    };
    std::array<int, N> places = vertices;
    if (!places_.empty())
        for (int& v : places) v = places_[v];
    int k = 0;
    for (int i = 0; i < N; ++i) {
        const int v = places[i];
        if (v < 0) {
            k += i;
            continue;
        }
        rhs_.segment<3>(3 * v) += local.rhs(i);
        add(matrix_.outerIndexPtr()[3 * v], column_height_[v], local.matrix(i, i));
        for (int j = 0; j < i; ++j, ++k) {
            const int w = places[j];
            if (w < 0) continue;
            if (v > w)
                add(blocks[k], column_height_[w], local.matrix(i, j));
            else
                add(blocks[k], column_height_[v], local.matrix(i, j).transpose());
        }
    }
}

/// Sums elements colour by colour; those with an EOL vertex through `add_eulerian`.
template <int N, typename Element, typename Blocks, typename MakeState, typename ElementTerms,
          typename AddEulerian>
void LinearSystem::add_elements(const ElementColors& colors, const std::vector<Element>& elements,
                                const Blocks& blocks, const MakeState& make_state, const ElementTerms& terms,
                                const Linearization& at, const AddEulerian& add_eulerian)
{
    for_each_by_color(colors, elements.size(), [&](int e) {
        const Element& element = elements[e];
        if (at.flow && has_eulerian_vertex(*at.flow, element.vertices)) {
            add_eulerian(e);
            return;
        }
        LocalSystem<N> local = sum_terms<N>(make_state(e), terms, at);
        reduce<N>(element.vertices, at, local);
        scatter<N>(element.vertices, blocks[e].data(), local);
    });
}

/// Loads act on vertices, not on elements. On an EOL vertex: sum_f G_f^T f_f = B^T f - E^T sum_f F_f^T f_f.
void LinearSystem::set_loads(const ClothMesh& mesh, const Terms& terms, const Linearization& at)
{
    // Which faces lie in a box of material depends on where material has flowed.
    std::optional<ClothMesh> flowed;
    if (at.flow && !terms.loads.empty()) {
        flowed = mesh;
        flowed->material = at.flow->extrapolated.material;
    }
    rhs_.setZero();
    if (terms.loads.empty()) return;
    const ClothMesh& loaded = flowed ? *flowed : mesh;
    std::vector<Vec3> load(mesh.vertex_count(), Vec3::Zero());
    for (const auto& term : terms.loads) term->add(loaded, at, load);
    for (int v = 0; v < mesh.vertex_count(); ++v)
        if (const int place = place_of(v); place >= 0)
            rhs_.segment<3>(3 * place) = at.basis[v].transpose() * (at.gamma * load[v]);
    if (!flowed) return;

    for (const auto& term : terms.loads)
        for (const CornerLoad& corner : term->corner_loads(loaded, at)) {
            const Face& face = loaded.faces[corner.face];
            const int v = face[corner.corner];
            if (!at.flow->is_eulerian[v]) continue;
            const Mat32 F = FaceState(make_face_element(loaded.material, face, loaded.points_of(corner.face)),
                                      at.flow->extrapolated.position)
                                .F;
            const int point = loaded.points_of(corner.face)[corner.corner];
            rhs_.segment<3>(3 * v) -=
                at.flow->basis[point].transpose() * (F.transpose() * (at.gamma * corner.force));
        }
}

void LinearSystem::assemble(const ClothMesh& mesh, const ClothElements& elements, const Terms& terms,
                            const Linearization& at)
{
    assert((!at.flow || is_consistent(*at.flow, mesh)) && "material flows through EOL vertices only");
    assert((terms.hinges.empty() || elements.hinge_use == HingeUse::Terms) && "hinges have no blocks");
    assert((!at.flow || places_.empty()) && "nothing flows where some are held");
    matrix_.coeffs().setZero();
    set_loads(mesh, terms, at);
    add_momentum_flux(terms.materials, elements, at, rhs_);
    add_elements<3>(
        elements.face_colors, elements.faces, face_blocks_,
        [&](int f) { return FaceState(elements.faces[f], at.position); }, terms.faces, at,
        [&](int f) {
            const Face &face = elements.faces[f].vertices, &points = elements.faces[f].points;
            for (FaceSystem local : {eulerian_inertia_and_loads(elements.faces[f], terms, at),
                                     eulerian_elasticity(elements.faces[f], terms, at)}) {
                reduce_eulerian<3>(face, points, at, local);
                scatter<3>(face, face_blocks_[f].data(), local);
            }
        });
    for (std::size_t s = 0; s < elements.springs.size(); ++s) {
        const SpringElement& spring = elements.springs[s];
        SpringSystem local = sum_terms<2>(SpringState(spring, at.position), terms.springs, at);
        reduce<2>(spring.vertices, at, local);
        scatter<2>(spring.vertices, spring_blocks_[s].data(), local);
    }
    if (terms.hinges.empty()) return;
    const HingeStates hinges(elements, terms, at);
    add_elements<4>(
        elements.hinge_colors, elements.hinges, hinge_blocks_, [&](int h) { return hinges[h]; }, terms.hinges,
        at,
        [&](int h) {
            const HingeElement& hinge = elements.hinges[h];
            HingeSystem local = eulerian_hinge(hinge, hinges.moment(h), elements, terms, at);
            reduce_eulerian<4>(hinge.vertices, points_of(hinge, elements), at, local);
            scatter<4>(hinge.vertices, hinge_blocks_[h].data(), local);
        });
}

}  // namespace arris
