// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace arris {

/// A sharp feature of one of the scene's obstacles, on which a vertex of the cloth may lie.
struct FeatureId {
    enum class Kind : std::int32_t {
        Edge,    ///< a sharp edge, border or wire segment: vertices slide along it
        Corner,  ///< a corner, a wire's end, a nail: a vertex is fixed there
        Bend     ///< where a wire bends between two segments of one polyline: a vertex is fixed there
    };

    std::int32_t obstacle;  ///< index in the scene
    Kind kind;
    std::int32_t index;     ///< in the obstacle's features(): `corners` of a corner, else `edges`
    std::int32_t end = -1;  ///< of a bend: the end (0 or 1) of its edge where the wire bends; else -1

    bool is_corner() const { return kind == Kind::Corner; }
    bool is_bend() const { return kind == Kind::Bend; }
    /// Whether a vertex on this feature stays at one point of the obstacle.
    bool is_fixed() const { return kind != Kind::Edge; }

    static FeatureId edge(std::int32_t obstacle, std::int32_t index) { return {obstacle, Kind::Edge, index}; }
    static FeatureId corner(std::int32_t obstacle, std::int32_t index)
    {
        return {obstacle, Kind::Corner, index};
    }
    static FeatureId bend(std::int32_t obstacle, std::int32_t index, std::int32_t end)
    {
        return {obstacle, Kind::Bend, index, end};
    }

    friend bool operator==(const FeatureId&, const FeatureId&) = default;
};

}  // namespace arris
