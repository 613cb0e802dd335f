// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace arris {

/// docs/scene.md: every key of a scene file, generated from the table of keys.
std::string scene_markdown();

/// docs/scene.schema.json: the same as a JSON schema (draft 7), which editors check TOML files with.
std::string scene_schema();

}  // namespace arris
