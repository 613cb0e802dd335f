// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "solver/velocity_solve/condensed_qp.h"
#include "solver/velocity_solve/forward_columns.h"
#include "solver/velocity_solve/member_springs.h"
#include "solver/velocity_solve/pinned_base.h"

namespace arris {

/// The constraints U that may have to change sides relative to the base: pins to be released (R), free
/// coordinates to be stopped and rows (together a). The base's factor eliminates everything else. With A
/// the base's matrix, W = L^-1 P A_FR and Y = L^-1 P g_F, where g is a row's coefficients or a unit vector,
/// the base's solution changes by
///   gradient_R = gradient0_R + C dR + B lambda_a,   C = A_RR - W^T W  (compliance^-1 of the released)
///   gap_a      = gap0_a - B^T dR + Y^T Y lambda_a,   B = W^T Y - g_R
/// with dR = u_R - lower_R. `columns_` holds the Gram matrix of W and Y. Solved for (dR, gap_a) this is the
/// condensed problem w = S lambda + q with S = g^T (A_F+R)^-1 g + diag(give). S is SPD. U only grows. A row
/// brings the release of the pins among its coordinates: without them a row on pinned coordinates alone would
/// only give way. The two slip rows of a friction pair join together, as a disc. Where the base has a spring
/// (K, force) of a row or a pair in U, the spring is taken out of S and q.
class WorkingSet {
  public:
    explicit WorkingSet(const PinnedBase& base);

    int size() const { return static_cast<int>(members_.size()); }
    int row_count() const { return row_count_; }
    int coordinate_count() const { return size() - row_count_ - followers_; }  ///< without pins of rows
    bool contains(int coordinate) const { return is_member_[coordinate]; }
    bool contains_row(int row) const { return is_row_member_[row]; }

    /// Adds the coordinates and rows, none of which may be a member yet, and the pins among the rows'
    /// coordinates. Slip rows come in pairs.
    void extend(const std::vector<int>& coordinates, const std::vector<int>& rows = {});

    /// Call after rows were appended to the base's constraints.
    void see_new_rows();

    /// Finds multipliers on U and the velocity that they give. False where the dense problem is not positive
    /// definite to working precision or does not end within `budget`, which its work reduces; the working
    /// set is then useless.
    bool solve(Iterate& iterate, int& nlopt_evaluations, DenseBudget& budget);

    /// One step of iterative refinement of the equations of the current active set; false as for `solve`.
    bool refine(Iterate& iterate) const;

  private:
    enum class Kind { Released, Stopped, Row };
    struct Member {
        Kind kind;
        int index;  ///< coordinate, or row
    };
    void enter(std::vector<Member>& added, Member member);
    void release_pins_of(const std::vector<int>& rows, std::vector<Member>& added);
    int position_of(const Member& member) const;
    std::vector<SparseVector> right_hand_sides(const std::vector<Member>& added);
    void add_row(int member, const std::vector<int>& place, SparseVector& column);
    void add_released(int first, const std::vector<int>& place, std::vector<SparseVector>& columns);
    const ScaledRow& row_of(const Member& member) const { return base_->constraints->rows[member.index]; }

    std::optional<CondensedQp> condense(const MemberSprings& springs) const;
    bool release_pins(const std::vector<int>& released, const std::vector<int>& stopped,
                      CondensedQp& qp) const;
    MemberSprings springs_of_members() const;
    void add_discs(CondensedQp& qp) const;
    bool is_spring(const Member& member) const  ///< a row for which the base has a spring
    {
        return member.kind == Kind::Row && base_->is_pressing[member.index];
    }
    bool is_slip(const Member& member) const
    {
        return member.kind == Kind::Row && member.index < base_->constraints->slip_count();
    }
    std::vector<std::array<int, 2>> places_of_pairs() const;
    double give_of(const Member& member) const
    {
        return member.kind == Kind::Row && !is_slip(member) && !is_spring(member) ? row_of(member).give : 0.0;
    }
    double gap_of(const Member& member, const Iterate& iterate) const;
    void set_member(int k, const CondensedAnswer& answer, Iterate& iterate) const;
    void set_members(const CondensedAnswer& answer, const Eigen::VectorXd& free, Iterate& iterate) const;
    double mixed(int i, int j) const;
    bool is_equation(const Member& member, const Iterate& iterate) const;
    Eigen::VectorXd step_of(const std::vector<int>& equations, const Iterate& iterate,
                            const Eigen::VectorXd& forward) const;

    const PinnedBase* base_;
    std::vector<char> is_member_;      ///< by coordinate
    std::vector<char> is_row_member_;  ///< by row
    std::vector<Member> members_;
    int row_count_ = 0, followers_ = 0;
    ForwardColumns columns_;
    Eigen::MatrixXd direct_;  ///< U x U: A_ij of two released pins, g_i of a released pin and a row, else 0
    Eigen::VectorXd multipliers_;
};

}  // namespace arris
