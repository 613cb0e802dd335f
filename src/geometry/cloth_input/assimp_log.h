// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <assimp/DefaultLogger.hpp>
#include <cctype>
#include <string>
#include <vector>

namespace arris {

/// Records assimp's warnings and errors during its lifetime.
class AssimpLog : public Assimp::LogStream {
  public:
    AssimpLog()
    {
        Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
        Assimp::DefaultLogger::get()->attachStream(this, kSeverity);
    }
    ~AssimpLog() override
    {
        Assimp::DefaultLogger::get()->detachStream(this, kSeverity);
        Assimp::DefaultLogger::kill();
    }
    AssimpLog(const AssimpLog&) = delete;
    AssimpLog& operator=(const AssimpLog&) = delete;

    void write(const char* message) override
    {
        std::string line = message;
        while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back())) != 0) line.pop_back();
        lines.push_back("assimp: " + line);
    }

    std::vector<std::string> lines;

  private:
    static constexpr unsigned kSeverity = Assimp::Logger::Err | Assimp::Logger::Warn;
};

}  // namespace arris
