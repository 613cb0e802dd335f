// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/untangle/smooth_move.h"

#include <algorithm>

namespace arris {

namespace {

/// Weight of a row's shortfall against an edge's difference. A vertex has 6 edges: it falls short of its row
/// by 6 %, which the next move makes up for. Raising it costs iterations of the solve.
constexpr double kRowStiffness = 100.0;

/// Reaches from the rows beyond which the cloth stays: the move has decayed to 5 % there.
constexpr double kMostReaches = 3.0;

/// Residual of a solve, relative to its right-hand side. A move of a whole piece has an eigenvalue some 1e-5
/// of the rows': at 1e-3 rows move their own vertices only, and strain is five times as large.
constexpr double kSolved = 1e-5;
constexpr int kMostIterations = 1000;  // of a solve; it takes some hundreds
constexpr int kMostActiveSets = 20;    // Newton steps of the shortfalls' sum; it takes a few

/// The equations of a move: unknowns are the vertices near the rows.
class MoveSystem {
  public:
    MoveSystem(const CollisionMesh& mesh, const std::vector<MoveRow>& rows, double reach)
        : rows_(rows),
          is_active_(rows.size(), 1),
          mass_(1.0 / (reach * reach)),
          index_(mesh.positions.size(), -1)
    {
        // Breadth first, so that near vertices have near indices.
        const auto add = [&](int v) {
            if (!mesh.may_move(v) || index_[v] >= 0) return;
            index_[v] = static_cast<int>(vertices_.size());
            vertices_.push_back(v);
        };
        for (const MoveRow& row : rows)
            for (const MoveTerm& term : row.terms) add(term.vertex);
        std::size_t begin = 0;
        for (double ring = 0.0; ring < kMostReaches * reach && begin < vertices_.size(); ++ring) {
            const std::size_t end = vertices_.size();
            for (; begin < end; ++begin)
                for (const int w : mesh.neighbours(vertices_[begin])) add(w);
        }
        for (const int v : vertices_)
            for (const int w : mesh.neighbours(v))
                if (index_[w] < 0 || v < w) edges_.push_back({index_[v], index_[w]});
    }

    /// Active rows are those that fall short; one that exceeds its change pulls back no more.
    SmoothMove solve()
    {
        Eigen::VectorXd u = Eigen::VectorXd::Zero(size());
        for (int i = 0; i < kMostActiveSets; ++i) {
            find_diagonal();
            solve_active(u);
            std::vector<char> is_short(rows_.size());
            for (std::size_t r = 0; r < rows_.size(); ++r)
                is_short[r] = value_of(rows_[r], u) < rows_[r].change;
            if (is_short == is_active_) break;
            is_active_ = std::move(is_short);
        }
        return finish(u);
    }

  private:
    Eigen::Index size() const { return static_cast<Eigen::Index>(3 * vertices_.size()); }

    /// Conjugate gradients, preconditioned by the diagonal, from `u`.
    void solve_active(Eigen::VectorXd& u) const
    {
        const Eigen::VectorXd target = right_hand_side();
        Eigen::VectorXd residual = target - apply(u);
        Eigen::VectorXd scaled = residual.cwiseQuotient(diagonal_), direction = scaled;
        double product = residual.dot(scaled);
        const double enough = kSolved * target.norm();
        for (int i = 0; i < kMostIterations && residual.norm() > enough; ++i) {
            const Eigen::VectorXd image = apply(direction);
            const double curvature = direction.dot(image);
            if (!(curvature > 0.0)) break;  // the residual has underflowed
            const double share = product / curvature;
            u += share * direction;
            residual -= share * image;
            scaled = residual.cwiseQuotient(diagonal_);
            const double next = residual.dot(scaled);
            direction = scaled + (next / product) * direction;
            product = next;
        }
    }

    SmoothMove finish(const Eigen::VectorXd& u) const
    {
        SmoothMove smooth{std::vector<Vec3>(index_.size(), Vec3::Zero()), mass_ * u.squaredNorm()};
        for (std::size_t i = 0; i < vertices_.size(); ++i)
            smooth.move[vertices_[i]] = u.segment<3>(static_cast<Eigen::Index>(3 * i));
        for (const auto& [a, b] : edges_) smooth.work += (at(a, u) - at(b, u)).squaredNorm();
        for (const MoveRow& row : rows_) {
            const double shortfall = std::max(0.0, row.change - value_of(row, u));
            smooth.work += kRowStiffness * shortfall * shortfall;
        }
        return smooth;
    }

    static Vec3 at(int i, const Eigen::VectorXd& u)
    {
        return i >= 0 ? Vec3(u.segment<3>(3 * i)) : Vec3(Vec3::Zero());
    }

    double value_of(const MoveRow& row, const Eigen::VectorXd& u) const
    {
        double value = 0.0;
        for (const MoveTerm& term : row.terms) value += term.weight.dot(at(index_[term.vertex], u));
        return value;
    }

    void find_diagonal()
    {
        diagonal_ = Eigen::VectorXd::Constant(size(), mass_);
        for (const std::array<int, 2>& edge : edges_)
            for (const int i : edge)
                if (i >= 0) diagonal_.segment<3>(3 * i).array() += 1.0;
        for (std::size_t r = 0; r < rows_.size(); ++r)
            for (const MoveTerm& term : rows_[r].terms)
                if (const int i = index_[term.vertex]; i >= 0 && is_active_[r])
                    diagonal_.segment<3>(3 * i) += kRowStiffness * term.weight.cwiseAbs2();
    }

    void add_row(const MoveRow& row, double value, Eigen::VectorXd& sum) const
    {
        for (const MoveTerm& term : row.terms)
            if (const int i = index_[term.vertex]; i >= 0)
                sum.segment<3>(3 * i) += kRowStiffness * value * term.weight;
    }

    Eigen::VectorXd right_hand_side() const
    {
        Eigen::VectorXd sum = Eigen::VectorXd::Zero(size());
        for (std::size_t r = 0; r < rows_.size(); ++r)
            if (is_active_[r]) add_row(rows_[r], rows_[r].change, sum);
        return sum;
    }

    Eigen::VectorXd apply(const Eigen::VectorXd& u) const
    {
        Eigen::VectorXd sum = mass_ * u;
        for (const auto& [a, b] : edges_) {
            const Vec3 difference = at(a, u) - at(b, u);
            if (a >= 0) sum.segment<3>(3 * a) += difference;
            if (b >= 0) sum.segment<3>(3 * b) -= difference;
        }
        for (std::size_t r = 0; r < rows_.size(); ++r)
            if (is_active_[r]) add_row(rows_[r], value_of(rows_[r], u), sum);
        return sum;
    }

    const std::vector<MoveRow>& rows_;
    std::vector<char> is_active_;  // of each row
    double mass_;
    std::vector<int> index_, vertices_;  // unknown of each vertex, -1 where none; and back
    std::vector<std::array<int, 2>> edges_;
    Eigen::VectorXd diagonal_;
};

}  // namespace

SmoothMove find_smooth_move(const CollisionMesh& mesh, const std::vector<MoveRow>& rows, double reach)
{
    return MoveSystem(mesh, rows, reach).solve();
}

}  // namespace arris
