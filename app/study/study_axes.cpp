// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/study/study_axes.h"

#include <algorithm>
#include <map>
#include <set>

namespace arris {
namespace {

bool is_numeric(const Study& study, const std::string& key)
{
    return std::all_of(study.runs.begin(), study.runs.end(), [&](const std::vector<Setting>& run) {
        const Setting* setting = find_setting(run, key);
        return setting && setting->number;
    });
}

/// The settings of some keys of a run, as text.
std::string describe(const std::vector<Setting>& run, const std::vector<std::string>& keys)
{
    std::string text;
    for (const std::string& key : keys) {
        const Setting* setting = find_setting(run, key);
        text += key + "=" + (setting ? setting->toml : "") + "\n";
    }
    return text;
}

std::vector<std::string> without(std::vector<std::string> keys, const std::string& key)
{
    std::erase(keys, key);
    return keys;
}

std::size_t count_different(const Study& study, const std::vector<std::string>& keys)
{
    std::set<std::string> texts;
    for (const std::vector<Setting>& run : study.runs) texts.insert(describe(run, keys));
    return texts.size();
}

/// How readily a key is left out where the others determine it.
int rank_of(const Study& study, const std::string& key)
{
    if (without_piece(key) == "cloth.resolution") return 3;
    if (key == "time.step") return 2;
    return is_numeric(study, key) ? 1 : 0;
}

/// Whether some runs differ in this key alone, with numbers.
bool is_axis(const Study& study, const std::string& key)
{
    if (!is_numeric(study, key)) return false;
    const std::vector<std::string> others = without(study.telling_keys, key);
    std::map<std::string, std::set<std::string>> values;
    for (const std::vector<Setting>& run : study.runs)
        values[describe(run, others)].insert(find_setting(run, key)->toml);
    return std::any_of(values.begin(), values.end(),
                       [](const auto& entry) { return entry.second.size() > 1; });
}

/// Whether the values are arrays or tables, which make poor names.
bool is_long(const Study& study, const std::string& key)
{
    return !is_numeric(study, key) &&
           std::any_of(study.runs.begin(), study.runs.end(), [&](const std::vector<Setting>& run) {
               const Setting* setting = find_setting(run, key);
               return setting && (setting->toml.starts_with('[') || setting->toml.starts_with('{'));
           });
}

}  // namespace

void find_axes(Study& study)
{
    study.telling_keys = study.keys;
    std::vector<std::string> candidates;
    for (const std::string& key : study.keys)
        if (is_numeric(study, key) || is_long(study, key) || count_different(study, {key}) == 1)
            candidates.push_back(key);
    std::stable_sort(candidates.begin(), candidates.end(), [&](const std::string& a, const std::string& b) {
        return rank_of(study, a) < rank_of(study, b);
    });
    for (const std::string& key : candidates) {
        const std::vector<std::string> fewer = without(study.telling_keys, key);
        if (count_different(study, fewer) == study.runs.size()) study.telling_keys = fewer;
    }
    study.axis_keys.clear();
    for (const std::string& key : study.telling_keys)
        if (is_axis(study, key)) study.axis_keys.push_back(key);
    std::stable_sort(
        study.axis_keys.begin(), study.axis_keys.end(),
        [&](const std::string& a, const std::string& b) { return rank_of(study, a) > rank_of(study, b); });
}

}  // namespace arris
