// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/files/frame.h"
#include "app/scene/parts/obstacle_records.h"

namespace arris {

/// A PNG file of 720 x 450 pixels, background transparent: the cloth, and the obstacles where they are at
/// `time` (s), seen obliquely from above, from that of four sides that shows most of the cloth. The view fits
/// the cloth and what of the obstacles is near it. EOL edges are pink. Linear in the numbers of faces.
std::string draw_scene(const Frame& cloth, const std::vector<ObstacleRecord>& obstacles, double time);

}  // namespace arris
