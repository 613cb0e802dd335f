// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/study/study_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "app/study/reference_formula.h"
#include "app/study/study_axes.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

using Kind = SceneValue::Kind;

constexpr std::size_t kMostRuns = 10000;
constexpr int kMostRepeats = 100;
constexpr std::string_view kKeys = "title, scene, set, vary, runs, error, repeats, quick";
constexpr std::string_view kQuickKeys = "set, vary, runs, error, repeats";
constexpr std::string_view kErrorKeys = "probe, axis, column, shape, reference, norm";

bool is_listed(std::string_view list, std::string_view name)
{
    return (", " + std::string(list) + ",").find(fmt::format(", {},", name)) != std::string::npos;
}

/// A value with its place in the file.
struct Found {
    const SceneValue* value = nullptr;
    std::string path;
};

/// A scene key with the values that it takes.
struct Varied {
    std::string key, path;
    std::vector<Setting> values;
};

class StudyReader {
  public:
    StudyReader(const std::string& path, bool is_quick) : document_(path, read_scene_text(path))
    {
        study_.path = path;
        study_.is_quick = is_quick;
    }

    Study read()
    {
        refuse_unknown(document_.root(), "", kKeys);
        quick_ = document_.root().member("quick");
        if (quick_) require(Found{quick_, "quick"}, Kind::Table, "a table");
        if (quick_) refuse_unknown(*quick_, "quick.", kQuickKeys);
        if (!study_.is_quick) quick_ = nullptr;
        read_names();
        read_common();
        read_runs();
        read_error();
        read_repeats();
        find_axes(study_);
        return study_;
    }

  private:
    [[noreturn]] void fail(const std::string& path, std::string_view wrong, std::string_view allowed) const
    {
        document_.fail(path, wrong, allowed);
    }

    void refuse_unknown(const SceneValue& table, const std::string& prefix, std::string_view allowed) const
    {
        for (const auto& [name, value] : table.members)
            if (!is_listed(allowed, name)) fail(prefix + name, "unknown key", allowed);
    }

    void require(const Found& found, Kind kind, std::string_view allowed) const
    {
        if (found.value->kind != kind) fail(found.path, "is of another type", allowed);
    }

    std::string text_of(const Found& found, std::string_view allowed) const
    {
        require(found, Kind::Text, allowed);
        if (found.value->text.empty()) fail(found.path, "is empty", allowed);
        return found.value->text;
    }

    /// A top-level value; the table `quick` goes first.
    Found find(const std::string& name) const
    {
        if (quick_)
            if (const SceneValue* value = quick_->member(name)) return {value, "quick." + name};
        return {document_.root().member(name), name};
    }

    /// Members of a top-level table. Those of `quick` replace others of the same name.
    std::vector<std::pair<std::string, Found>> merged(const std::string& name) const
    {
        std::vector<std::pair<std::string, Found>> members;
        add_leaves({document_.root().member(name), name}, "", members);
        if (!quick_) return members;
        std::vector<std::pair<std::string, Found>> replacements;
        add_leaves({quick_->member(name), "quick." + name}, "", replacements);
        for (auto& replacement : replacements) {
            const auto old = std::find_if(members.begin(), members.end(), [&](const auto& member) {
                return member.first == replacement.first;
            });
            if (old == members.end())
                members.push_back(replacement);
            else
                old->second = replacement.second;
        }
        return members;
    }

    /// Leaves of a table: keys may be written as "time.step" or in tables of tables.
    void add_leaves(const Found& table, const std::string& prefix,
                    std::vector<std::pair<std::string, Found>>& leaves) const
    {
        if (!table.value) return;
        require(table, Kind::Table, "a table of scene keys");
        for (const auto& [name, value] : table.value->members) {
            const Found found{&value, table.path + "." + name};
            if (value.kind == Kind::Table && !value.members.empty())
                add_leaves(found, prefix + name + ".", leaves);
            else
                leaves.emplace_back(prefix + name, found);
        }
    }

    Setting setting_of(const std::string& key, const SceneValue& value, const std::string& path) const
    {
        if (has_date(value)) fail(path, "holds a date", "values of a scene key");
        if (key.find('=') != std::string::npos) fail(path, "holds a =", "a dotted scene key");
        return make_setting(key, value);
    }

    std::vector<Setting> settings_of(const Found& table) const
    {
        std::vector<std::pair<std::string, Found>> leaves;
        add_leaves(table, "", leaves);
        std::vector<Setting> settings;
        for (const auto& [key, found] : leaves) settings.push_back(setting_of(key, *found.value, found.path));
        return settings;
    }

    std::string beside_study(const std::string& path) const
    {
        return (std::filesystem::path(study_.path).parent_path() / path).string();
    }

    void read_names()
    {
        const Found scene = find("scene");
        if (!scene.value) fail("scene", "is required and missing", "a scene file (TOML)");
        study_.scene = beside_study(text_of(scene, "a scene file (TOML)"));
        const Found title = find("title");
        study_.title =
            title.value ? text_of(title, "a text") : std::filesystem::path(study_.path).stem().string();
    }

    void read_common()
    {
        for (const auto& [key, found] : merged("set"))
            study_.common.push_back(setting_of(key, *found.value, found.path));
    }

    void read_runs()
    {
        const Found list = find("runs");
        const bool has_grid = document_.root().member("vary") || (quick_ && quick_->member("vary"));
        if ((list.value != nullptr) == has_grid)
            fail(list.value ? "runs" : "vary", list.value ? "contradicts vary" : "is required and missing",
                 "either vary (a grid) or runs (a list)");
        if (list.value)
            read_list(list);
        else
            read_grid();
    }

    void read_list(const Found& list)
    {
        constexpr const char* kAllowed = "an array of tables of scene keys, 1 to 10000 of them";
        require(list, Kind::Array, kAllowed);
        if (list.value->items.empty() || list.value->items.size() > kMostRuns)
            fail(list.path, fmt::format("has {} runs", list.value->items.size()), kAllowed);
        for (std::size_t i = 0; i < list.value->items.size(); ++i) {
            const Found entry{&list.value->items[i], fmt::format("{}.{}", list.path, i)};
            require(entry, Kind::Table, kAllowed);
            study_.runs.push_back(settings_of(entry));
            for (const Setting& setting : study_.runs.back())
                if (std::find(study_.keys.begin(), study_.keys.end(), setting.key) == study_.keys.end())
                    study_.keys.push_back(setting.key);
        }
        for (std::vector<Setting>& run : study_.runs) run = in_order(run);
        refuse_equal_runs(list.path);
    }

    std::vector<Setting> in_order(const std::vector<Setting>& settings) const
    {
        std::vector<Setting> ordered;
        for (const std::string& key : study_.keys)
            if (const Setting* setting = find_setting(settings, key)) ordered.push_back(*setting);
        return ordered;
    }

    void refuse_equal_runs(const std::string& path) const
    {
        std::vector<std::string> lists;
        for (const std::vector<Setting>& run : study_.runs) lists.push_back(list_settings(run));
        std::sort(lists.begin(), lists.end());
        const auto equal = std::adjacent_find(lists.begin(), lists.end());
        if (equal != lists.end())
            fail(path, "has two runs with " + (equal->empty() ? "no settings" : *equal), "each run once");
    }

    void read_grid()
    {
        std::vector<Varied> grid;
        std::size_t count = 1;
        for (const auto& [key, found] : merged("vary")) {
            require(found, Kind::Array, "an array of values");
            if (found.value->items.empty()) fail(found.path, "is empty", "an array of values");
            Varied varied{key, found.path, {}};
            for (const SceneValue& value : found.value->items)
                varied.values.push_back(setting_of(key, value, found.path));
            count *= varied.values.size();
            if (count > kMostRuns) fail(found.path, "makes too many runs", "at most 10000 runs");
            study_.keys.push_back(key);
            grid.push_back(std::move(varied));
        }
        if (grid.empty()) fail("vary", "is empty", "a table of scene keys with arrays of values");
        // The last key varies fastest.
        study_.runs = {{}};
        for (const Varied& varied : grid) {
            std::vector<std::vector<Setting>> longer;
            for (const std::vector<Setting>& run : study_.runs)
                for (const Setting& value : varied.values) {
                    longer.push_back(run);
                    longer.back().push_back(value);
                }
            study_.runs = std::move(longer);
        }
        refuse_equal_runs("vary");
    }

    void read_error()
    {
        const SceneValue* written = document_.root().member("error");
        const SceneValue* quick = quick_ ? quick_->member("error") : nullptr;
        for (const auto& [value, path] : {std::pair(written, "error"), std::pair(quick, "quick.error")}) {
            if (!value) continue;
            require({value, path}, Kind::Table, "a table: " + std::string(kErrorKeys));
            refuse_unknown(*value, std::string(path) + ".", kErrorKeys);
        }
        if (!written && !quick) return;
        study_.error.emplace();
        read_quantity();
        read_reference();
        read_norm();
    }

    Found error_value(const std::string& name) const
    {
        if (quick_)
            if (const SceneValue* error = quick_->member("error"))
                if (const SceneValue* value = error->member(name)) return {value, "quick.error." + name};
        const SceneValue* error = document_.root().member("error");
        return {error ? error->member(name) : nullptr, "error." + name};
    }

    void read_quantity()
    {
        const Found probe = error_value("probe"), column = error_value("column"),
                    shape = error_value("shape");
        if ((probe.value != nullptr) + (column.value != nullptr) + (shape.value != nullptr) != 1)
            fail("error", "names not exactly one quantity", "one of probe, column, shape");
        if (error_value("axis").value && !probe.value)
            fail(error_value("axis").path, "has no probe", "axis with probe only");
        using Quantity = ErrorRule::Quantity;
        ErrorRule& rule = *study_.error;
        rule.quantity = probe.value ? Quantity::Probe : column.value ? Quantity::Column : Quantity::Shape;
        if (probe.value) rule.probe = text_of(probe, "the name of a probe of the scene");
        if (probe.value) rule.axis = choose("axis", "x|y|z", 2);
        if (column.value) rule.column = text_of(column, "a column of steps.csv");
        if (shape.value) rule.is_over_all_frames = choose("shape", "last|all", 0) == 1;
    }

    /// Index of an error key's value among `choices`, separated by '|'.
    int choose(const std::string& name, std::string_view choices, int fallback) const
    {
        const Found found = error_value(name);
        if (!found.value) return fallback;
        std::string allowed(choices);
        std::replace(allowed.begin(), allowed.end(), '|', ' ');
        const std::string text = text_of(found, allowed);
        int index = 0;
        for (std::size_t begin = 0; begin < choices.size(); ++index) {
            const std::size_t end = std::min(choices.find('|', begin), choices.size());
            if (choices.substr(begin, end - begin) == text) return index;
            begin = end + 1;
        }
        fail(found.path, "is not a choice", allowed);
    }

    void read_reference()
    {
        using Reference = ErrorRule::Reference;
        ErrorRule& rule = *study_.error;
        const bool is_shape = rule.quantity == ErrorRule::Quantity::Shape;
        const char* allowed = is_shape ? "\"finest\", or a table of settings of a further run"
                                       : "a formula in t, a CSV file's name, \"finest\", or a table of "
                                         "settings of a further run";
        const Found found = error_value("reference");
        if (!found.value) {
            if (rule.quantity != ErrorRule::Quantity::Column)
                fail("error.reference", "is required and missing", allowed);
            return;
        }
        if (found.value->kind == Kind::Table) {
            rule.reference = Reference::Run;
            rule.reference_run = settings_of(found);
            return;
        }
        const std::string text = text_of(found, allowed);
        if (text == "finest") {
            rule.reference = Reference::Finest;
        } else if (is_shape) {
            fail(found.path, "is no shape", allowed);
        } else if (text.ends_with(".csv")) {
            rule.reference = Reference::File;
            rule.formula = beside_study(text);
        } else {
            rule.reference = Reference::Formula;
            rule.formula = text;
            if (const std::string wrong = formula_error(text); !wrong.empty())
                fail(found.path, wrong, allowed);
        }
    }

    void read_norm()
    {
        using Norm = ErrorRule::Norm;
        constexpr Norm kOfHistory[] = {Norm::Max, Norm::Rms, Norm::Final};
        constexpr Norm kOfShape[] = {Norm::Mean, Norm::Max};
        ErrorRule& rule = *study_.error;
        rule.norm = rule.quantity == ErrorRule::Quantity::Shape
                        ? kOfShape[choose("norm", "mean|max", 0)]
                        : kOfHistory[choose("norm", "max|rms|final", 0)];
    }

    void read_repeats()
    {
        const Found found = find("repeats");
        if (!found.value) return;
        constexpr const char* kAllowed = "an integer from 1 to 100";
        require(found, Kind::Integer, kAllowed);
        if (found.value->integer < 1 || found.value->integer > kMostRepeats)
            fail(found.path, "is out of range", kAllowed);
        study_.repeats = static_cast<int>(found.value->integer);
    }

    SceneDocument document_;
    const SceneValue* quick_ = nullptr;
    Study study_;
};

}  // namespace

Study read_study(const std::string& path, bool is_quick)
{
    return StudyReader(path, is_quick).read();
}

}  // namespace arris
