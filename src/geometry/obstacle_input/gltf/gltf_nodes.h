// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace arris {

/// Indices of the nodes in the scene that the file shows (its default, else its first). All nodes in a file
/// without scenes. Indices that the file does not have are left out: the import library reports them.
std::set<std::size_t> shown_gltf_nodes(const nlohmann::json& file);

/// The numbers of a node's member; none if the node does not have it. Throws InputError, beginning with
/// `what`, if they are not `count` finite numbers.
std::vector<double> gltf_numbers(const nlohmann::json& node, const char* name, std::size_t count,
                                 const std::string& what);

/// Checks the placement of a node, of which the import library drops what it cannot use. Throws InputError,
/// beginning with `what`, for: a `matrix` that is not 16 numbers, or whose last row is not 0 0 0 1; a
/// `translation` or `scale` that is not 3 numbers; a `rotation` that is not 4 numbers of length 1.
void check_gltf_placement(const nlohmann::json& node, const std::string& what);

}  // namespace arris
