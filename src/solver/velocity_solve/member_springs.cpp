// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/member_springs.h"

#include <utility>

#include "solver/velocity_solve/dense_solve.h"

namespace arris {
namespace {

std::vector<int> all_but(const std::vector<int>& members, Eigen::Index size)
{
    std::vector<char> is_one(static_cast<std::size_t>(size), 0);
    for (const int k : members) is_one[k] = 1;
    std::vector<int> others;
    for (int k = 0; k < size; ++k)
        if (is_one[k] == 0) others.push_back(k);
    return others;
}

}  // namespace

void take_out_springs(const MemberSprings& springs, CondensedQp& qp)
{
    const std::vector<int>& of = springs.members;
    const auto count = static_cast<Eigen::Index>(of.size()), size = qp.linear.size();
    if (count == 0) return;
    const Eigen::MatrixXd columns = qp.hessian(Eigen::all, of);
    qp.linear -= columns * springs.force;
    if (springs.stiffness.nonZeros() > 0) {
        const std::vector<int> others = all_but(of, size);
        const Eigen::MatrixXd stiff = columns * springs.stiffness;
        Eigen::MatrixXd right(count, size + 1);
        right << columns.transpose(), qp.linear(of);
        const Eigen::MatrixXd gap =
            solve_dense(Eigen::MatrixXd::Identity(count, count) - stiff(of, Eigen::all), std::move(right));
        const Eigen::MatrixXd of_members = gap(Eigen::all, of), of_others = gap(Eigen::all, others);
        const Eigen::MatrixXd more = stiff(others, Eigen::all) * of_others;
        qp.hessian(of, of) = 0.5 * (of_members + of_members.transpose());
        qp.hessian(of, others) = of_others;
        qp.hessian(others, of) = of_others.transpose();
        qp.hessian(others, others) += 0.5 * (more + more.transpose());
        qp.linear(others) += stiff(others, Eigen::all) * gap.col(size);
        qp.linear(of) = gap.col(size);
    }
    for (Eigen::Index i = 0; i < count; ++i) qp.hessian(of[i], of[i]) += springs.gives[i];
}

Eigen::VectorXd beyond_springs(const MemberSprings& springs, const CondensedAnswer& answer)
{
    const Eigen::VectorXd z = answer.z(springs.members),
                          gap = answer.w(springs.members) - springs.gives.cwiseProduct(z);
    return z - springs.force + springs.stiffness * gap;
}

}  // namespace arris
