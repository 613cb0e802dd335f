// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/newton_step.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/velocity_solve/symmetric_product.h"

namespace arris {
namespace {

using Eigen::VectorXd;

MemberProblem make_member_problem(const ConstraintRows& constraints, const SpringBase& base,
                                  const Members& members, const ContactIterate& at)
{
    MemberProblem problem;
    const ContactState& has = base.state();
    std::vector<int> place_of_first(constraints.budgets.size(), -1);
    for (int k = 0; k < members.size(); ++k) {
        const auto [kind, index] = members[k];
        if (kind == Member::Kind::Slip) {
            if (index % 2 == 0) place_of_first[index / 2] = k;
        } else if (kind == Member::Kind::Row) {
            const ScaledRow& row = constraints.rows[index];
            const double stiffness = has.is_pressing[index] ? 1.0 / row.compliance : 0.0;
            problem.rows.push_back({k, row.compliance, at.multipliers[index], stiffness});
        } else {
            problem.bounds.push_back({k, at.bound_force(index)});
        }
    }
    for (int k = 0; k < members.size(); ++k) {
        const auto [kind, index] = members[k];
        if (kind != Member::Kind::Slip || index % 2 == 0) continue;
        const int p = index / 2;
        problem.slipping.push_back({{place_of_first[p], k},
                                    constraints.rows[2 * p].compliance,
                                    constraints.budgets[p],
                                    at.multipliers.segment<2>(2 * p),
                                    has.stiffness[p],
                                    at.impulses.segment<2>(2 * p)});
    }
    return problem;
}

}  // namespace

std::optional<NewtonStep> find_step(const ContactLaws& laws, const SpringBase& base, Members& members,
                                    DenseBudget& work, ContactIterate& at)
{
    constexpr double kAccuracy = 0.05;  // of the members' forces, in units of the largest residual
    const VelocityProblem& problem = laws.problem();
    const ConstraintRows& constraints = laws.constraints();
    if (!work.spend(4.0 * base.factorization().nonzeros())) return std::nullopt;
    NewtonStep step;
    VectorXd rhs = at.residual, to_bound = VectorXd::Zero(at.residual.size());
    bool is_any_moved = false;
    double unbalanced = 0.0;
    for (int i = 0; i < rhs.size(); ++i) {
        if (members.has_bound(i)) rhs[i] += at.bound_force(i);
        if (members.has_bound(i) || problem.is_fixed[i]) continue;
        if (!base.is_pinned(i)) {
            unbalanced = std::max(unbalanced, std::abs(rhs[i]));
        } else {
            to_bound[i] = problem.lower[i] - at.point.velocity[i];
            is_any_moved = is_any_moved || std::abs(to_bound[i]) > 0.0;
        }
    }
    if (is_any_moved) rhs -= symmetric_product(base.matrix(), to_bound);
    const VectorXd forward = base.solve_forward(rhs);
    VectorXd change, forces;
    MemberProblem dense;
    if (members.size() == 0) {
        change = base.solve_backward(forward);
    } else {
        std::optional<MemberResponse> response =
            members.respond(at.point.velocity, at.point.row_values, rhs, forward);
        if (!response) return std::nullopt;
        dense = make_member_problem(constraints, base, members, at);
        dense.mobility = std::move(response->mobility);
        dense.offset = std::move(response->offset);
        dense.now = std::move(response->now);
        const std::optional<VectorXd> found =
            solve_members(dense, kAccuracy * unbalanced, work, step.nlopt_evaluations);
        if (!found) return std::nullopt;
        forces = *found;
        change = members.change(forces, forward);
        const VectorXd moved = dense.offset + dense.mobility * forces;
        for (const RowMember& member : dense.rows)
            at.multipliers[members[member.place].index] =
                forces[member.place] + member.force - member.base_stiffness * moved[member.place];
        for (const SlipMember& pair : dense.slipping)
            at.multipliers.segment<2>(members[pair.place[0]].index) =
                forces(pair.place) + pair.force - pair.base_stiffness * moved(pair.place);
    }
    change += to_bound;
    step.is_finite = change.allFinite();
    if (!step.is_finite) return step;
    step.change = laws.make_point(std::move(change));
    const ContactState& has = base.state();
    for (int p = 0; p < constraints.pair_count(); ++p)
        if (!members.has_row(2 * p))
            at.multipliers.segment<2>(2 * p) -= has.stiffness[p] * step.change.row_values.segment<2>(2 * p);
    for (int k = constraints.slip_count(); k < static_cast<int>(constraints.rows.size()); ++k)
        if (has.is_pressing[k] && !members.has_row(k))
            at.multipliers[k] -= step.change.row_values[k] / constraints.rows[k].compliance;
    at.impulses = at.multipliers.head(constraints.slip_count());
    for (const SlipMember& pair : dense.slipping)
        at.impulses.segment<2>(members[pair.place[0]].index) = pair.impulse;
    for (int i = 0; i < to_bound.size(); ++i)
        if (base.is_pinned(i) && !members.has_bound(i) && !problem.is_fixed[i]) at.wanted.is_active[i] = 1;
    for (const BoundMember& member : dense.bounds)
        at.wanted.is_active[members[member.place].index] = forces[member.place] + member.force > 0.0;
    return step;
}

}  // namespace arris
