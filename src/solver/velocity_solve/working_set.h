// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/velocity_solve/condensed_qp.h"
#include "solver/velocity_solve/forward_columns.h"
#include "solver/velocity_solve/pinned_base.h"

namespace arris {

/// The constraints U that may have to change sides against the base: pins to be released (R), free
/// coordinates to be stopped and rows (together a). Everything else is eliminated by the base's factor: with
/// W = L^-1 P A_FR and Y = L^-1 P g_F, where g is a row's coefficients or a unit vector, and of which
/// `columns` holds the Gram matrix, the base's solution changes by
///   gradient_R = gradient0_R + C dR + B lambda_a,   C = A_RR - W^T W  (compliance^-1 of the released)
///   gap_a      = gap0_a - B^T dR + Y^T Y lambda_a,   B = W^T Y - g_R
/// with dR = u_R - lower_R. Solved for (dR, gap_a) it is w = S lambda + q, where S = g^T (A_F+R)^-1 g, SPD
/// but for rows that depend on others: the condensed problem. U only grows. With a row its pinned coordinates
/// are released: S_kk of a row that stands on pins alone would be zero.
class WorkingSet {
  public:
    explicit WorkingSet(const PinnedBase& base);

    int size() const { return static_cast<int>(members_.size()); }
    int row_count() const { return row_count_; }
    int coordinate_count() const { return size() - row_count_ - followers_; }  ///< without rows' pins
    bool contains(int coordinate) const { return is_member_[coordinate]; }
    bool contains_row(int row) const { return is_row_member_[row]; }

    /// The coordinates and rows, none of which is a member yet, and the pins that the rows stand on.
    void extend(const std::vector<int>& coordinates, const std::vector<int>& rows = {});

    /// Takes notice that the base's constraints have got further rows.
    void see_new_rows();

    /// Finds multipliers on U, and with them the velocity. False where the dense problem is not positive
    /// definite to working precision or does not end; the working set is of no use then.
    bool solve(Iterate& iterate, int& nlopt_evaluations);

    /// One step of iterative refinement of the equations of the present active set; false as above.
    bool refine(Iterate& iterate) const;

    /// Solves for U once more from a refined `iterate`, relative to its true gaps and multipliers: what
    /// round-off in S has put on the wrong side changes it. For working sets with rows; false as above.
    bool correct(Iterate& iterate);

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

    std::optional<CondensedQp> condense() const;
    Eigen::VectorXd caps() const;
    double gap_of(const Member& member, const Eigen::VectorXd& velocity) const;
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
    Eigen::MatrixXd direct_;  ///< U x U: A_ij of two released, g_i of a released and a row, 0 elsewhere
    Eigen::VectorXd multipliers_;
};

}  // namespace arris
