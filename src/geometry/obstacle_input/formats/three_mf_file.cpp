// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/formats/three_mf_file.h"

#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <vector>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle_input/formats/mesh_file_limits.h"
#include "geometry/obstacle_input/formats/percent_code.h"
#include "geometry/obstacle_input/formats/three_mf_part.h"
#include "geometry/obstacle_input/formats/xml_elements.h"
#include "geometry/obstacle_input/formats/zip_archive.h"

namespace arris {
namespace {

constexpr const char* kRelationships = "_rels/.rels";
constexpr std::string_view kRootType = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";

constexpr std::size_t kDeepest = 1000;

// A part's name in the archive, which has no leading slash. References are percent-encoded; names of files in
// archives are not.
std::string part_name(std::string_view path)
{
    std::string name = std::filesystem::path(percent_decoded(path)).lexically_normal().generic_string();
    name.erase(0, name.find_first_not_of('/'));
    return name;
}

// Runs an action; an InputError then names the part.
template <class Action>
auto in_part(const std::string& name, Action action)
{
    try {
        return action();
    } catch (const InputError& error) {
        throw InputError(fmt::format("its part '{}': {}", one_line(name), error.what()));
    }
}

// The placement x -> turn x + shift, into the root part's unit.
struct Placement {
    Mat3 turn = Mat3::Identity();
    Vec3 shift = Vec3::Zero();
};

class PackageReader {
  public:
    PackageReader(std::string_view bytes, std::size_t most_faces) : archive_(bytes), most_faces_(most_faces)
    {
    }

    ThreeMfFile read()
    {
        const std::string root = find_root();
        file_.metres_per_unit = part(root).metres_per_unit;
        if (part(root).items.empty())
            throw InputError(fmt::format("its part '{}': its build has no items", one_line(root)));
        for (const ThreeMfReference& item : part(root).items) place(item, root, {});
        for (const auto& [type, count] : left_out_)
            file_.warnings.push_back(
                fmt::format("{} left out", counted(count, fmt::format("placed object of type '{}' is", type),
                                                   fmt::format("placed objects of type '{}' are", type))));
        for (const std::string& told : unread_) file_.warnings.push_back(told);
        return std::move(file_);
    }

  private:
    std::string find_root()
    {
        if (!archive_.contains(kRelationships))
            throw InputError(fmt::format("its archive has no '{}', which names the model", kRelationships));
        std::set<std::string> roots;
        XmlVisitor visitor;
        visitor.begin = [&](const XmlElement& element) {
            if (element.name.local == "Relationship" && element.find("Type") == kRootType)
                roots.insert(part_name(element.find("Target").value_or("")));
        };
        in_part(kRelationships, [&] { visit_xml(archive_.read(kRelationships), visitor); });
        if (roots.size() != 1)
            throw InputError(fmt::format("its archive holds {} models, by '{}'; allowed: one", roots.size(),
                                         kRelationships));
        return *roots.begin();
    }

    const ThreeMfPart& part(const std::string& name)
    {
        auto found = parts_.find(name);
        if (found == parts_.end()) {
            const std::string xml = archive_.read(name);
            found = parts_.emplace(name, in_part(name, [&] { return read_three_mf_part(xml); })).first;
        }
        return found->second;
    }

    // Places an object, and the objects that it refers to, under `parent`. The reference stands in `part_of`.
    void place(const ThreeMfReference& reference, const std::string& part_of, const Placement& parent)
    {
        const double unit = part(part_of).metres_per_unit / file_.metres_per_unit;
        const Placement placement = {parent.turn * reference.turn,
                                     parent.turn * (unit * reference.shift) + parent.shift};
        const std::string name = reference.path.empty() ? part_of : part_name(reference.path);
        const auto found = part(name).objects.find(reference.object);
        const std::string told =
            fmt::format("object {} of its part '{}'", one_line(reference.object), one_line(name));
        if (found == part(name).objects.end()) throw InputError(told + " is placed, but is not there");
        if (std::find(open_.begin(), open_.end(), &found->second) != open_.end())
            throw InputError(told + ": components refer to each other in a circle");
        if (open_.size() == kDeepest)
            throw InputError(fmt::format("{}: components nest deeper than {} levels", told, kDeepest));
        if (++placed_ > kMostNodes) throw InputError(fmt::format("more than {} placed objects", kMostNodes));
        const ThreeMfObject& object = found->second;
        if (object.type != "model" && object.type != "surface") {
            ++left_out_[object.type];
            return;
        }
        if (!object.foreign.empty())
            throw InputError(fmt::format("{} has its shape from <{}> of an extension, which is not read",
                                         told, object.foreign));
        if (object.faces.empty() && object.components.empty()) throw InputError(told + " has no mesh");
        if (!object.unread.empty())
            unread_.insert(
                fmt::format("{} has <{}> of an extension, which is not read", told, object.unread));
        append(object, placement, part(name).metres_per_unit / file_.metres_per_unit);
        open_.push_back(&object);
        for (const ThreeMfReference& component : object.components) place(component, name, placement);
        open_.pop_back();
    }

    void append(const ThreeMfObject& object, const Placement& placement, double unit)
    {
        ObstacleMesh& soup = file_.soup;
        const int base = static_cast<int>(soup.points.size());
        if (soup.faces.size() + object.faces.size() > most_faces_ ||
            soup.points.size() + object.points.size() > 3 * most_faces_)
            throw InputError(fmt::format("more than {} faces", most_faces_));
        for (const Vec3& p : object.points)
            soup.points.push_back(placement.turn * (unit * p) + placement.shift);
        // A mirroring placement reverses the orientation of faces.
        const bool is_mirrored = placement.turn.determinant() < 0.0;
        for (const auto& [a, b, c] : object.faces)
            soup.faces.push_back({base + a, base + (is_mirrored ? c : b), base + (is_mirrored ? b : c)});
    }

    ZipArchive archive_;
    std::size_t most_faces_;
    std::map<std::string, ThreeMfPart> parts_;
    ThreeMfFile file_;
    std::map<std::string, int> left_out_;  // numbers of objects, by type
    std::size_t placed_ = 0;
    std::vector<const ThreeMfObject*> open_;  // whose components are being placed
    std::set<std::string> unread_;            // warnings
};

}  // namespace

ThreeMfFile read_three_mf(std::string_view bytes, std::size_t most_faces)
{
    return PackageReader(bytes, most_faces).read();
}

}  // namespace arris
