// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace arris {

/// A tube of two panels around a post.
inline const std::string kTube = R"(
duration = 0.1
[cloth]
edge_length = 0.05
[cloth.assembly]
settle = 0.05
[[cloth.panel]]
name = "front"
outline = [[0, 0], [0.3, 0], [0.3, 0.3], [0, 0.3]]
edges = [{ edge = 2, label = "top" }]
translate = [-0.15, 0.12, 0.0]
rotate = { axis = [1, 0, 0], degrees = 90 }
[[cloth.panel]]
name = "back"
fabric = "heavy"
outline = [[0, 0], [0.3, 0], [0.3, 0.3], [0, 0.3]]
translate = [-0.15, -0.12, 0.0]
rotate = { axis = [1, 0, 0], degrees = 90 }
[[cloth.seam]]
join = [["front", 0, 3], ["back", 0, 3]]
[[cloth.seam]]
join = [["front", 1, 2], ["back", 1, 2]]
[[fabric]]
name = "heavy"
density = 0.4
[self_contact]
[gravity]
[[obstacle]]
name = "post"
box = [0.05, 0.05, 1.0]
[output]
formats = []
)";

inline const std::string kHeld = kTube + "[[pin]]\nlabel = \"top\"\n";

/// `text` with its first `what` replaced.
inline std::string with(std::string text, const std::string& what, const std::string& instead)
{
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), instead);
}

}  // namespace arris
