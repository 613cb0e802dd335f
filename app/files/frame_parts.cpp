// SPDX-License-Identifier: GPL-3.0-or-later
// The pieces and seams of a frame.
#include "app/files/frame.h"

namespace arris {

int Frame::piece_of(const Face& points) const
{
    return piece_at(pieces, material[points[0]]);
}

std::vector<Vec2> Frame::own_material() const
{
    std::vector<Vec2> own = material;
    if (!pieces.empty())
        for (Vec2& X : own) X = pieces[piece_at(pieces, X)].from_plane(X);
    return own;
}

std::vector<int> Frame::faces_of(int piece) const
{
    std::vector<int> found;
    for (std::size_t f = 0; f < faces.size(); ++f)
        if (piece_of(corners()[f]) == piece) found.push_back(static_cast<int>(f));
    return found;
}

Frame split_seams(const Frame& frame)
{
    Frame split = frame;
    split.face_points.clear();
    split.seam_vertices.clear();
    split.faces = frame.corners();
    for (const int v : frame.seam_vertices) {
        for (auto* vectors : {&split.world, &split.vertex_velocity, &split.material_velocity})
            vectors->push_back((*vectors)[v]);
        split.ids.push_back(frame.ids[v]);
        split.eol.push_back(frame.eol[v]);
        split.contact.push_back(frame.contact[v]);
    }
    return split;
}

}  // namespace arris
