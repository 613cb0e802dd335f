// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/scene/obstacle_records.h"
#include "geometry/cloth/cloth_mesh.h"
#include "solver/model/scene.h"
#include "solver/model/settings.h"

namespace arris {

struct Probe {
    std::string name;
    Vec2 material = Vec2::Zero();
};

struct OutputOptions {
    double frames_per_second = 24.0;  ///< 0: no frames
    std::vector<std::string> formats = {"viewer"};
};

/// A scene file, loaded and validated: all that `run` needs. Movable only, as its scene is.
struct RunConfig {
    std::string title;
    double duration = 0.0;  ///< s
    Scene scene;
    Settings settings;
    OutputOptions output;
    std::vector<Probe> probes;

    ClothMesh cloth;                             ///< placed and folded, before pins take hold
    Vec3 cloth_velocity = Vec3::Zero();          ///< m/s, initial
    std::vector<Placement> obstacle_placements;  ///< of the scene's obstacles' frames, before their motions
    std::vector<std::string> intersections;      ///< of the cloth with obstacles at time 0, a line each

    std::vector<std::string> warnings;
    std::vector<std::string> notes;  ///< of obstacles' files: what is legitimate but good to know
    nlohmann::ordered_json as_run;   ///< the scene with every default written out, by key
};

/// A scene file as it was read, so that a run can be resumed whatever became of the file.
struct SceneSource {
    std::string path;                    ///< as given; paths in the scene are relative to its folder
    std::string text;                    ///< TOML
    std::vector<std::string> overrides;  ///< "KEY=VALUE"
};

/// Reads a scene file. Throws InputError in one line: missing, no regular file, larger than 16 MiB.
SceneSource read_scene_source(const std::string& path, const std::vector<std::string>& overrides);

/// What load_scene takes from elsewhere than the scene.
struct LoadOptions {
    /// Of a run that is resumed, whatever became of the files: its cloth at time 0, and its obstacles'
    /// meshes. Nothing is then said of time 0, which is over.
    const ClothMesh* cloth = nullptr;
    const std::vector<ObstacleRecord>* obstacles = nullptr;
    std::string obstacles_file;  ///< that these are from

    /// Intersections with obstacles at time 0 are put into the config, instead of being an InputError.
    bool tells_intersections = false;

    /// The command that imports a mesh file, in a process of its own: this program.
    std::vector<std::string> importer = {"/proc/self/exe", "import-obstacle"};
};

/// Loads and validates a scene once, its overrides applied. Throws InputError.
RunConfig load_scene(const SceneSource& source, const LoadOptions& options = {});
inline RunConfig load_scene(const std::string& path, const std::vector<std::string>& overrides,
                            const LoadOptions& options = {})
{
    return load_scene(read_scene_source(path, overrides), options);
}

/// The obstacles of a run as they are stored with it.
std::vector<ObstacleRecord> record_obstacles(const RunConfig& config);

}  // namespace arris
