// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// Elements of a pair: a vertex and a face that does not hold it, or two edges without a common vertex. Two
/// surfaces that are apart first meet in such a pair.
enum class SelfContactKind { VertexFace, EdgeEdge };

/// Two points of the cloth: a vertex and a point of a face, or points of two edges.
struct ClothPointPair {
    SelfContactKind kind;
    std::array<int, 4> vertices;    ///< those of the first element first
    std::array<double, 4> weights;  ///< sum 1 on the first element, -1 on the second

    int first_count() const { return kind == SelfContactKind::VertexFace ? 1 : 2; }

    /// The first point minus the second.
    Vec3 difference(const std::vector<Vec3>& field) const
    {
        Vec3 sum = Vec3::Zero();
        for (int i = 0; i < 4; ++i) sum += weights[i] * field[vertices[i]];
        return sum;
    }

    /// Changes the difference by `change`, where that is possible. `mobility`: 1 / mass of each vertex; 0
    /// where it stays. Keeps the sum of mass times field, if no vertex stays.
    void shift(const Vec3& change, const std::vector<double>& mobility, std::vector<Vec3>& field) const
    {
        double squares = 0.0;
        for (int i = 0; i < 4; ++i) squares += weights[i] * weights[i] * mobility[vertices[i]];
        if (!(squares > 0.0)) return;
        for (int i = 0; i < 4; ++i)
            field[vertices[i]] += (weights[i] * mobility[vertices[i]] / squares) * change;
    }
};

/// Two points of the cloth that must keep apart: normal . difference(x') >= least_gap.
struct SelfContact : ClothPointPair {
    Vec3 normal;       ///< unit, from the second element to the first
    double least_gap;  ///< m: the thickness, or the gap at the step's begin where that was less
    double thickness;  ///< m, that the pair keeps: a share of the cloth's where a seam joins the elements
};

/// Share of the thickness that elements keep which a seam joins: far less than what counts as closed.
inline constexpr double kSeamShare = 0.1;

}  // namespace arris
