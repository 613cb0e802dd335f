// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/pattern/seam_parting.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "geometry/cloth_input/angle_relaxation.h"

namespace arris {
namespace {

// Passes over edges that become one when sewn. A pass that divides them may make another such pair beside a
// tip; two passes were enough in all patterns tried.
constexpr int kMostPasses = 8;

// An edge between vertices a and b, and the faces beside it: (a, b, c), and (b, a, d) inside the panel.
struct PanelFaceEdge {
    int a = 0, b = 0;
    int face = 0, other_face = -1;
    int c = 0, d = -1;

    bool is_inner() const { return other_face >= 0; }
};

class SeamParting {
  public:
    SeamParting(const SewnNumbers& sewn, std::vector<Vec2>& places, std::vector<Face>& faces)
        : sewn_(sewn), places_(places), faces_(faces)
    {
    }

    void run()
    {
        // Each pass removes at least one edge between vertices on seams, and adds none.
        while (change(&SeamParting::edges_between_seams, /*may_flip=*/true)) continue;
        divide_lone_faces();
        for (int pass = 0; pass < kMostPasses; ++pass)
            if (!change(&SeamParting::edges_that_coincide, /*may_flip=*/false)) return;
    }

  private:
    using Edges = std::vector<PanelFaceEdge>;

    bool is_on_seam(int v) const { return v < static_cast<int>(sewn_.size()) && sewn_[v] >= 0; }

    // Vertices as they are once the panel is sewn; those on no seam have numbers of their own.
    int sewn_number(int v) const { return is_on_seam(v) ? -1 - sewn_[v] : v; }

    // All edges, by their vertices.
    Edges find_edges() const
    {
        Edges halves;
        for (int f = 0; f < static_cast<int>(faces_.size()); ++f)
            for (int k = 0; k < 3; ++k)
                halves.push_back({faces_[f][k], faces_[f][(k + 1) % 3], f, -1, faces_[f][(k + 2) % 3], -1});
        const auto key = [](const PanelFaceEdge& e) {
            return std::tuple(std::min(e.a, e.b), std::max(e.a, e.b), e.a);
        };
        std::sort(halves.begin(), halves.end(),
                  [&](const PanelFaceEdge& e, const PanelFaceEdge& f) { return key(e) < key(f); });
        Edges edges;
        for (const PanelFaceEdge& half : halves) {
            if (!edges.empty() && edges.back().a == half.b && edges.back().b == half.a) {
                edges.back().other_face = half.face;
                edges.back().d = half.c;
            } else {
                edges.push_back(half);
            }
        }
        return edges;
    }

    Edges edges_between_seams() const
    {
        Edges found;
        for (const PanelFaceEdge& edge : find_edges())
            if (edge.is_inner() && is_on_seam(edge.a) && is_on_seam(edge.b)) found.push_back(edge);
        return found;
    }

    // Inner edges that another edge coincides with. Of several the first stays, or one on the border.
    Edges edges_that_coincide() const
    {
        Edges edges = find_edges();
        const auto key = [&](const PanelFaceEdge& e) {
            const auto [low, high] = std::minmax({sewn_number(e.a), sewn_number(e.b)});
            return std::tuple(low, high, e.is_inner());
        };
        std::stable_sort(edges.begin(), edges.end(),
                         [&](const PanelFaceEdge& e, const PanelFaceEdge& f) { return key(e) < key(f); });
        Edges found;
        for (std::size_t k = 1; k < edges.size(); ++k) {
            const auto [low, high, is_inner] = key(edges[k]);
            const auto [low_before, high_before, was_inner] = key(edges[k - 1]);
            if (is_inner && low == low_before && high == high_before) found.push_back(edges[k]);
        }
        return found;
    }

    // Flips or divides the edges of `find`, but for those beside a face that has changed already. False where
    // there are none.
    bool change(Edges (SeamParting::*find)() const, bool may_flip)
    {
        const Edges edges = (this->*find)();
        std::vector<char> is_changed(faces_.size(), 0);
        for (const PanelFaceEdge& edge : edges) {
            if (is_changed[edge.face] != 0 || is_changed[edge.other_face] != 0) continue;
            is_changed[edge.face] = is_changed[edge.other_face] = 1;
            if (may_flip && flips_better(edge))
                flip(edge);
            else
                divide(edge);
        }
        return !edges.empty();
    }

    double sine(int a, int b, int c) const { return least_sine(places_[a], places_[b], places_[c]); }

    bool flips_better(const PanelFaceEdge& e) const
    {
        if (is_on_seam(e.c) && is_on_seam(e.d)) return false;
        const Vec2 m = 0.5 * (places_[e.a] + places_[e.b]);
        const auto sine_with = [&](int v, int w) { return least_sine(m, places_[v], places_[w]); };
        const double divided =
            std::min({sine_with(e.b, e.c), sine_with(e.c, e.a), sine_with(e.a, e.d), sine_with(e.d, e.b)});
        return std::min(sine(e.a, e.d, e.c), sine(e.d, e.b, e.c)) > divided;
    }

    void flip(const PanelFaceEdge& e)
    {
        faces_[e.face] = {e.a, e.d, e.c};
        faces_[e.other_face] = {e.d, e.b, e.c};
    }

    int add(const Vec2& place)
    {
        places_.push_back(place);
        return static_cast<int>(places_.size()) - 1;
    }

    void divide(const PanelFaceEdge& e)
    {
        const int m = add(0.5 * (places_[e.a] + places_[e.b]));
        faces_[e.face] = {e.a, m, e.c};
        faces_[e.other_face] = {m, e.a, e.d};
        faces_.push_back({m, e.b, e.c});
        faces_.push_back({e.b, m, e.d});
    }

    // A face with all corners on seams and no inner edge is a whole panel.
    void divide_lone_faces()
    {
        if (faces_.size() > 1) return;
        const auto [a, b, c] = faces_[0];
        const int m = add((places_[a] + places_[b] + places_[c]) / 3.0);
        faces_ = {{a, b, m}, {b, c, m}, {c, a, m}};
    }

    const SewnNumbers& sewn_;
    std::vector<Vec2>& places_;
    std::vector<Face>& faces_;
};

}  // namespace

void part_seams(const SewnNumbers& sewn, double length, std::vector<Vec2>& places, std::vector<Face>& faces)
{
    const std::size_t before = places.size();
    const std::vector<Face> faces_before = faces;
    SeamParting(sewn, places, faces).run();
    if (places.size() == before && faces == faces_before) return;
    std::vector<Freedom> freedom(places.size());
    for (std::size_t v = 0; v < sewn.size(); ++v) freedom[v].is_fixed = true;
    relax_angles(faces, freedom, length, places);
}

}  // namespace arris
