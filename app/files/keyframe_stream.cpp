// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/files/keyframe_stream.h"

#include <cmath>

namespace arris {

void write_keyframes(BinaryWriter& out, const std::vector<Keyframe>& keyframes)
{
    out.list(keyframes, [&](const Keyframe& key) {
        out.number(key.time);
        out.vector(key.translate);
        for (const double c : key.rotate.coeffs()) out.number(c);
    });
}

std::vector<Keyframe> read_keyframes(BinaryReader& in)
{
    return in.list<Keyframe>(8 * sizeof(double), [&] {
        Keyframe key;
        key.time = in.number<double>();
        key.translate = in.vector();
        for (double& c : key.rotate.coeffs()) c = in.number<double>();
        return key;
    });
}

bool are_sound(const std::vector<Keyframe>& keyframes)
{
    for (std::size_t k = 0; k < keyframes.size(); ++k) {
        const Keyframe& key = keyframes[k];
        const bool is_later = k == 0 || key.time > keyframes[k - 1].time;
        if (!is_later || !std::isfinite(key.time) || !key.translate.allFinite() ||
            !key.rotate.coeffs().allFinite() || !(key.rotate.norm() > 0.5))
            return false;
    }
    return true;
}

}  // namespace arris
