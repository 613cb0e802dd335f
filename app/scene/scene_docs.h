// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace arris {

/// docs/scene.md: the reference of all keys of a scene file, generated from the table of keys.
std::string scene_markdown();

/// docs/scene.schema.json: all keys as a JSON schema (draft 7), with which editors check scene files.
std::string scene_schema();

}  // namespace arris
