// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <vector>

#include "physics/elements/cloth_elements.h"
#include "physics/elements/linearization.h"
#include "physics/elements/term.h"

namespace arris {

/// A u = b of a step, with three unknowns per vertex. `matrix` holds the lower triangle and whole 3x3
/// diagonal blocks. Its pattern follows from the mesh alone; the positions of each element's blocks are found
/// once per mesh.
class LinearSystem {
  public:
    /// Creates the pattern, with values zero: every pair of vertices that share a face, a spring, or a hinge
    /// that has terms, and the pairs in `coupled`, as of contacts. O(n log n).
    void make_pattern(const ClothElements& elements, std::vector<std::array<int, 2>> coupled = {});

    /// As above, where some vertices are held and have no unknowns. `places` (one entry per vertex,
    /// ascending) maps each vertex to its index in the system, or to -1. No material may flow, and held
    /// vertices do not move.
    void make_pattern(const ClothElements& elements, std::vector<int> places);

    /// Sums all terms at `at`; `mesh` and `elements` are those of the step's start. The result does not
    /// depend on the number of threads. Elements with an EOL vertex (`at.flow`) are rebuilt at the material
    /// coordinates of q^ and of the extrapolated state. Other elements are summed as if no vertex were EOL.
    void assemble(const ClothMesh& mesh, const ClothElements& elements, const Terms& terms,
                  const Linearization& at);

    /// The pairs that the pattern has besides those of elements.
    const std::vector<std::array<int, 2>>& coupled() const { return coupled_; }
    /// Whether the pattern couples two vertices.
    bool has_pair(int v, int w) const;

    const Eigen::SparseMatrix<double>& matrix() const { return matrix_; }
    const Eigen::VectorXd& rhs() const { return rhs_; }

    /// Adds to the diagonal block of vertex `place` of the system.
    void add_to_vertex(int place, const Mat3& block);

  private:
    /// Block rows below the diagonal of each block column: below[first[j]] .. below[last[j] - 1] ascend.
    struct Neighbours {
        std::vector<int> first, last, below;
    };

    Neighbours find_neighbours(const ClothElements& elements) const;
    void make_columns(const Neighbours& neighbours);
    void find_element_blocks(const ClothElements& elements);
    int place_of(int v) const { return places_.empty() ? v : places_[v]; }
    int find_block(int row, int column) const;
    template <int N>
    void scatter(const std::array<int, N>& vertices, const int* blocks, const LocalSystem<N>& local);

    void set_loads(const ClothMesh& mesh, const Terms& terms, const Linearization& at);
    template <int N, typename Element, typename Blocks, typename MakeState, typename ElementTerms,
              typename AddEulerian>
    void add_elements(const ElementColors& colors, const std::vector<Element>& elements, const Blocks& blocks,
                      const MakeState& make_state, const ElementTerms& terms, const Linearization& at,
                      const AddEulerian& add_eulerian);

    Eigen::SparseMatrix<double> matrix_;
    Eigen::VectorXd rhs_;
    std::vector<int> places_;                       ///< index in the system of each vertex; empty where all
                                                    ///< vertices have unknowns
    std::vector<std::array<int, 2>> coupled_;       ///< vertices
    std::vector<int> column_height_;                ///< entries in each column of a vertex
    std::vector<std::array<int, 3>> face_blocks_;   ///< first entry of blocks (1,0), (2,0), (2,1); -1 where
                                                    ///< either vertex is held
    std::vector<std::array<int, 6>> hinge_blocks_;  ///< blocks (1,0), (2,0), (2,1), (3,0), (3,1), (3,2)
    std::vector<std::array<int, 1>> spring_blocks_;
};

}  // namespace arris
