// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obj_outline.h"

#include <fmt/format.h>

#include <charconv>
#include <fstream>
#include <sstream>
#include <string_view>
#include <vector>

#include "geometry/input_error.h"

namespace arris {
namespace {

class OutlineReader {
  public:
    explicit OutlineReader(const std::string& path) : path_(path) {}

    ObjOutline read()
    {
        std::ifstream file(path_, std::ios::binary);
        if (!file) throw InputError(path_ + ": cannot be opened");
        for (std::string line; read_statement(file, line);) take(line);
        if (file.bad()) throw InputError(path_ + ": cannot be read to its end");
        // A face may name vertices that follow it.
        is_used_.assign(static_cast<std::size_t>(vertices_) + 1, 0);
        for (const Corner& corner : corners_) use(corner);
        outline_.vertex_count = vertices_;
        outline_.unused_vertex_count = vertices_ - used_;
        return outline_;
    }

  private:
    // Indices count from 1; uv is 0 where the corner has none.
    struct Corner {
        long long vertex;
        long long uv;
        int line;
    };

    // One statement: a line, with those that a backslash continues.
    bool read_statement(std::istream& file, std::string& statement)
    {
        statement.clear();
        for (std::string line; std::getline(file, line);) {
            ++line_;
            if (!line.empty() && line.back() == '\r') line.pop_back();
            const bool is_continued = !line.empty() && line.back() == '\\';
            if (is_continued) line.back() = ' ';
            statement += line;
            if (!is_continued) return true;
        }
        return !statement.empty();
    }

    void take(const std::string& statement)
    {
        std::istringstream words(statement.substr(0, statement.find('#')));
        std::string word;
        if (!(words >> word)) return;
        if (word == "v") ++vertices_;
        if (word == "vt") ++uvs_;
        if (word == "l" || word == "p") ++outline_.line_and_point_count;
        if (word == "f") take_face(words);
    }

    void take_face(std::istringstream& words)
    {
        int corners = 0;
        for (std::string word; words >> word; ++corners) take_corner(word);
        if (corners < 3)
            throw InputError(fmt::format("{}, line {}: a face of {} corners; at least 3 are needed", path_,
                                         line_, corners));
        ++outline_.face_count;
    }

    // vertex, vertex/uv, vertex/uv/normal or vertex//normal
    void take_corner(std::string_view word)
    {
        const std::size_t slash = word.find('/');
        Corner corner{read_index(word.substr(0, slash), vertices_), 0, line_};
        if (slash != std::string_view::npos) {
            const std::string_view rest = word.substr(slash + 1);
            const std::string_view uv = rest.substr(0, rest.find('/'));
            if (!uv.empty()) corner.uv = read_index(uv, uvs_);
        }
        corners_.push_back(corner);
    }

    // Negative indices count back from the last of `count` so far.
    long long read_index(std::string_view word, int count) const
    {
        long long index = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
        if (error != std::errc() || end != word.data() + word.size())
            throw InputError(fmt::format("{}, line {}: '{}' is no index", path_, line_, word));
        index = index < 0 ? count + index + 1 : index;
        // 0 stands for no index here.
        return index < 1 ? kOutOfRange : index;
    }

    void use(const Corner& corner)
    {
        require_in_range("vertex", corner.vertex, vertices_, corner.line);
        if (corner.uv != 0) require_in_range("UV", corner.uv, uvs_, corner.line);
        if ((corner.uv != 0) != (corners_.front().uv != 0))
            throw InputError(
                fmt::format("{}, line {}: some faces have UVs and some have none", path_, corner.line));
        char& flag = is_used_[static_cast<std::size_t>(corner.vertex)];
        if (flag == 0) ++used_;
        flag = 1;
    }

    void require_in_range(const char* what, long long index, int count, int line) const
    {
        if (index >= 1 && index <= count) return;
        const std::string name = index == kOutOfRange ? "0 or before the first" : std::to_string(index);
        throw InputError(fmt::format("{}, line {}: a face names {} {}, but there are {}, counted from 1",
                                     path_, line, what, name, count));
    }

    static constexpr long long kOutOfRange = -1;

    std::string path_;
    ObjOutline outline_;
    int line_ = 0;
    int vertices_ = 0;
    int uvs_ = 0;
    int used_ = 0;
    std::vector<Corner> corners_;
    std::vector<char> is_used_;
};

}  // namespace

ObjOutline read_obj_outline(const std::string& path)
{
    return OutlineReader(path).read();
}

}  // namespace arris
