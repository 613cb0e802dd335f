// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/study/study_tasks.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "app/scene/keys/scene_document.h"
#include "app/scene/parts/cloth_pieces.h"
#include "app/study/fingerprint.h"
#include "app/study/run_outcome.h"
#include "app/text/version.h"
#include "geometry/obstacle_input/deform/vertex_cache.h"

namespace arris {
namespace {

namespace fs = std::filesystem;

std::string program_path()
{
    return fs::read_symlink("/proc/self/exe").string();
}

/// Files that a scene in `folder` names: the cloth's, the obstacles', and those of their motion.
std::vector<std::string> named_files(const nlohmann::ordered_json& scene, const fs::path& folder)
{
    std::vector<std::string> files;
    const auto path_in = [&](const nlohmann::ordered_json& table, const char* key = "file") {
        const bool is_named = table.contains(key) && table[key].is_string();
        return is_named ? (folder / table[key].get<std::string>()).string() : std::string();
    };
    const auto add = [&](const std::string& path) {
        if (!path.empty()) files.push_back(path);
    };
    for (const auto* cloth : cloth_tables(scene))
        for (const char* key : {"file", "pattern_file"}) add(path_in(*cloth, key));
    if (scene.contains("obstacle"))
        for (const auto& obstacle : scene["obstacle"]) {
            add(path_in(obstacle));
            if (!obstacle.contains("deform")) continue;
            for (const std::string& path : list_cache_files(path_in(obstacle["deform"]))) add(path);
        }
    return files;
}

/// Fingerprints of files, each read once.
class FileFingerprints {
  public:
    const std::string& of(const std::string& path)
    {
        const auto [entry, is_new] = known_.try_emplace(path);
        if (is_new) entry->second = file_fingerprint(path);
        return entry->second;
    }

  private:
    std::map<std::string, std::string> known_;
};

}  // namespace

std::string describe_version()
{
    return fmt::format("{} (program {})", kVersion, file_fingerprint("/proc/self/exe"));
}

std::vector<Task> make_tasks(const Study& study, const std::vector<StudyRun>& runs, const TaskFolder& folder)
{
    const std::string program = program_path(), scene = fs::absolute(study.scene).lexically_normal().string();
    const std::string version = describe_version(), text = read_scene_text(study.scene);
    FileFingerprints files;
    std::vector<Task> tasks;
    for (const StudyRun& run : runs) {
        const std::vector<std::string> overrides = list_overrides(study, run);
        std::vector<std::string> deciding = {version, text};
        for (const std::string& file : named_files(run.scene, fs::path(scene).parent_path()))
            deciding.push_back(files.of(file));
        deciding.insert(deciding.end(), overrides.begin(), overrides.end());
        for (const std::string& name : task_names(run.name, study.repeats)) {
            Task task{name, {program, "run", scene, "-o", folder.run_directory(name)}, fingerprint(deciding)};
            for (const char* word : {"--overwrite", "--quiet", "--threads", "1"})
                task.command.emplace_back(word);
            for (const std::string& override : overrides) {
                task.command.emplace_back("--set");
                task.command.push_back(override);
            }
            tasks.push_back(std::move(task));
        }
    }
    return tasks;
}

}  // namespace arris
