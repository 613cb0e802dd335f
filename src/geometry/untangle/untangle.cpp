// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/untangle/untangle.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "geometry/check/penetration.h"
#include "geometry/self_contact/self_contact_search.h"
#include "geometry/untangle/move_check.h"

namespace arris {

namespace {

/// Greatest move of a vertex at once, of the mean length of the cloth's edges where it crosses. The ways are
/// linear in the move. Raising it makes fewer moves, which overshoot.
constexpr double kStep = 0.5;

/// Distance over which a move decays, of the distance that the sheets have to move: strain is about its
/// inverse. At least kLeastReach edges, so that single faces do not fold. Raising either moves more cloth.
constexpr double kReachPerWay = 10.0, kLeastReach = 4.0;

constexpr int kMostMoves = 200;  // about 100 edges of depth
/// Share of the ways' sum by which a state with as many pairs is better. Raising it waits longer for little.
constexpr double kProgress = 0.95;
constexpr int kPatience = 10;         // moves without a better state, after which longer ways are tried
constexpr int kMostWays = 5;          // of a contour that are tried: four parts, and the shorter contour
constexpr int kMostRounds = 8;        // checks of a move; what each finds becomes rows of the next solve
constexpr int kFreeRounds = 3;        // after these, each round halves the move as well
constexpr int kMostHalvings = 3;      // of a move; one that is shorter still is blocked
constexpr int kMostWidenings = 20;    // moves that widen gaps
constexpr double kGapReached = 0.99;  // of the thickness: a gap that needs no widening

/// The way of each contour that is taken, and its rows.
struct Plan {
    std::vector<WayApart> ways;
    double distance = 0.0;  ///< m, sum of the ways'
};

class Untangler {
  public:
    Untangler(const UntangleRequest& request, const ClothMesh& mesh)
        : thickness_(request.thickness),
          mesh_(mesh, request),
          check_(mesh_, request),
          is_tangled_(mesh_.surface().faces.size(), 0),
          crossings_(find_crossings(mesh_, mesh_.positions)),
          edge_length_(mean_edge_length(crossings()))
    {
    }

    const CollisionMesh& mesh() const { return mesh_; }
    const std::vector<std::array<int, 2>>& crossings() const { return crossings_.to_untangle; }
    int moves() const { return moves_; }

    /// Moves until no pair crosses, or no way leads further; then takes the best state.
    void part()
    {
        struct Best {
            std::size_t pairs;
            double distance;
            std::vector<Vec3> positions;
            Crossings crossings;
        };
        if (!(edge_length_ > 0.0)) return;
        Plan plan = make_plan(0);
        Best best{crossings().size(), plan.distance, mesh_.positions, crossings_};
        for (int rank = 0, idle = 0; moves_ < kMostMoves && !crossings().empty();) {
            const bool is_moved = make_moves(plan);
            if (is_moved) plan = make_plan(rank);
            const auto score = std::pair(crossings().size(), plan.distance);
            if (is_moved && score < std::pair(best.pairs, kProgress * best.distance)) {
                best = {crossings().size(), plan.distance, mesh_.positions, crossings_};
                idle = 0;
            } else if (!is_moved || ++idle > kPatience) {
                if (++rank == kMostWays) break;
                idle = 0;
                mesh_.positions = best.positions;
                crossings_ = best.crossings;
                plan = make_plan(rank);
                best.distance = plan.distance;
            }
        }
        mesh_.positions = std::move(best.positions);
        crossings_ = std::move(best.crossings);
    }

    /// Widens the gaps between surfaces that crossed.
    void widen()
    {
        for (int i = 0; i < kMostWidenings; ++i) {
            const std::vector<MoveRow> rows = find_narrow();
            if (rows.empty()) return;
            Plan plan;
            plan.ways.push_back({thickness_, rows, {}});
            if (!make_move(plan)) return;
        }
    }

  private:
    double mean_edge_length(const std::vector<std::array<int, 2>>& pairs) const
    {
        double sum = 0.0;
        int count = 0;
        for (const std::array<int, 2>& pair : pairs)
            for (const int f : pair)
                for (int k = 0; mesh_.is_cloth(f) && k < 3; ++k, ++count) {
                    const Face& face = mesh_.surface().faces[f];
                    sum += (mesh_.positions[face[k]] - mesh_.positions[face[(k + 1) % 3]]).norm();
                }
        return count > 0 ? sum / count : 0.0;
    }

    /// Edges over which a move decays, by the way that the sheets go.
    double reach_of(double distance) const
    {
        return std::max(kLeastReach, kReachPerWay * distance / edge_length_);
    }

    /// Brings the ways that are not much longer than the shortest one into the order of their work.
    void sort_by_work(std::vector<WayApart>& ways) const
    {
        const double shortest = ways.front().distance;
        const auto end = std::find_if(ways.begin(), ways.end(), [&](const WayApart& way) {
            return way.distance > kSimilarWay * shortest;
        });
        if (end - ways.begin() < 2) return;
        std::vector<std::pair<double, int>> order;
        for (auto way = ways.begin(); way != end; ++way)
            order.push_back({find_smooth_move(mesh_, way->rows, reach_of(shortest)).work,
                             static_cast<int>(way - ways.begin())});
        std::sort(order.begin(), order.end());
        std::vector<WayApart> sorted;
        for (const auto& [work, index] : order) sorted.push_back(std::move(ways[index]));
        std::move(sorted.begin(), sorted.end(), ways.begin());
    }

    /// Takes the way of this rank for each contour, or its last one.
    Plan make_plan(int rank)
    {
        Plan plan;
        const std::vector<Contour> contours = find_contours(mesh_, crossings());
        for (std::vector<WayApart>& ways :
             find_ways_apart(mesh_, contours, {thickness_, kStep * edge_length_})) {
            if (ways.empty()) continue;
            sort_by_work(ways);
            WayApart& way = ways[std::min<std::size_t>(rank, ways.size() - 1)];
            plan.distance += way.distance;
            plan.ways.push_back(std::move(way));
        }
        return plan;
    }

    /// Moves the cloth along all ways together, or else along each alone: one that is blocked stops no other.
    bool make_moves(const Plan& plan)
    {
        bool is_moved = make_move(plan);
        if (is_moved || plan.ways.size() < 2) return is_moved;
        for (std::size_t w = 0; w < plan.ways.size() && moves_ < kMostMoves; ++w)
            is_moved = make_move({{plan.ways[w]}, plan.ways[w].distance}) || is_moved;
        return is_moved;
    }

    /// Moves the cloth as planned, as far as it may; false where it may not move.
    bool make_move(const Plan& plan)
    {
        ++moves_;
        std::vector<MoveRow> rows;
        double farthest = 0.0;
        for (const WayApart& way : plan.ways) {
            rows.insert(rows.end(), way.rows.begin(), way.rows.end());
            farthest = std::max(farthest, way.distance);
        }
        if (rows.empty()) return false;
        const std::size_t planned = rows.size();
        farthest_ = std::max(farthest_, farthest);
        const double reach = reach_of(farthest_);
        std::vector<Vec3> move = find_smooth_move(mesh_, rows, reach).move;
        double greatest = 0.0;
        for (const Vec3& u : move) greatest = std::max(greatest, u.norm());
        if (!(greatest > 0.0) || !std::isfinite(greatest)) return false;
        const double share = std::min(1.0, kStep * edge_length_ / greatest);
        for (Vec3& u : move) u *= share;
        for (std::size_t r = 0; r < planned; ++r) rows[r].change *= share;

        for (int round = 0, halvings = 0; round < kMostRounds; ++round) {
            std::vector<Vec3> end = mesh_.positions;
            for (std::size_t v = 0; v < end.size(); ++v) end[v] += move[v];
            MoveFinding finding = check_.check(end, plan.ways, crossings_);
            if (finding.is_clean) {
                mesh_.positions = std::move(end);
                crossings_ = std::move(finding.after);
                for (const WayApart& way : plan.ways)
                    for (const std::vector<int>& side : way.sides)
                        for (const int f : side) is_tangled_[f] = 1;
                return true;
            }
            for (const SelfContact& contact : finding.violations)
                rows.push_back(row_of(contact, contact.least_gap));
            if (round >= kFreeRounds || finding.violations.empty()) {
                if (++halvings > kMostHalvings) return false;
                for (std::size_t r = 0; r < planned; ++r) rows[r].change *= 0.5;
            }
            move = find_smooth_move(mesh_, rows, reach).move;
        }
        return false;
    }

    /// Row that brings a contact to a gap.
    MoveRow row_of(const SelfContact& contact, double gap) const
    {
        MoveRow row;
        for (int i = 0; i < 4; ++i)
            row.terms.push_back({contact.vertices[i], contact.weights[i] * contact.normal});
        row.change = gap - contact.normal.dot(contact.difference(mesh_.positions));
        return row;
    }

    /// Rows for contacts of faces that crossed whose gap is less than the thickness.
    std::vector<MoveRow> find_narrow() const
    {
        const SelfSurface& surface = mesh_.surface();
        std::vector<char> was_tangled(mesh_.positions.size(), 0);
        for (std::size_t f = 0; f < is_tangled_.size(); ++f)
            for (int k = 0; is_tangled_[f] && k < 3; ++k) was_tangled[surface.faces[f][k]] = 1;
        std::vector<MoveRow> rows;
        for (const SelfContact& contact :
             find_self_contacts(surface, {mesh_.positions, mesh_.positions}, thickness_)) {
            const bool crossed = std::all_of(contact.vertices.begin(), contact.vertices.end(),
                                             [&](int v) { return was_tangled[v]; });
            const bool may_move = std::any_of(contact.vertices.begin(), contact.vertices.end(),
                                              [&](int v) { return mesh_.may_move(v); });
            MoveRow row = row_of(contact, thickness_);
            if (crossed && may_move && row.change > (1.0 - kGapReached) * thickness_)
                rows.push_back(std::move(row));
        }
        return rows;
    }

    double thickness_;
    CollisionMesh mesh_;
    MoveCheck check_;
    std::vector<char> is_tangled_;  // of each face: it was on a side of a way
    Crossings crossings_;           // at present
    double edge_length_;            // m, mean of the cloth where it crosses at first
    double farthest_ = 0.0;         // m, the longest way so far: its last part spreads as far as its first
    int moves_ = 0;
};

/// Obstacles to untangle that enclose cloth, although no face crosses theirs.
std::vector<int> find_enclosing(const UntangleRequest& request, const ClothMesh& mesh,
                                const std::vector<CrossingPair>& left)
{
    std::vector<int> enclosing;
    for (std::size_t o = 0; o < request.obstacles.size(); ++o) {
        const auto& [pose, rule] = request.obstacles[o];
        const int index = static_cast<int>(o);
        if (rule != StartRule::Untangle ||
            std::any_of(left.begin(), left.end(), [&](const auto& pair) { return pair.obstacle == index; }))
            continue;
        if (find_penetration(pose, to_local(pose.placement, mesh.world), mesh.faces).depth > 0.0)
            enclosing.push_back(index);
    }
    return enclosing;
}

void add_change(const ClothMesh& before, const ClothMesh& after, UntangleReport& report)
{
    for (int v = 0; v < before.vertex_count(); ++v) {
        const double way = (after.world[v] - before.world[v]).norm();
        report.moved_vertices += way > 0.0;
        report.greatest_displacement = std::max(report.greatest_displacement, way);
    }
    for (const Face& face : before.faces)
        for (int k = 0; k < 3; ++k) {
            const int a = face[k], b = face[(k + 1) % 3];
            const double length = (before.world[a] - before.world[b]).norm();
            const double change = std::abs((after.world[a] - after.world[b]).norm() - length);
            if (length > 0.0) report.greatest_strain = std::max(report.greatest_strain, change / length);
        }
}

}  // namespace

UntangleReport untangle(const UntangleRequest& request, ClothMesh& mesh)
{
    assert(request.thickness > 0.0);
    UntangleReport report;
    const auto is_to_untangle = [](const StartObstacle& o) { return o.rule == StartRule::Untangle; };
    if (request.self != StartRule::Untangle &&
        std::none_of(request.obstacles.begin(), request.obstacles.end(), is_to_untangle))
        return report;
    Untangler untangler(request, mesh);
    report.crossings_before = static_cast<int>(untangler.crossings().size());
    if (report.crossings_before > 0) {
        untangler.part();
        if (untangler.crossings().empty()) untangler.widen();
        ClothMesh moved = mesh;
        std::copy_n(untangler.mesh().positions.begin(), mesh.vertex_count(), moved.world.begin());
        add_change(mesh, moved, report);
        mesh = std::move(moved);
    }
    report.moves = untangler.moves();
    for (const std::array<int, 2>& pair : untangler.crossings())
        report.left.push_back(untangler.mesh().name(pair));
    report.still_inside = find_enclosing(request, mesh, report.left);
    return report;
}

}  // namespace arris
