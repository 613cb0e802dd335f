// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/cloth_obj.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>
#include <string_view>

#include "geometry/input_error.h"

namespace arris {
namespace {

std::string read_bytes(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    if (!file) throw InputError(path + ": cannot be opened");
    std::ostringstream bytes;
    bytes << file.rdbuf();
    if (file.bad()) throw InputError(path + ": cannot be read to its end");
    return bytes.str();
}

void require_uvs(const ObjFile& file)
{
    for (const ObjCorner& corner : file.corners) {
        if ((corner.uv < 0) != (file.corners.front().uv < 0))
            throw InputError(
                fmt::format("line {}: some faces have UVs and some have none; allowed: all with UVs, or none",
                            corner.line));
        if (corner.uv >= static_cast<int>(file.uvs.size()))
            throw InputError(fmt::format("line {}: a face names UV {}, but there are {}, counted from 1",
                                         corner.line, corner.uv + 1LL, file.uvs.size()));
    }
}

}  // namespace

ObjFile read_cloth_obj(const std::string& path)
{
    const std::string bytes = read_bytes(path);
    try {
        ObjFile file = read_obj(bytes);
        if (file.corner_counts.empty())
            throw InputError(fmt::format(
                "no faces among {} vertices, {} lines and points and {} other statements; allowed: "
                "vertices as 'v x y z' and faces of at least 3 of them as 'f 1 2 3'",
                file.vertices.size(), file.line_and_point_count, file.other_count));
        require_uvs(file);
        return file;
    } catch (const InputError& error) {
        const std::string why = error.what();
        throw InputError(path + (why.starts_with("line ") ? ", " : ": ") + why);
    }
}

}  // namespace arris
