// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/scene_pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "app/scene/keys/scene_json.h"
#include "app/scene/keys/scene_keys.h"
#include "app/scene/pattern/garment_code.h"
#include "geometry/cloth_input/pattern/pattern_check.h"
#include "geometry/tolerances.h"

namespace arris {
namespace {

using Json = nlohmann::ordered_json;

std::string panel_names(const SewingPattern& pattern)
{
    std::string names;
    for (const Panel& panel : pattern.panels) names += (names.empty() ? "" : ", ") + panel.name;
    return names;
}

/// Number of the panel called `name`, which must exist; `key` is to blame.
int require_panel(const PieceSource& piece, const SewingPattern& pattern, const std::string& key,
                  const std::string& name)
{
    const int panel = find_panel(pattern, name);
    if (panel < 0)
        piece.document.fail(key, fmt::format("\"{}\" is not a panel", name),
                            "the name of a panel: " + panel_names(pattern));
    return panel;
}

// ---- panels

Placement to_placement(const Json& table)
{
    return {to_rotation(table["rotate"]), to_vec3(table["translate"])};
}

/// Gives names that a scene can refer to: other characters of a file's become _.
void rename_panels(SewingPattern& pattern)
{
    for (Panel& panel : pattern.panels) {
        if (is_scene_name(panel.name)) continue;
        std::string name = panel.name.substr(0, 60);
        for (char& c : name)
            if (!is_scene_name(std::string("_") + c)) c = '_';
        if (!is_scene_name(name)) name.insert(0, 1, '_');
        while (find_panel(pattern, name) >= 0) name += '_';
        panel.name = name;
    }
}

/// Moves panels of a file from their places.
void place_panels(const PieceSource& piece, SewingPattern& pattern)
{
    const Json panels = piece.json.value("panel", Json::array());
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const std::string key = fmt::format("{}.panel.{}.name", piece.key, i);
        Panel& panel =
            pattern.panels[static_cast<std::size_t>(require_panel(piece, pattern, key, panels[i]["name"]))];
        const Placement move = to_placement(panels[i]);
        panel.placement.rotation = move.rotation * panel.placement.rotation;
        panel.placement.translation += move.translation;  // about its own place
    }
}

Panel make_panel(const PieceSource& piece, std::size_t i)
{
    const Json& json = piece.json["panel"][i];
    Panel panel;
    panel.name = json["name"];
    panel.placement = to_placement(json);
    for (const Json& corner : json["outline"]) panel.edges.push_back({to_vec2(corner)});
    const Json edges = json.value("edges", Json::array());
    std::set<std::size_t> seen;
    for (std::size_t k = 0; k < edges.size(); ++k) {
        const auto number = edges[k]["edge"].get<std::size_t>();
        const std::string key = fmt::format("{}.panel.{}.edges.{}", piece.key, i, k);
        if (number >= panel.edges.size())
            piece.document.fail(key + ".edge", "is not an edge of the outline",
                                fmt::format("an integer from 0 to {}", panel.edges.size() - 1));
        if (!seen.insert(number).second)
            piece.document.fail(key + ".edge", "is there twice",
                                "each edge once, with its control and its label");
        PanelEdge& edge = panel.edges[number];
        edge.label = edges[k].value("label", "");
        if (!edges[k].contains("control")) continue;
        BezierCurve curve;
        for (const Json& point : edges[k]["control"]) curve.control.push_back(to_vec2(point));
        if (curve.control.size() > 2)
            piece.document.fail(key + ".control", "has too many points", "one or two control points");
        edge.shape = std::move(curve);
    }
    return panel;
}

// ---- seams

/// Reads one side: the shorter way along the outline between two corners, or that past a third one.
class SideReader {
  public:
    SideReader(const PieceSource& piece, const SewingPattern& pattern, const Json& side, std::string key)
        : piece_(piece),
          side_(side),
          key_(std::move(key)),
          panel_(require_panel(piece, pattern, key_, side[0])),
          curves_(curves_of(pattern.panels[static_cast<std::size_t>(panel_)])),
          count_(static_cast<int>(curves_.size()))
    {
    }

    SeamSide read() const
    {
        if (side_[1].is_array()) return read_line();
        std::vector<int> corners;
        for (std::size_t k = 1; k < side_.size(); ++k) corners.push_back(side_[k].get<int>());
        for (const int corner : corners)
            if (corner >= count_)
                piece_.document.fail(key_, fmt::format("has corner {}", corner),
                                     fmt::format("corners 0 to {} of the panel", count_ - 1));
        const int from = corners.front(), to = corners.back();
        if (from == to)
            piece_.document.fail(key_, "begins and ends at one corner", "a side from one corner to another");
        const SeamSide along = {panel_, from, steps(from, to), false},
                       against = {panel_, to, steps(to, from), true};
        if (corners.size() == 3) {
            if (corners[1] == from || corners[1] == to)
                piece_.document.fail(key_, "names an end twice", "a corner between its ends");
            return steps(from, corners[1]) < along.count ? along : against;
        }
        const double forward = length_of(along, curves_), backward = length_of(against, curves_);
        if (std::abs(forward - backward) <= kThreeDigits * forward)
            piece_.document.fail(key_, "has two ways of one length along the outline",
                                 "a corner between its ends, as [\"front\", 0, 1, 2]");
        return forward < backward ? along : against;
    }

  private:
    SeamSide read_line() const
    {
        SeamSide side{panel_, 0, 0, false, {}};
        for (std::size_t k = 1; k < side_.size(); ++k) side.line.push_back(to_vec2(side_[k]));
        return side;
    }

    /// Edges from one corner to another, along the outline.
    int steps(int from, int to) const { return (to - from + count_) % count_; }

    const PieceSource& piece_;
    const Json& side_;
    std::string key_;
    int panel_;
    std::vector<EdgeCurve> curves_;
    int count_;
};

/// Whether two seams join the same edges in the same pairing, from whichever end.
bool joins_same(const Seam& a, const Seam& b)
{
    const auto are_same = [](SeamSide s, const SeamSide& t, bool is_reversed) {
        s.is_backward ^= is_reversed;
        return s == t;
    };
    for (const bool is_reversed : {false, true})
        for (const std::size_t k : {0U, 1U})
            if (are_same(a.sides[0], b.sides[k], is_reversed) &&
                are_same(a.sides[1], b.sides[1 - k], is_reversed))
                return true;
    return false;
}

/// Adds the scene's seams. One that a file has, too, is given its order, or becomes a tie.
void add_seams(const PieceSource& piece, SewingPattern& pattern)
{
    const Json seams = piece.json.value("seam", Json::array());
    const auto of_file = static_cast<std::ptrdiff_t>(pattern.seams.size());
    for (std::size_t i = 0; i < seams.size(); ++i) {
        Seam seam;
        for (std::size_t k = 0; k < 2; ++k) {
            const std::string key = fmt::format("{}.seam.{}.join.{}", piece.key, i, k);
            seam.sides[k] = SideReader(piece, pattern, seams[i]["join"][k], key).read();
        }
        seam.order = seams[i]["order"].get<int>();
        seam.is_tie = seams[i]["as"] == "tie";
        const auto end = pattern.seams.begin() + of_file;
        const auto same = std::find_if(pattern.seams.begin(), end,
                                       [&](const Seam& other) { return joins_same(seam, other); });
        if (same == end) {
            pattern.seams.push_back(seam);
        } else {
            same->order = seam.order;
            same->is_tie = same->is_tie || seam.is_tie;
        }
    }
}

SewingPattern read_file(const PieceSource& piece, std::vector<std::string>& notes)
{
    GarmentCodeOptions options;
    options.up = piece.json["up"].get<std::string>()[0];
    options.order =
        piece.json["rotation_order"] == "xyz" ? RotationOrder::XThenYThenZ : RotationOrder::ZThenYThenX;
    GarmentCodePattern read =
        blame(piece, "pattern_file", [&] { return read_garment_code(piece.file("pattern_file"), options); });
    for (const std::string& note : read.notes)
        notes.push_back(fmt::format("{}: {}", piece.document.describe(piece.at("pattern_file")), note));
    rename_panels(read.pattern);
    place_panels(piece, read.pattern);
    return std::move(read.pattern);
}

/// Checks a scene's own panels before curves are made of them: each by itself.
SewingPattern make_panels(const PieceSource& piece)
{
    SewingPattern pattern;
    for (std::size_t i = 0; i < piece.json["panel"].size(); ++i) {
        pattern.panels.push_back(make_panel(piece, i));
        SewingPattern alone{{pattern.panels.back()}, {}};
        blame(piece, fmt::format("panel.{}", i), [&] { check_pattern(alone); });
    }
    return pattern;
}

}  // namespace

SewingPattern read_pattern(const PieceSource& piece, std::vector<std::string>& notes,
                           std::vector<std::string>& warnings)
{
    SewingPattern pattern =
        piece.json.contains("pattern_file") ? read_file(piece, notes) : make_panels(piece);
    add_seams(piece, pattern);
    std::vector<char> was_tie;
    for (const Seam& seam : pattern.seams) was_tie.push_back(seam.is_tie);
    blame(piece, piece.json.contains("seam") ? "seam" : "panel", [&] { check_seam_edges(pattern); });
    agree_on_sides(pattern);
    for (std::size_t s = 0; s < was_tie.size(); ++s)
        if (pattern.seams[s].is_tie && !was_tie[s])
            warnings.push_back(
                fmt::format("{}: {} joins a right side to a wrong side, and so becomes a tie: write its "
                            "sides so that they meet in the other direction, or as = \"tie\"",
                            piece.document.describe(piece.key), seam_in_words(pattern, static_cast<int>(s))));
    blame(piece, piece.json.contains("seam") ? "seam" : "panel", [&] { check_pattern(pattern); });
    return pattern;
}

}  // namespace arris
