// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth/piece_layout.h"

namespace arris {

std::vector<PiecePlace> lay_out(const std::vector<Eigen::AlignedBox2d>& boxes, double room)
{
    std::vector<PiecePlace> places(boxes.size());
    double begin = 0.0;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (i > 0) {
            places[i].shift = begin + 0.5 * room - boxes[i].min().x();
            places[i].begin = begin;
        }
        begin = boxes[i].max().x() + places[i].shift + 0.5 * room;
    }
    return places;
}

}  // namespace arris
