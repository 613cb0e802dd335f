// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/run_config.h"

#include "geometry/cloth/sub_mesh.h"

namespace arris {

double distance_of(const RunConfig& config, const std::array<int, 2>& pair)
{
    const std::vector<Vec3>& x = config.cloth.world;
    return (x[static_cast<std::size_t>(pair[0])] - x[static_cast<std::size_t>(pair[1])]).norm();
}

ClothMesh extract_piece(const RunConfig& config, std::size_t i)
{
    if (config.pieces.size() == 1) return config.cloth;
    std::vector<int> faces;
    for (int f = 0; f < config.cloth.face_count(); ++f)
        if (config.scene.materials.piece_at(config.cloth.corners(f)[0]) == static_cast<int>(i))
            faces.push_back(f);
    return extract_faces(config.cloth, faces).mesh;
}

}  // namespace arris
