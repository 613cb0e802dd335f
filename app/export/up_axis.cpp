// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/export/up_axis.h"

namespace arris {

const char* to_string(UpAxis up)
{
    return up == UpAxis::Y ? "y" : "z";
}

Placement turn_to(UpAxis up)
{
    Placement turn;
    // Written out, since a rotation by 90 degrees would leave rounding errors in every number.
    if (up == UpAxis::Y) turn.rotation << 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0;
    return turn;
}

FrameSource turned(const FrameSource& frames, UpAxis up)
{
    if (up == UpAxis::Z) return frames;
    const auto read = [frames, turn = turn_to(up).rotation](std::size_t i) {
        Frame frame = frames.read(i);
        for (auto* vectors : {&frame.world, &frame.vertex_velocity, &frame.material_velocity})
            for (Vec3& vector : *vectors) vector = turn * vector;
        return frame;
    };
    return {frames.count, read};
}

}  // namespace arris
