// SPDX-License-Identifier: GPL-3.0-or-later
//
// A vertex slides along what it meets, one straight leg after another. A leg is cut where it would come
// nearer to the face it meets than the thickness (or than it was), and the rest of the way loses its part
// into that face; where that leads into the face before, only the part along the crease of both is left.
// Whether a leg touches is decided by exact predicates, where it does in doubles: a leg that was cut is asked
// again.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/contact/contact_batches.h"
#include "geometry/contact/obstacle_contact.h"

namespace arris {
namespace {

constexpr int kMostLegs = 4;
constexpr int kMostCuts = 8;          // halvings of a leg that rounding let touch, then it is given up
constexpr double kSamePlane = 1e-12;  // share of a way below which its part into a plane is rounding
constexpr double kSameTime = 1e-9;    // fraction of a leg that two faces are met at together
constexpr double kCrease = 1e-6;      // sine of the angle between planes that make a crease

using Triangle = std::array<Vec3, 3>;

// A face in the way: met at a fraction of the leg, `normal` on the side where the leg began.
struct Obstruction {
    double time = std::numeric_limits<double>::infinity();
    double height = 0.0;    // of the leg's begin over the face's plane, m, >= 0
    double approach = 0.0;  // what the leg loses of it, m
    Vec3 normal = Vec3::Zero();
};

// The least fraction of a way in a triangle's plane that is in the triangle; 1 where rounding finds none.
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
    // The exact test says that it touches: the begin is on the side that the way comes from.
    met.normal = approach > 0.0 ? normal : Vec3(-normal);
    met.approach = std::abs(approach);
    met.height = std::max(approach > 0.0 ? height : -height, 0.0);
    if (met.approach > kSamePlane * way.norm()) {
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
            // Head on against the rim of a sheet there is no plane to go along.
            if (!(met.approach > kSamePlane * way.norm()))
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

    // Of the faces that `touches` found the first; of several at once the one that is most in the way.
    Obstruction first_met(const Vec3& place, const Vec3& way) const
    {
        Obstruction first;
        for (const int f : found_) {
            const Face& corners = obstacle_.mesh().faces[f];
            const std::vector<Vec3>& points = obstacle_.mesh().points;
            const Obstruction met =
                meet(place, way, {points[corners[0]], points[corners[1]], points[corners[2]]},
                     obstacle_.topology().face_normals[f]);
            const bool is_sooner = met.time < first.time - kSameTime;
            const bool is_together = std::abs(met.time - first.time) <= kSameTime;
            if (is_sooner || (is_together && met.approach > first.approach)) first = met;
        }
        return first;
    }

    // `place + way`, or less of the way where rounding let it touch.
    Vec3 free_point(const Vec3& place, Vec3 way)
    {
        for (int cut = 0; cut < kMostCuts; ++cut, way *= 0.5)
            if (!touches(place, place + way)) return place + way;
        return place;
    }

    // What is left of a way along the plane just met and those met before, if it leads into them.
    Vec3 along_planes(const Vec3& normal, const Vec3& way)
    {
        Vec3 left = way - normal.dot(way) * normal;
        const double least = kSamePlane * way.norm();
        for (int i = 0; i < normal_count_; ++i) {
            if (normals_[i].dot(left) >= -least) continue;
            const Vec3 crease = normal.cross(normals_[i]);
            const double squared = crease.squaredNorm();
            if (!(squared > kCrease * kCrease)) continue;
            left = crease.dot(left) / squared * crease;
            for (int k = 0; k < normal_count_; ++k)
                if (normals_[k].dot(left) < -least) left = Vec3::Zero();  // a corner
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
