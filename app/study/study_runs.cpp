// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/study/study_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <utility>

#include "app/files/csv_table.h"
#include "app/scene/keys/scene_document.h"
#include "app/scene/keys/scene_values.h"
#include "app/scene/parts/cloth_pieces.h"
#include "app/study/fingerprint.h"
#include "app/study/time_history.h"
#include "app/text/printable.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

constexpr std::size_t kMostNameBytes = 100;

// "time.step=0.01,cloth.resolution=4x1". A hash of the settings follows where that is not the whole truth.
std::string make_name(const std::vector<Setting>& settings)
{
    std::string exact, name;
    for (const Setting& setting : settings) {
        exact += assignment(setting) + "\n";
        name += (name.empty() ? "" : ",") + setting.key + "=";
        for (std::size_t i = 0; i < setting.text.size(); ++i) {
            const char c = setting.text[i];
            if (c == ',') name += 'x';
            if (std::string_view("[], ").find(c) == std::string_view::npos) name += c;
        }
    }
    bool is_exact = name.size() <= kMostNameBytes;
    for (char& c : name) {
        const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) ||
                              std::string_view("._=,+-").find(c) != std::string_view::npos;
        is_exact = is_exact && is_plain;
        if (!is_plain) c = '_';
    }
    if (name.empty()) return "as_is";
    return is_exact ? name : fmt::format("{}-{}", name.substr(0, kMostNameBytes), fingerprint({exact}));
}

// Each problem has a reference run of its own; a formula or file is the reference of all runs.
std::string problem_of(const Study& study, const std::vector<Setting>& settings)
{
    const bool is_run = study.error && (study.error->reference == ErrorRule::Reference::Finest ||
                                        study.error->reference == ErrorRule::Reference::Run);
    if (!is_run) return "";
    std::vector<Setting> physical;
    for (const Setting& setting : settings)
        if (!is_numerical_key(setting.key)) physical.push_back(setting);
    return list_settings(physical);
}

/// Loads a scene with settings, key by key: rules between keys are left to the run.
nlohmann::ordered_json complete(const Study& study, const SceneDocument& scene, const StudyRun& run)
{
    SceneDocument document = scene;
    try {
        for (const std::string& override : list_overrides(study, run)) document.set(override);
        return complete_scene(document);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", printable(study.path), error.what()));
    }
}

void require_quantity(const Study& study, const StudyRun& run)
{
    if (!study.error) return;
    const ErrorRule& rule = *study.error;
    const auto refuse = [&](const char* key, const std::string& value, const std::string& allowed) {
        throw InputError(fmt::format("{}: error.{} = \"{}\": is not in the scene; allowed: {}",
                                     printable(study.path), key, printable(value, 100), allowed));
    };
    if (rule.quantity == ErrorRule::Quantity::Probe) {
        std::vector<std::string> names;
        if (run.scene.contains("probe"))
            for (const auto& probe : run.scene["probe"]) names.push_back(probe["name"].get<std::string>());
        if (std::find(names.begin(), names.end(), rule.probe) == names.end())
            refuse("probe", rule.probe,
                   names.empty() ? "a scene with [[probe]]" : fmt::format("{}", fmt::join(names, ", ")));
    }
    if (rule.quantity == ErrorRule::Quantity::Column &&
        fmt::format(",{},", step_header()).find(fmt::format(",{},", rule.column)) == std::string::npos)
        refuse("column", rule.column, "a column of steps.csv: " + step_header());
    if (rule.quantity == ErrorRule::Quantity::Shape && run.scene["output"]["frames_per_second"] == 0.0)
        throw InputError(
            fmt::format("{}: error.shape: the scene has output.frames_per_second = 0; allowed: "
                        "frames to compare, or set = {{ \"output.frames_per_second\" = N }}",
                        printable(study.path)));
}

// The reference's settings replace or follow the settings of the problem.
std::vector<Setting> further_settings(const std::vector<Setting>& run, const std::vector<Setting>& reference)
{
    std::vector<Setting> settings;
    for (const Setting& setting : run)
        if (!is_numerical_key(setting.key) && !find_setting(reference, setting.key))
            settings.push_back(setting);
    settings.insert(settings.end(), reference.begin(), reference.end());
    return settings;
}

/// One run for each problem that has none with these settings.
void add_further_runs(const Study& study, const SceneDocument& scene, std::vector<StudyRun>& runs)
{
    std::map<std::string, bool> has_reference;
    const std::size_t count = runs.size();
    for (std::size_t i = 0; i < count; ++i) {
        if (std::exchange(has_reference[runs[i].problem], true)) continue;
        StudyRun further;
        further.settings = further_settings(runs[i].settings, study.error->reference_run);
        further.name = make_name(further.settings);
        further.problem = runs[i].problem;
        further.is_further = true;
        further.scene = complete(study, scene, further);
        runs.push_back(std::move(further));
    }
}

void require_different_names(const Study& study, const std::vector<StudyRun>& runs)
{
    std::map<std::string, int> counts;
    for (const StudyRun& run : runs)
        if (++counts[run.name] > 1)
            throw InputError(
                fmt::format("{}: error.reference: {} is a run of the study already; allowed: a "
                            "run of its own, or \"finest\"",
                            printable(study.path), printable(run.name)));
}

}  // namespace

Fineness fineness_of(const StudyRun& run)
{
    Fineness fineness;
    fineness.least_step = run.scene["time"]["step"].get<double>();
    for (const auto* piece : cloth_tables(run.scene))
        if (piece->contains("resolution") && (*piece)["resolution"].is_array())
            fineness.cells +=
                (*piece)["resolution"][0].get<double>() * (*piece)["resolution"][1].get<double>();
    return fineness;
}

std::vector<std::string> list_overrides(const Study& study, const StudyRun& run)
{
    std::vector<std::string> overrides;
    for (const Setting& setting : study.common)
        if (!find_setting(run.settings, setting.key)) overrides.push_back(assignment(setting));
    for (const Setting& setting : run.settings) overrides.push_back(assignment(setting));
    return overrides;
}

std::vector<StudyRun> list_runs(const Study& study)
{
    const SceneDocument scene(study.scene, read_scene_text(study.scene));
    std::vector<StudyRun> runs;
    for (const std::vector<Setting>& settings : study.runs) {
        StudyRun run;
        run.settings = settings;
        run.name = make_name(settings);
        run.problem = problem_of(study, settings);
        run.scene = complete(study, scene, run);
        require_quantity(study, run);
        runs.push_back(std::move(run));
    }
    if (study.error && study.error->reference == ErrorRule::Reference::File)
        read_reference_file(study.error->formula, *study.error);  // before anything runs
    if (study.error && study.error->reference == ErrorRule::Reference::Run)
        add_further_runs(study, scene, runs);
    require_different_names(study, runs);
    return runs;
}

}  // namespace arris
