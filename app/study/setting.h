// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/scene/keys/scene_document.h"

namespace arris {

/// A scene key with a value.
struct Setting {
    std::string key;               ///< dotted, as for --set
    std::string toml;              ///< the value as TOML
    std::string text;              ///< the value as shown: a text without quotes
    std::optional<double> number;  ///< of a number; of cloth.resolution: cells along the longer side
};

/// The value must hold no date (such a value has no TOML text here); see `has_date`.
Setting make_setting(const std::string& key, const SceneValue& value);

/// Whether a date is in the value. No scene key takes dates.
bool has_date(const SceneValue& value);

/// "KEY=VALUE" for --set.
std::string assignment(const Setting& setting);

/// The setting of a key, or null.
const Setting* find_setting(const std::vector<Setting>& settings, const std::string& key);

/// The key without the index of a piece of cloth: "cloth.resolution" for "cloth.1.resolution".
std::string without_piece(const std::string& key);

/// Whether a key changes how a problem is computed (mesh, time step, solver, EOL vertices, output), not the
/// problem itself: runs that differ only in such keys should have the same result.
bool is_numerical_key(const std::string& key);

/// How a curve, a table or a sentence names a setting: "EOL", "rows only", "bdf2", "time.step = 0.01".
std::string label_setting(const Setting& setting);

/// Settings as "key = value, key = value".
std::string list_settings(const std::vector<Setting>& settings);

}  // namespace arris
