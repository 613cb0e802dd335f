// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "geometry/cloth_mesh.h"
#include "solver/scene.h"
#include "solver/settings.h"

namespace arris {

struct Probe {
    std::string name;
    Vec2 material = Vec2::Zero();
};

struct OutputOptions {
    double frames_per_second = 24.0;  ///< 0: no frames
    std::vector<std::string> formats = {"viewer"};
};

/// A scene file, loaded and validated: all that `run` needs.
struct RunConfig {
    std::string title;
    double duration = 0.0;  ///< s
    Scene scene;
    Settings settings;
    OutputOptions output;
    std::vector<Probe> probes;

    ClothMesh cloth;                     ///< placed and folded, before pins take hold
    Vec3 cloth_velocity = Vec3::Zero();  ///< m/s, initial

    std::vector<std::string> warnings;
    nlohmann::ordered_json as_run;  ///< the scene with every default written out, by key
};

/// A scene file as it was read, so that a run can be resumed whatever became of the file.
struct SceneSource {
    std::string path;                    ///< as given; paths in the scene are relative to its folder
    std::string text;                    ///< TOML
    std::vector<std::string> overrides;  ///< "KEY=VALUE"
};

/// Reads a scene file. Throws InputError in one line: missing, no regular file, larger than 16 MiB.
SceneSource read_scene_source(const std::string& path, const std::vector<std::string>& overrides);

/// Loads and validates a scene once, its overrides applied. Throws InputError. Where `cloth` is given it is
/// taken instead of making the scene's (a resumed run has its mesh, whatever became of the file).
RunConfig load_scene(const SceneSource& source, const ClothMesh* cloth = nullptr);
inline RunConfig load_scene(const std::string& path, const std::vector<std::string>& overrides)
{
    return load_scene(read_scene_source(path, overrides));
}

}  // namespace arris
