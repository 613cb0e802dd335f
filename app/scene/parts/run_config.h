// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/scene/parts/cloth_pieces.h"
#include "app/scene/parts/obstacle_records.h"
#include "geometry/cloth/cloth_mesh.h"
#include "geometry/cloth_input/pattern/pattern_cloth.h"
#include "solver/model/scene.h"
#include "solver/model/settings.h"
#include "solver/model/sewing.h"

namespace arris {

struct Probe {
    std::string name;
    Vec2 material = Vec2::Zero();  ///< in the plane of all pieces
};

struct OutputOptions {
    double frames_per_second = 24.0;  ///< 0 writes no frames
    std::vector<std::string> formats = {"viewer"};
};

/// A seam that is not closed where the cloth is made.
struct SceneSeam : OpenSeam {
    std::vector<std::array<int, 2>> pairs;  ///< vertices of the first mesh
};

/// A label of edges of panels.
struct SceneLabel : LabelledLines {
    int table = 0;  ///< of their cloth

    SceneLabel() = default;
    SceneLabel(int of_table, LabelledLines named) : LabelledLines(std::move(named)), table(of_table) {}
};

/// A loaded and validated scene file: the input of `run`. Movable only, because Scene is.
struct RunConfig {
    std::string title;
    double duration = 0.0;     ///< s
    bool is_assembly = false;  ///< whether the run ends when the cloth is sewn (assembly.h)
    Scene scene;
    Settings settings;
    OutputOptions output;
    std::vector<Probe> probes;

    std::vector<ClothPiece> pieces;  ///< at least one
    std::vector<SceneSeam> seams;
    std::vector<SceneLabel> labels;
    ClothMesh cloth;                             ///< placed and folded, before pins are attached
    std::vector<Vec3> cloth_velocity;            ///< m/s, initial, of each vertex
    std::vector<Placement> obstacle_placements;  ///< of the obstacles' frames, before their motions
    std::vector<std::string> intersections;      ///< of the cloth with obstacles at time 0, one line each

    std::vector<std::string> warnings;
    std::vector<std::string> notes;  ///< on the cloth and on obstacles' files: valid, but worth knowing
    nlohmann::ordered_json as_run;   ///< the scene by key, with every default filled in
};

/// The first mesh of piece i, with its material in the plane of all pieces.
ClothMesh extract_piece(const RunConfig& config, std::size_t i);

/// Distance, m, between two vertices of the first mesh.
double distance_of(const RunConfig& config, const std::array<int, 2>& pair);

/// The text of a scene file and its overrides, stored so that a run can be resumed without the file.
struct SceneSource {
    std::string path;                    ///< as given; paths in the scene are relative to its folder
    std::string text;                    ///< TOML
    std::vector<std::string> overrides;  ///< "KEY=VALUE"
};

/// Inputs of load_scene besides the scene.
struct LoadOptions {
    /// For a resumed run: the cloth at time 0 and the meshes of the obstacles, as stored with the run. Checks
    /// and warnings about time 0 are then omitted.
    const ClothMesh* cloth = nullptr;
    const std::vector<ClothPiece>* pieces = nullptr;  ///< their places and sizes, with `cloth`
    const std::vector<SceneSeam>* seams = nullptr;    ///< that are not welded, likewise
    const std::vector<SceneLabel>* labels = nullptr;  ///< likewise
    std::string pieces_file;                          ///< the file that `pieces` comes from
    const std::vector<ObstacleRecord>* obstacles = nullptr;
    std::string obstacles_file;  ///< the file that `obstacles` comes from

    bool is_start = false;  ///< whether `cloth` has yet to be checked at time 0: no run has made a step

    /// Whether intersections with obstacles at time 0 are returned in the config, instead of an InputError.
    bool tells_intersections = false;

    /// Program and arguments that import a mesh file in a separate process; by default this program.
    std::vector<std::string> importer = {"/proc/self/exe", "import-obstacle"};
};

}  // namespace arris
