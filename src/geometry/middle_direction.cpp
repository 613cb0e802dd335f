// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/middle_direction.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "geometry/tolerances.h"

namespace arris {
namespace {

// Calls `visit` with the candidates for the maximum: each direction, and each one equally far from two or
// three of `directions`.
template <typename Visit>
void for_each_candidate(const std::vector<Vec3>& directions, const Visit& visit)
{
    const std::size_t n = directions.size();
    for (std::size_t i = 0; i < n; ++i) {
        visit(directions[i]);
        for (std::size_t j = i + 1; j < n; ++j) {
            visit(directions[i] + directions[j]);
            for (std::size_t k = j + 1; k < n; ++k) {
                Mat3 rows;
                rows << directions[i].transpose(), directions[j].transpose(), directions[k].transpose();
                if (std::abs(rows.determinant()) > kAccumulated) visit(rows.inverse() * Vec3::Ones());
            }
        }
    }
}

}  // namespace

double least_part(const std::vector<Vec3>& directions, const Vec3& along)
{
    double least = 1.0;
    for (const Vec3& d : directions) least = std::min(least, d.dot(along));
    return least;
}

std::optional<Vec3> find_middle(const std::vector<Vec3>& directions)
{
    Vec3 best = Vec3::Zero();
    double best_part = 0.0;
    for_each_candidate(directions, [&](const Vec3& candidate) {
        if (!(candidate.norm() > 0.0)) return;
        const Vec3 unit = candidate.normalized();
        const double part = least_part(directions, unit);
        if (part > best_part) {
            best = unit;
            best_part = part;
        }
    });
    return best_part > 0.0 ? std::optional(best) : std::nullopt;
}

}  // namespace arris
