// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/pattern/garment_code.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/scene/keys/scene_document.h"
#include "app/scene/pattern/json_place.h"
#include "app/text/counted.h"
#include "app/text/printable.h"
#include "geometry/cloth/piece_place.h"
#include "geometry/cloth_input/pattern/pattern_check.h"
#include "geometry/input_error.h"
#include "geometry/input_limits.h"
#include "geometry/tolerances.h"
#include "geometry/up_axis.h"

namespace arris {
namespace {

constexpr double kLeastUnits = 1e-3, kMostUnits = 1e6;  // in a metre
constexpr double kMostCurvature = 1e3;                  // of an edge's length
constexpr double kMostDegrees = 1e6;
constexpr std::size_t kLongestName = 200;  // bytes
constexpr const char* kCurvature =
    R"({"type": "quadratic", "cubic" or "circle", "params": [...]}, or [along, aside] of a quadratic curve)";

class GarmentCodeReader {
  public:
    GarmentCodeReader(const JsonPlace& root, const GarmentCodeOptions& options)
        : root_(root), pattern_place_(root.member("pattern")), options_(options)
    {
    }

    GarmentCodePattern read()
    {
        read_properties();
        read_panels();
        read_stitches();
        agree_on_sides(read_.pattern);
        note_orders();
        note_ties();
        return std::move(read_);
    }

  private:
    void read_properties()
    {
        const JsonPlace properties = root_.member("properties");
        metre_ = properties.member("units_in_meter").number(kLeastUnits, kMostUnits);
        if (!properties.has("curvature_coords")) return;
        const JsonPlace coordinates = properties.member("curvature_coords");
        if (coordinates.text() != "relative") coordinates.refuse(R"("relative")");
    }

    double length(const JsonPlace& place) const
    {
        return place.number(-kLargestCoordinate * metre_, kLargestCoordinate * metre_) / metre_;
    }

    Vec2 point(const JsonPlace& place) const
    {
        place.size(2, 2, "two lengths [u, v]");
        return {length(place.element(0)), length(place.element(1))};
    }

    // ---- panels

    void read_panels()
    {
        const JsonPlace panels = pattern_place_.member("panels");
        if (!panels.value().is_object() || panels.value().empty())
            panels.refuse("an object of one or more panels");
        if (panels.value().size() > static_cast<std::size_t>(kMaxPieces))
            panels.refuse(fmt::format("at most {} panels", kMaxPieces));
        for (const auto& item : panels.value().items()) {
            const JsonPlace place = panels.member(item.key());
            if (item.key().empty() || item.key().size() > kLongestName)
                place.refuse("has a name that is empty or too long",
                             fmt::format("1 to {} bytes", kLongestName));
            read_panel(item.key(), place);
        }
    }

    void read_panel(const std::string& name, const JsonPlace& place)
    {
        Panel panel;
        panel.name = name;
        panel.placement = read_placement(place);
        const JsonPlace edges = place.member("edges");
        const std::size_t count = edges.size(1, static_cast<std::size_t>(kMostPatternEdges),
                                             fmt::format("an array of 3 to {} edges", kMostPatternEdges));
        const std::vector<Vec2> corners = read_corners(place.member("vertices"), edges);
        for (std::size_t e = 0; e < count; ++e) {
            const JsonPlace edge = edges.element(e);
            const Vec2 chord = corners[(e + 1) % count] - corners[e];
            panel.edges.push_back({corners[e], {}, read_label(edge)});
            if (edge.has("curvature"))
                panel.edges.back().shape = read_curvature(edge.member("curvature"), corners[e], chord);
        }
        read_.pattern.panels.push_back(std::move(panel));
    }

    static std::string read_label(const JsonPlace& place)
    {
        return place.has("label") ? place.member("label").text() : "";
    }

    // The corners in the order of the edges, each of which begins where the one before it ends.
    std::vector<Vec2> read_corners(const JsonPlace& vertices, const JsonPlace& edges) const
    {
        const std::size_t most = static_cast<std::size_t>(kMostPatternEdges);
        const int count = static_cast<int>(
            vertices.size(1, most, fmt::format("an array of 3 to {} vertices [u, v]", most)));
        const std::size_t edge_count = edges.value().size();
        std::vector<std::array<int, 2>> ends;
        for (std::size_t e = 0; e < edge_count; ++e) {
            const JsonPlace endpoints = edges.element(e).member("endpoints");
            endpoints.size(2, 2, "two numbers of vertices");
            ends.push_back({endpoints.element(0).whole_number(0, count - 1),
                            endpoints.element(1).whole_number(0, count - 1)});
        }
        std::vector<Vec2> corners;
        for (std::size_t e = 0; e < edge_count; ++e) {
            const std::size_t before = (e + edge_count - 1) % edge_count;
            if (ends[before][1] != ends[e][0])
                edges.element(e)
                    .member("endpoints")
                    .refuse(fmt::format("begins at vertex {}, but edge {} ends at vertex {}", ends[e][0],
                                        before, ends[before][1]),
                            "edges in the order of a closed loop");
            corners.push_back(point(vertices.element(static_cast<std::size_t>(ends[e][0]))));
        }
        return corners;
    }

    std::variant<BezierCurve, CircularArc> read_curvature(const JsonPlace& place, const Vec2& begin,
                                                          const Vec2& chord) const
    {
        // Files before the kinds had names.
        if (place.value().is_array()) return BezierCurve{{relative(place, begin, chord)}};
        if (!place.value().is_object()) place.refuse(kCurvature);
        const JsonPlace type = place.member("type"), params = place.member("params");
        const std::string name = type.text();
        if (name == "circle") {
            params.size(3, 3, "[radius, large, right]");
            return CircularArc{length(params.element(0)), params.element(1).flag(), params.element(2).flag()};
        }
        if (name != "quadratic" && name != "cubic") type.refuse(R"("quadratic", "cubic" or "circle")");
        const std::size_t count = name == "quadratic" ? 1 : 2;
        params.size(count, count,
                    count == 1 ? "one control point [along, aside]" : "two control points [along, aside]");
        BezierCurve curve;
        for (std::size_t k = 0; k < count; ++k)
            curve.control.push_back(relative(params.element(k), begin, chord));
        return curve;
    }

    // A control point as shares of the chord, along it and to its left.
    static Vec2 relative(const JsonPlace& place, const Vec2& begin, const Vec2& chord)
    {
        place.size(2, 2, "[along, aside]");
        const double along = place.element(0).number(-kMostCurvature, kMostCurvature);
        const double aside = place.element(1).number(-kMostCurvature, kMostCurvature);
        return begin + along * chord + aside * Vec2(-chord.y(), chord.x());
    }

    Placement read_placement(const JsonPlace& place)
    {
        const JsonPlace translation = place.member("translation"), rotation = place.member("rotation");
        translation.size(3, 3, "three lengths [x, y, z]");
        rotation.size(3, 3, "three angles (degrees) [about x, about y, about z]");
        Placement placement;
        std::array<Mat3, 3> about;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto axis = static_cast<Eigen::Index>(k);
            placement.translation[axis] = length(translation.element(k));
            about[k] =
                rotation_about(Vec3::Unit(axis), rotation.element(k).number(-kMostDegrees, kMostDegrees));
        }
        const Mat3 simulated = about[2] * about[1] * about[0], written = about[0] * about[1] * about[2];
        if ((simulated - written).norm() > kComputed) in_doubt_.push_back(place.path());
        placement.rotation = options_.order == RotationOrder::XThenYThenZ ? simulated : written;
        return Placement{turn_to_z(options_.up), Vec3::Zero()} * placement;
    }

    // ---- stitches

    void read_stitches()
    {
        if (!pattern_place_.has("stitches")) return;
        const JsonPlace stitches = pattern_place_.member("stitches");
        const std::size_t count =
            stitches.size(0, static_cast<std::size_t>(kMostPatternEdges),
                          fmt::format("an array of at most {} stitches", kMostPatternEdges));
        for (std::size_t s = 0; s < count; ++s) {
            const JsonPlace stitch = stitches.element(s);
            const std::size_t items = stitch.size(2, 3, R"([side, side] or [side, side, "right_wrong"])");
            Seam seam;
            for (std::size_t k = 0; k < 2; ++k) seam.sides[k] = read_side(stitch.element(k));
            const bool is_right_to_wrong = items == 3;
            if (is_right_to_wrong && stitch.element(2).text() != "right_wrong")
                stitch.element(2).refuse(R"("right_wrong")");
            seam.sides[1].is_backward = !is_right_to_wrong;
            read_.pattern.seams.push_back(seam);
        }
    }

    SeamSide read_side(const JsonPlace& place) const
    {
        const JsonPlace panel = place.member("panel");
        SeamSide side;
        const std::string name = panel.text();
        // Panels are in the order of their names.
        const auto& panels = read_.pattern.panels;
        const auto found = std::lower_bound(panels.begin(), panels.end(), name,
                                            [](const Panel& p, const std::string& n) { return p.name < n; });
        if (found == panels.end() || found->name != name) panel.refuse("the name of a panel");
        side.panel = static_cast<int>(found - panels.begin());
        side.edge = place.member("edge").whole_number(0, static_cast<int>(found->edges.size()) - 1);
        return side;
    }

    // ---- notes

    void note_orders()
    {
        if (in_doubt_.empty()) return;
        read_.notes.push_back(fmt::format(
            "{}: {} about more than one axis, where the order of rotations matters; GarmentCode writes and "
            "reads "
            "files in different orders, and this file is taken as {} it",
            in_doubt_[0],
            in_doubt_.size() == 1 ? "is turned" : fmt::format("and {} more are turned", in_doubt_.size() - 1),
            options_.order == RotationOrder::XThenYThenZ ? "its simulation reads" : "its writer wrote"));
    }

    void note_ties()
    {
        for (std::size_t s = 0; s < read_.pattern.seams.size(); ++s)
            if (read_.pattern.seams[s].is_tie)
                read_.notes.push_back(fmt::format(
                    "pattern.stitches[{}]: joins the right side of the cloth to its wrong side, however "
                    "panels are turned over; it is held together and not sewn",
                    s));
    }

    JsonPlace root_, pattern_place_;
    GarmentCodeOptions options_;
    double metre_ = 1.0;  // units in a metre
    GarmentCodePattern read_;
    std::vector<std::string> in_doubt_;  // paths of panels that the orders of rotations place differently
};

}  // namespace

GarmentCodePattern parse_garment_code(const std::string& file, const std::string& text,
                                      const GarmentCodeOptions& options)
{
    const nlohmann::json json = parse_json(file, text);
    GarmentCodePattern read = GarmentCodeReader(JsonPlace(file, json), options).read();
    try {
        check_pattern(read.pattern);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", printable(file), printable(error.what())));
    }
    return read;
}

GarmentCodePattern read_garment_code(const std::string& path, const GarmentCodeOptions& options)
{
    return parse_garment_code(path, read_scene_text(path, "a GarmentCode pattern (JSON)"), options);
}

}  // namespace arris
