// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <vector>

#include "geometry/obstacle/obstacle_mesh.h"

namespace arris {

/// A bar along x with a square section, which bends upwards in its middle like an elbow.
struct ElbowBody {
    double thick = 0.06;  ///< m, side of the section
    double leg = 0.2;     ///< m, straight parts on both sides of the bend
    double gap = 0.0;     ///< m, between the legs where the bend is a half turn; negative: they overlap
    double cell = 0.01;   ///< m

    double bend_length() const { return M_PI * 0.5 * (thick + gap); }

    /// The straight bar.
    ObstacleMesh make() const
    {
        const int side = static_cast<int>(std::lround(thick / cell)), around = 4 * side;
        const int along = static_cast<int>(std::ceil((2.0 * leg + bend_length()) / cell));
        ObstacleMesh mesh;
        for (int i = 0; i <= along; ++i) {
            const double x = -leg + i * (2.0 * leg + bend_length()) / along;
            for (int k = 0; k < around; ++k) {
                const double t = thick * (k % side) / side - 0.5 * thick, h = 0.5 * thick;
                const Vec3 corners[] = {{x, t, -h}, {x, h, t}, {x, -t, h}, {x, -h, -t}};
                mesh.points.push_back(corners[k / side]);
            }
        }
        for (int i = 0; i < along; ++i)
            for (int k = 0; k < around; ++k) {
                const int a = i * around + k, b = i * around + (k + 1) % around;
                mesh.faces.push_back({a, b, a + around});
                mesh.faces.push_back({b, b + around, a + around});
            }
        const int first = static_cast<int>(mesh.points.size());
        mesh.points.push_back(Vec3(-leg, 0, 0));
        mesh.points.push_back(Vec3(leg + bend_length(), 0, 0));
        for (int k = 0; k < around; ++k) {
            const int next = (k + 1) % around;
            mesh.faces.push_back({first, next, k});
            mesh.faces.push_back({first + 1, along * around + k, along * around + next});
        }
        return mesh;
    }

    /// A point of the bar where it is bent by `angle` (rad).
    Vec3 bend(const Vec3& rest, double angle) const
    {
        const double s = std::min(std::max(rest.x(), 0.0), bend_length()), curvature = angle / bend_length();
        const double turn = curvature * s;
        const Vec3 along(std::cos(turn), 0.0, std::sin(turn)), up(-std::sin(turn), 0.0, std::cos(turn));
        const Vec3 middle = angle > 0.0
                                ? Vec3(std::sin(turn) / curvature, 0.0, (1.0 - std::cos(turn)) / curvature)
                                : Vec3(s, 0.0, 0.0);
        return middle + (rest.x() - s) * along + rest.z() * up + Vec3(0.0, rest.y(), 0.0);
    }

    std::vector<Vec3> bend(const std::vector<Vec3>& rest, double angle) const
    {
        std::vector<Vec3> bent;
        for (const Vec3& p : rest) bent.push_back(bend(p, angle));
        return bent;
    }
};

}  // namespace arris
