// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/keys/pattern_keys.h"

#include "app/scene/keys/scene_key_kinds.h"

namespace arris {

std::vector<SceneKey> pattern_keys()
{
    constexpr KeyRange kCorner{0.0, 1e6};
    return {
        text("cloth.pattern_file", KeyType::Path, kPath, "",
             "Sewing pattern of GarmentCode (`*_specification.json`), whose panels and stitches make the "
             "cloth; they are meshed with `edge_length`. Lengths are in its `units_in_meter`."),
        choice("cloth.rotation_order", "xyz|zyx", R"("xyz")",
               "Order in which a panel of `pattern_file` turns about the fixed axes by its three angles: as "
               "GarmentCode's simulation reads them (xyz), or as its programs write them (zyx). They agree "
               "where a panel has one angle."),
        tables("cloth.panel",
               "Panels: flat pieces that are sewn together along seams. With `pattern_file` a panel of that "
               "name is given a fabric or moved."),
        text("cloth.panel[].name", KeyType::Name, {}, kRequired, "Name of the panel."),
        polygon("cloth.panel[].outline", KeyType::Polygon,
                "Corners of the panel in its own plane, from which edge i goes from corner i to the next. "
                "The panel's right side is that from which they run counter-clockwise; panels are turned "
                "over where seams ask for it. Required without `pattern_file`."),
        tables("cloth.panel[].edges", "Further properties of edges of `outline`."),
        integer("cloth.panel[].edges[].edge", kCorner, kRequired,
                "Number of the edge, that of the corner at its beginning."),
        {.name = "cloth.panel[].edges[].control",
         .type = KeyType::Polygon,
         .unit = "m",
         .range = kAnyNumber,
         .count = 1,
         .sentence = "One or two control points, which make the edge a quadratic or cubic Bezier curve."},
        text("cloth.panel[].edges[].label", KeyType::Text, kTitle, "", "Label of the edge, for pins."),
        text("cloth.panel[].fabric", KeyType::Name, {}, "(the cloth's)",
             "Name of a `[[fabric]]`, of which the panel is made."),
        numbers("cloth.panel[].translate", 3, "m", kAnyNumber, kOrigin,
                "World position = translate + rotate((u, v, 0)), before the cloth's own placement. With "
                "`pattern_file` it moves the panel from its place in the file."),
        table("cloth.panel[].rotate", kIdentity, "Rotation of the panel."),
        axis("cloth.panel[].rotate.axis"),
        number("cloth.panel[].rotate.degrees", "degrees", kAnyNumber, kRequired,
               "Angle of the rotation, right-handed."),
        tables("cloth.seam",
               "Seams, each of which joins edges of two panels, or of one. With `pattern_file`, one that the "
               "file has, too, is given its `order`, or becomes a tie."),
        {.name = "cloth.seam[].join",
         .type = KeyType::Join,
         .range = kCorner,
         .count = 2,
         .fallback = kRequired,
         .sentence =
             "The two sides: of each the panel and the corners at its ends, in the order in which they meet. "
             "A side goes the shorter way along the outline, or past a corner named between them. Both sides "
             "have equal numbers of cells, at equal shares of their lengths; the longer one is gathered, and "
             "at most 4 times as long. A side of a tie can be a line within a panel: "
             "`[\"front\", [0.1, 0.2], [0.3, 0.2]]`, in m."},
        choice("cloth.seam[].as", "weld|tie", R"("weld")",
               "A seam that is closed is welded: its sides become one edge of the cloth. A tie stays a "
               "spring between vertices, which needs no proper surface: for pockets, or three panels at a "
               "seam. One of its sides may be on other seams."),
        integer("cloth.seam[].order", {0.0, 1000.0}, "0", "Seams of a lower order are closed first."),
        table(
            "cloth.assembly", "{}",
            "How seams close, before time 0: without gravity, wind, friction and pins (but those with a "
            "`label`), obstacles at rest. All cloths close at the least `speed` and the greatest `settle` of "
            "their tables."),
        number("cloth.assembly.speed", "m/s", {1e-3, 100.0}, "0.5",
               "Greatest speed at which two sides come together."),
        number("cloth.assembly.settle", "s", {0.0, 1000.0}, "0.5",
               "Time for the cloth to come to rest once all seams are closed."),
        boolean("cloth.assembly.frames", "false", "Whether frames of it are written."),
        choice("cloth.assembly.unsewn", "end|keep", R"("end")",
               "If seams do not close: the run ends and names them, or they stay as ties."),
    };
}

}  // namespace arris
