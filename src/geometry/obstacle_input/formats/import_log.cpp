// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/formats/import_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <assimp/DefaultLogger.hpp>
#include <cctype>
#include <initializer_list>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle_input/formats/mesh_file_limits.h"

namespace arris {
namespace {

constexpr unsigned kSeverity = Assimp::Logger::Err | Assimp::Logger::Warn;

bool has_any(const std::string& line, std::initializer_list<const char*> words)
{
    return std::any_of(words.begin(), words.end(),
                       [&](const char* word) { return line.find(word) != std::string::npos; });
}

bool is_damage(const std::string& line)
{
    return has_any(line, {"out-of-range indices", "ertex index overflow", "ertex index out of range",
                          "Chunk overflow", "nexpected EOF"});
}

// Messages on materials and textures.
bool is_noise(std::string line)
{
    std::transform(line.begin(), line.end(), line.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return has_any(line, {"material", "texture"});
}

}  // namespace

ImportLog::ImportLog()
{
    Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
    Assimp::DefaultLogger::get()->attachStream(this, kSeverity);
}

ImportLog::~ImportLog()
{
    Assimp::DefaultLogger::get()->detachStream(this, kSeverity);
    Assimp::DefaultLogger::kill();
}

void ImportLog::write(const char* message)
{
    std::string line = one_line(message);
    line.erase(line.find_last_not_of(' ') + 1);
    // Remove assimp's prefix, "Warn, T0: ".
    if (const std::size_t head = line.find(": "); line.find(", ") < head) line.erase(0, head + 2);
    if (damage_.empty() && is_damage(line)) damage_ = line;
    if (is_noise(line) || std::find(lines_.begin(), lines_.end(), line) != lines_.end()) return;
    if (lines_.size() < kMostNotes)
        lines_.push_back(line);
    else
        ++left_out_;
}

void ImportLog::require_no_damage() const
{
    if (!damage_.empty()) throw InputError("damaged: " + damage_);
}

void ImportLog::append_to(std::vector<std::string>& warnings) const
{
    for (const std::string& line : lines_) warnings.push_back("importer: " + line);
    if (left_out_ > 0) warnings.push_back(fmt::format("importer: {} more messages", left_out_));
}

}  // namespace arris
