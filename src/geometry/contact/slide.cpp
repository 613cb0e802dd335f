// SPDX-License-Identifier: GPL-3.0-or-later
//
// A vertex slides along obstacle faces in straight legs. A leg ends one thickness before the face it meets,
// or at its initial distance if that is less. The rest of the way loses its component into that face. Where
// the rest leads into an earlier face, only its component along the crease of both faces remains. Exact
// predicates decide whether a leg touches, for its end points in doubles. So a shortened leg is tested again.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/batches.h"
#include "geometry/contact/obstacle_contact.h"
#include "geometry/tolerances.h"

namespace arris {
namespace {

constexpr int kMostLegs = 4;
constexpr int kMostCuts = 8;  // halvings of a leg that still touches because of rounding, before it
                              // is dropped

using Triangle = std::array<Vec3, 3>;

// A face in the way, met at fraction `time` of the leg. `normal` points to the side where the leg began.
struct Obstruction {
    double time = std::numeric_limits<double>::infinity();
    double height = 0.0;    // of the leg's begin above the face's plane, m, >= 0
    double approach = 0.0;  // component of the leg into the face, m
    Vec3 normal = Vec3::Zero();
};

// The smallest fraction of a way in the triangle's plane at which it is inside the triangle; 1 if rounding
// hides it.
double time_in_plane(const Vec3& a, const Vec3& way, const Triangle& triangle, const Vec3& normal)
{
    double enter = 0.0, leave = 1.0;
    for (int i = 0; i < 3; ++i) {
        const Vec3 inward = normal.cross(triangle[(i + 1) % 3] - triangle[i]);
        const double inside = inward.dot(a - triangle[i]), gain = inward.dot(way);
        if (gain > 0.0) enter = std::max(enter, -inside / gain);
        if (gain < 0.0) leave = std::min(leave, -inside / gain);
    }
    return enter <= leave ? enter : 1.0;
}

Obstruction meet(const Vec3& a, const Vec3& way, const Triangle& triangle, const Vec3& normal)
{
    Obstruction met;
    const double height = normal.dot(a - triangle[0]);
    const double approach = -normal.dot(way);
    // The exact test found a touch, so the leg begins on the side from which it comes.
    met.normal = approach > 0.0 ? normal : Vec3(-normal);
    met.approach = std::abs(approach);
    met.height = std::max(approach > 0.0 ? height : -height, 0.0);
    if (met.approach > kComputed * way.norm()) {
        met.time = std::min(met.height / met.approach, 1.0);
    } else {
        met.time = time_in_plane(a, way, triangle, normal);
    }
    return met;
}

class Slide {
  public:
    Slide(const Obstacle& obstacle, double thickness) : obstacle_(obstacle), thickness_(thickness) {}

    Vec3 operator()(const Vec3& begin, const Vec3& end)
    {
        Vec3 place = begin, way = end - begin;
        if (!touches(begin, end)) return end;
        normal_count_ = 0;
        for (int leg = 0; leg < kMostLegs && touches(place, place + way); ++leg) {
            const Obstruction met = first_met(place, way);
            // A way in the face's own plane, head on against the rim of a sheet, has no plane to slide along.
            if (!(met.approach > kComputed * way.norm()))
                return free_point(place, std::max(met.time - thickness_ / way.norm(), 0.0) * way);
            const double time = std::clamp((met.height - thickness_) / met.approach, 0.0, met.time);
            const Vec3 next = free_point(place, time * way);
            way = along_planes(met.normal, (1.0 - time) * way);
            place = next;
            if (!(way.squaredNorm() > 0.0)) return place;
        }
        return touches(place, place + way) ? place : Vec3(place + way);
    }

  private:
    bool touches(const Vec3& a, const Vec3& b)
    {
        obstacle_.find_faces_touching(a, b, found_);
        return !found_.empty();
    }

    // The first of the faces in `found_`; of several met at once, the one that blocks most of the way.
    Obstruction first_met(const Vec3& place, const Vec3& way) const
    {
        Obstruction first;
        for (const int f : found_) {
            const Face& corners = obstacle_.mesh().faces[f];
            const std::vector<Vec3>& points = obstacle_.mesh().points;
            const Obstruction met =
                meet(place, way, {points[corners[0]], points[corners[1]], points[corners[2]]},
                     obstacle_.topology().face_normals[f]);
            const bool is_sooner = met.time < first.time - kAccumulated;
            const bool is_together = std::abs(met.time - first.time) <= kAccumulated;
            if (is_sooner || (is_together && met.approach > first.approach)) first = met;
        }
        return first;
    }

    // `place + way`, or less of the way where rounding makes it touch.
    Vec3 free_point(const Vec3& place, Vec3 way)
    {
        for (int cut = 0; cut < kMostCuts; ++cut, way *= 0.5)
            if (!touches(place, place + way)) return place + way;
        return place;
    }

    // Removes from a way its components into the plane just met and the planes met before.
    Vec3 along_planes(const Vec3& normal, const Vec3& way)
    {
        Vec3 left = way - normal.dot(way) * normal;
        const double least = kComputed * way.norm();
        for (int i = 0; i < normal_count_; ++i) {
            if (normals_[i].dot(left) >= -least) continue;
            const Vec3 crease = normal.cross(normals_[i]);
            const double squared = crease.squaredNorm();
            if (!(squared > kLevel * kLevel)) continue;
            left = crease.dot(left) / squared * crease;
            for (int k = 0; k < normal_count_; ++k)
                if (normals_[k].dot(left) < -least) left = Vec3::Zero();  // blocked in a corner
        }
        normals_[normal_count_++] = normal;
        return left;
    }

    const Obstacle& obstacle_;
    double thickness_;
    std::vector<int> found_;
    std::array<Vec3, kMostLegs> normals_;
    int normal_count_ = 0;
};

}  // namespace

std::vector<Vec3> slide(const Obstacle& obstacle, const ClothMotion& motion, double thickness)
{
    const auto find = [&](int first, int last, std::vector<Vec3>& reference) {
        Slide slide_vertex(obstacle, thickness);
        for (int v = first; v < last; ++v) {
            const Vec3 &begin = motion.begin[v], &end = motion.end[v];
            const Box3 box(begin.cwiseMin(end), begin.cwiseMax(end));
            const bool is_near = end.allFinite() && obstacle.bounds().intersects(box);
            reference.push_back(is_near ? slide_vertex(begin, end) : end);
        }
    };
    return collect_in_batches<Vec3>(static_cast<int>(motion.begin.size()), find);
}

}  // namespace arris
