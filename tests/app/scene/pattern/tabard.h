// SPDX-License-Identifier: GPL-3.0-or-later
// A GarmentCode pattern with all that its reader knows, for tests.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace arris {

// A tabard: the front with a dart, a neckline cut out as an arc and a curved side of each kind; the back runs
// clockwise; a pocket on the front's hem turned about two axes. Lengths in cm.
inline const std::string kTabard = R"({
"properties": {"units_in_meter": 100, "curvature_coords": "relative", "normalized_edge_loops": true},
"pattern": {
  "panels": {
    "front": {
      "translation": [-20, 100, 15], "rotation": [0, 0, 0], "label": "body",
      "vertices": [[0, 0], [18, 0], [20, 10], [22, 0], [40, 0], [40, 60], [28, 60], [12, 60], [0, 60]],
      "edges": [
        {"endpoints": [0, 1], "label": "hem"},
        {"endpoints": [1, 2]},
        {"endpoints": [2, 3]},
        {"endpoints": [3, 4], "label": "hem"},
        {"endpoints": [4, 5], "curvature": {"type": "quadratic", "params": [[0.5, -0.05]]}},
        {"endpoints": [5, 6]},
        {"endpoints": [6, 7], "curvature": {"type": "circle", "params": [10, 0, 0]}},
        {"endpoints": [7, 8]},
        {"endpoints": [8, 0], "curvature": {"type": "cubic", "params": [[0.25, -0.05], [0.75, -0.05]]}}
      ]},
    "back": {
      "translation": [-20, 100, -15], "rotation": [0, 0, 0],
      "vertices": [[0, 0], [0, 60], [12, 60], [28, 60], [40, 60], [40, 0]],
      "edges": [
        {"endpoints": [0, 1], "curvature": [0.5, 0.05]},
        {"endpoints": [1, 2]},
        {"endpoints": [2, 3], "curvature": null},
        {"endpoints": [3, 4]},
        {"endpoints": [4, 5]},
        {"endpoints": [5, 0]}
      ]},
    "pocket": {
      "translation": [0, 90, 20], "rotation": [90, 45, 0],
      "vertices": [[0, 0], [10, 0], [10, 10], [0, 10]],
      "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]}
  },
  "stitches": [
    [{"panel": "front", "edge": 1}, {"panel": "front", "edge": 2}],
    [{"panel": "front", "edge": 4}, {"panel": "back", "edge": 4}],
    [{"panel": "front", "edge": 5}, {"panel": "back", "edge": 3}],
    [{"panel": "front", "edge": 7}, {"panel": "back", "edge": 1}],
    [{"panel": "pocket", "edge": 0}, {"panel": "front", "edge": 3}, "right_wrong"]
  ]
}})";

// The tabard with one value replaced, or taken away for a discarded one.
inline std::string with(const std::string& pointer, const nlohmann::json& value)
{
    nlohmann::json json = nlohmann::json::parse(kTabard);
    const nlohmann::json::json_pointer at(pointer);
    if (!value.is_discarded())
        json[at] = value;
    else if (json.at(at.parent_pointer()).is_object())
        json.at(at.parent_pointer()).erase(at.back());
    return json.dump();
}

inline const nlohmann::json kNothing = nlohmann::json(nlohmann::json::value_t::discarded);

}  // namespace arris
