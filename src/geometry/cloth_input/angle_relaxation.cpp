// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/angle_relaxation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/cloth/cloth_mesh.h"
#include "geometry/sort_unique.h"

namespace arris {
namespace {

constexpr double kAim = 0.5;         // sine of 30 degrees: larger angles are left unchanged
constexpr double kLeastGain = 1e-3;  // least gain of the sine for which a vertex moves
constexpr int kSweeps = 12;
constexpr int kDirections = 8;
constexpr std::array<double, 4> kSteps = {0.2, 0.1, 0.05, 0.025};  // of the length scale

// Faces around each vertex v: the entries start[v] to start[v + 1] - 1 of `faces`.
struct Stars {
    std::vector<int> start, faces;
};

Stars make_stars(std::size_t vertex_count, const std::vector<Face>& faces)
{
    Stars stars;
    stars.start.assign(vertex_count + 1, 0);
    for (const Face& face : faces)
        for (const int v : face) ++stars.start[v + 1];
    for (std::size_t v = 0; v < vertex_count; ++v) stars.start[v + 1] += stars.start[v];
    stars.faces.resize(3 * faces.size());
    std::vector<int> next(stars.start.begin(), stars.start.end() - 1);
    for (int f = 0; f < static_cast<int>(faces.size()); ++f)
        for (const int v : faces[f]) stars.faces[next[v]++] = f;
    return stars;
}

class Relaxation {
  public:
    Relaxation(const std::vector<Face>& faces, const std::vector<Freedom>& freedom, double length,
               std::vector<Vec2>& places)
        : faces_(faces),
          freedom_(freedom),
          length_(length),
          places_(places),
          stars_(make_stars(places.size(), faces))
    {
    }

    void run()
    {
        for (int sweep = 0; sweep < kSweeps; ++sweep)
            if (!improve_all(bad_vertices())) return;
    }

  private:
    double sine_of(int face) const
    {
        const auto& [a, b, c] = faces_[face];
        return least_sine(places_[a], places_[b], places_[c]);
    }

    // Least sine of the faces around `v` if `v` were at `place`.
    double sine_around(int v, const Vec2& place)
    {
        const Vec2 before = places_[v];
        places_[v] = place;
        double least = std::numeric_limits<double>::infinity();
        for (int k = stars_.start[v]; k < stars_.start[v + 1]; ++k)
            least = std::min(least, sine_of(stars_.faces[k]));
        places_[v] = before;
        return least;
    }

    std::vector<int> bad_vertices() const
    {
        std::vector<int> bad;
        for (int f = 0; f < static_cast<int>(faces_.size()); ++f) {
            if (sine_of(f) >= kAim) continue;
            for (const int v : faces_[f])
                if (!freedom_[v].is_fixed) bad.push_back(v);
        }
        sort_unique(bad);
        return bad;
    }

    std::vector<Vec2> directions_of(int v) const
    {
        if (freedom_[v].is_on_line) return {freedom_[v].along, -freedom_[v].along};
        std::vector<Vec2> directions;
        for (int k = 0; k < kDirections; ++k) {
            const double angle = 2.0 * std::numbers::pi * k / kDirections;
            directions.emplace_back(std::cos(angle), std::sin(angle));
        }
        return directions;
    }

    bool improve(int v)
    {
        Vec2 best = places_[v];
        double best_sine = sine_around(v, best);
        if (best_sine >= kAim) return false;
        const Vec2 from = best;
        bool is_better = false;
        for (const double step : kSteps) {
            for (const Vec2& direction : directions_of(v)) {
                const Vec2 place = from + step * length_ * direction;
                const double sine = sine_around(v, place);
                if (!(sine > best_sine + kLeastGain)) continue;
                best = place;
                best_sine = sine;
                is_better = true;
            }
        }
        places_[v] = best;
        return is_better;
    }

    bool improve_all(const std::vector<int>& vertices)
    {
        bool is_better = false;
        for (const int v : vertices) is_better = improve(v) || is_better;
        return is_better;
    }

    const std::vector<Face>& faces_;
    const std::vector<Freedom>& freedom_;
    double length_;
    std::vector<Vec2>& places_;
    Stars stars_;
};

}  // namespace

double least_sine(const Vec2& a, const Vec2& b, const Vec2& c)
{
    // The least angle lies between the two longer sides: sin = 2 A / (l2 l3).
    std::array<double, 3> squared = {(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()};
    std::sort(squared.begin(), squared.end());
    return twice_area(a, b, c) / std::sqrt(squared[1] * squared[2]);
}

void relax_angles(const std::vector<Face>& faces, const std::vector<Freedom>& freedom, double length,
                  std::vector<Vec2>& places)
{
    Relaxation(faces, freedom, length, places).run();
}

}  // namespace arris
