// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Cholesky>
#include <optional>
#include <vector>

#include "solver/velocity_solve/condensed_qp.h"
#include "solver/velocity_solve/forward_columns.h"
#include "solver/velocity_solve/spring_base.h"

namespace arris {

/// A constraint whose law is kept exactly beside a base, which has it pinned, as a linear spring, or not at
/// all.
struct Member {
    enum class Kind {
        Released,  ///< a bound that the base has pinned
        Stopped,   ///< a bound that the base has free
        Row,
        Slip  ///< one of the two rows of a friction pair, which come together
    };
    Kind kind;
    int index;  ///< coordinate, or scaled row
    bool is_bound() const { return kind == Kind::Released || kind == Kind::Stopped; }
};

/// The dense response of the members, from where the velocity is now: displacement = now + offset +
/// mobility * force, with everything else as the base has it. Displacement: u - lower of a bound, y - lower
/// of a row. Force: the multiplier of a bound; of a row what it gives beyond its spring in the base.
struct MemberResponse {
    Eigen::MatrixXd mobility;  ///< symmetric, positive semidefinite
    Eigen::VectorXd offset;
    Eigen::VectorXd now;  ///< displacements before
};

/// The members of a base, of which there come more until the next factorisation. With F the free coordinates
/// of the base, R the released ones, L L^T = A'_FF, W = L^-1 P A'_FR and Y = L^-1 P g_F, where g is a row's
/// coefficients or a unit vector, a change (dR, z) of released coordinates and forces changes
///   the other displacements by  Y^T Y z - B^T dR,        B = W^T Y - g_R
///   the forces on R by          - C dR - B z,            C = A'_RR - W^T W
/// Released coordinates count by their multiplier: dR = C^-1 (multiplier + residual - B z). A row among whose
/// coordinates there are pins brings these as members: without them a row of pinned coordinates alone would
/// only give way.
class Members {
  public:
    /// All outlive this object; `work` pays for what it does.
    Members(const SpringBase& base, const VelocityProblem& problem, const ConstraintRows& constraints,
            DenseBudget& work);

    int size() const { return static_cast<int>(members_.size()); }
    const Member& operator[](int k) const { return members_[k]; }
    bool has_bound(int coordinate) const { return is_bound_member_[coordinate]; }
    bool has_row(int row) const { return is_row_member_[row]; }

    /// Call after rows were appended to the constraints.
    void see_new_rows();

    /// Adds bounds and scaled rows that are no members yet; slip rows by pairs.
    void extend(const std::vector<int>& bounds, const std::vector<int>& rows);

    /// Response at a velocity. `residual`: b - A u + C^T multipliers without those of bounds; `forward`: of
    /// it, by the base. Nothing where C is not positive definite, or the work is spent.
    std::optional<MemberResponse> respond(const Eigen::VectorXd& velocity, const Eigen::VectorXd& row_values,
                                          const Eigen::VectorXd& residual, const Eigen::VectorXd& forward);

    /// The change of the velocity that the last response's `forces` bring. `forward`: as for `respond`.
    Eigen::VectorXd change(const Eigen::VectorXd& forces, Eigen::VectorXd forward) const;

  private:
    void enter(Member member, std::vector<Member>& added);
    int position_of(const Member& member) const;
    std::vector<SparseVector> right_hand_sides(const std::vector<Member>& added);
    void add_row(int member, const std::vector<int>& place, SparseVector& column);
    void add_released(int first, const std::vector<int>& place, std::vector<SparseVector>& columns);
    bool condense();

    const SpringBase* base_;
    const VelocityProblem* problem_;
    const ConstraintRows* constraints_;
    DenseBudget* work_;
    std::vector<char> is_bound_member_;  ///< by coordinate
    std::vector<char> is_row_member_;    ///< by scaled row
    std::vector<Member> members_;
    ForwardColumns columns_;  ///< W and Y
    Eigen::MatrixXd direct_;  ///< A'_ij of two released pins, g_i of a released pin and a row, else 0

    // Of the members as they are, from `condense`.
    bool is_condensed_ = false;
    std::vector<int> released_, others_;
    Eigen::LLT<Eigen::MatrixXd> stiffness_;  ///< C
    Eigen::MatrixXd coupling_;               ///< B
    Eigen::MatrixXd mobility_;
    Eigen::VectorXd step_;  ///< C^-1 (residual_R - W^T forward), of the last response
};

}  // namespace arris
