// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/repair/vertex_origins.h"

#include <algorithm>

namespace arris {

std::vector<int> compose_names(std::vector<int> first, const std::vector<int>& second)
{
    for (int& name : first)
        if (name >= 0) name = second[name];
    return first;
}

VertexOrigins find_vertex_origins(const std::vector<int>& names, const std::vector<int>& point_names,
                                  double tolerance)
{
    VertexOrigins origins;
    origins.vertex_count = static_cast<int>(names.size());
    origins.tolerance = tolerance;
    const auto most = [](const std::vector<int>& values) {
        return values.empty() ? -1 : *std::max_element(values.begin(), values.end());
    };
    const auto count = static_cast<std::size_t>(std::max(most(names), most(point_names)) + 1);
    std::vector<char> is_kept(count, 0);
    for (const int name : point_names)
        if (name >= 0) is_kept[name] = 1;
    std::vector<int> first(count, -1);
    for (int v = 0; v < origins.vertex_count; ++v) {
        const int name = names[v];
        if (name < 0 || is_kept[name] == 0) continue;
        if (first[name] < 0)
            first[name] = v;
        else
            origins.joined.push_back({first[name], v});
    }
    for (const int name : point_names) origins.of_points.push_back(name < 0 ? -1 : first[name]);
    return origins;
}

}  // namespace arris
