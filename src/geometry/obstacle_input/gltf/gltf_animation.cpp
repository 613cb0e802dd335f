// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/gltf/gltf_animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle_input/formats/mesh_file_limits.h"
#include "geometry/obstacle_input/gltf/gltf_document.h"

namespace arris {
namespace {

using nlohmann::json;

Eigen::Quaterniond to_quaternion(const double* xyzw)
{
    return Eigen::Quaterniond(xyzw[3], xyzw[0], xyzw[1], xyzw[2]).normalized();
}

std::string name_of(const json& animation)
{
    const json& name = gltf_member(animation, "name");
    return name.is_string() ? name.get<std::string>() : std::string();
}

const json& find_animation(const json& file, const std::optional<std::string>& name)
{
    const json& animations = gltf_member(file, "animations");
    if (!animations.is_array() || animations.empty()) throw InputError("it has no animation; allowed: one");
    std::vector<const json*> found;
    std::string names;
    for (std::size_t k = 0; k < animations.size(); ++k) {
        const std::string own = name_of(animations[k]);
        if (!name || own == *name) found.push_back(&animations[k]);
        if (k < kMostNotes)
            names += (k > 0 ? ", " : "") +
                     (own.empty() ? "one without a name" : fmt::format("\"{}\"", excerpt(own)));
    }
    if (animations.size() > kMostNotes) names += ", ...";
    if (found.empty())
        throw InputError(one_line(fmt::format("it has no animation \"{}\"; allowed: {}", *name, names)));
    if (found.size() > 1)
        throw InputError(one_line(fmt::format("it has {} animations{}: state `animation`; allowed: {}",
                                              found.size(), name ? " of that name" : "", names)));
    return *found[0];
}

GltfSampler::Kind kind_of(const json& sampler, const std::string& what)
{
    const json& kind = gltf_member(sampler, "interpolation");
    if (kind.is_null() || kind == "LINEAR") return GltfSampler::Kind::Linear;
    if (kind == "STEP") return GltfSampler::Kind::Step;
    if (kind == "CUBICSPLINE") return GltfSampler::Kind::CubicSpline;
    throw InputError(one_line(fmt::format("{}: its interpolation is {}; allowed: LINEAR, STEP, CUBICSPLINE",
                                          what, excerpt(kind.dump()))));
}

std::vector<double> read_times(const json& input, GltfAccessors& accessors, const std::string& what)
{
    std::vector<double> times = accessors.read(input, {"SCALAR", {kGltfSingle}}, what);
    if (times.empty()) throw InputError(what + " has no keys; allowed: at least one");
    for (std::size_t k = 1; k < times.size(); ++k)
        if (!(times[k] > times[k - 1]))
            throw InputError(
                fmt::format("{}: key {} is at {} s, the one before at {} s; allowed: times that ascend", what,
                            k, times[k], times[k - 1]));
    return times;
}

/// Numbers of a channel's values: of an element of `type`, or one a morph target.
GltfSampler read_sampler(const json& sampler, std::string_view type, std::size_t columns,
                         GltfAccessors& accessors, const std::string& what)
{
    GltfForm form = {type, {kGltfSingle}};
    if (type != "VEC3")
        form.components = {kGltfByte, kGltfUnsignedByte, kGltfShort, kGltfUnsignedShort, kGltfSingle};
    GltfSampler read;
    read.kind = kind_of(sampler, what);
    read.is_rotation = type == "VEC4";
    read.columns = columns;
    read.times = read_times(gltf_member(sampler, "input"), accessors, what);
    read.values = accessors.read(gltf_member(sampler, "output"), form, what);
    const std::size_t each = columns * (read.kind == GltfSampler::Kind::CubicSpline ? 3 : 1);
    if (read.values.size() != each * read.times.size())
        throw InputError(fmt::format("{} has {} numbers for {} keys; allowed: {} a key", what,
                                     read.values.size(), read.times.size(), each));
    const std::size_t skipped = each > columns ? columns : 0;  // the tangent in
    for (std::size_t k = 0; read.is_rotation && k < read.times.size(); ++k)
        if (!(Eigen::Map<const Eigen::Vector4d>(&read.values[each * k + skipped]).norm() > 0.0))
            throw InputError(fmt::format("{}: the rotation of key {} has length 0; allowed: 1", what, k));
    return read;
}

}  // namespace

std::vector<double> GltfSampler::at(double time) const
{
    const bool is_spline = kind == Kind::CubicSpline;
    const std::size_t each = is_spline ? 3 * columns : columns;
    const auto value = [&](std::size_t key) {
        return values.data() + each * key + (is_spline ? columns : 0);
    };
    const auto copy = [&](std::size_t key) { return std::vector<double>(value(key), value(key) + columns); };
    const auto after = std::upper_bound(times.begin(), times.end(), time);
    if (after == times.begin()) return copy(0);
    const auto k = static_cast<std::size_t>(after - times.begin()) - 1;
    if (after == times.end() || kind == Kind::Step) return copy(k);

    const double duration = times[k + 1] - times[k];
    const double s = (time - times[k]) / duration;
    const double *a = value(k), *b = value(k + 1);
    if (is_rotation && kind == Kind::Linear) {
        const Eigen::Quaterniond q = to_quaternion(a).slerp(s, to_quaternion(b));
        return {q.x(), q.y(), q.z(), q.w()};
    }
    std::vector<double> result(columns);
    for (std::size_t c = 0; c < columns; ++c) {
        if (kind == Kind::Linear) {
            result[c] = (1.0 - s) * a[c] + s * b[c];
            continue;
        }
        const double out = duration * a[columns + c], in = duration * values[each * (k + 1) + c];
        const double s2 = s * s, s3 = s2 * s;
        result[c] = (2.0 * s3 - 3.0 * s2 + 1.0) * a[c] + (s3 - 2.0 * s2 + s) * out +
                    (3.0 * s2 - 2.0 * s3) * b[c] + (s3 - s2) * in;
    }
    return result;
}

GltfAnimation::GltfAnimation(const json& file, const std::optional<std::string>& name,
                             const GltfFigure& figure, GltfAccessors& accessors)
{
    const json& animation = find_animation(file, name);
    const json& channels = gltf_member(animation, "channels");
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const json& target = gltf_member(channels[c], "target");
        const json& node = gltf_member(target, "node");
        if (node.is_null()) continue;  // of an extension
        const std::string what = fmt::format("channel {} of its animation", c);
        gltf_element(file, "nodes", node);
        Channel channel{node.get<std::size_t>(), Path::Translation, {}};
        const json& path = gltf_member(target, "path");
        std::string_view type = "VEC3";
        std::size_t columns = 3;
        if (path == "weights") {
            channel.path = Path::Weights;
            type = "SCALAR";
            columns = figure.rest()[channel.node].weights.size();
            if (columns == 0) continue;  // of a mesh that is not shown
        } else if (path == "rotation") {
            channel.path = Path::Rotation;
            type = "VEC4";
            columns = 4;
        } else if (path == "scale") {
            channel.path = Path::Scale;
        } else if (path != "translation") {
            throw InputError(one_line(fmt::format(
                "{} moves {}; allowed: translation, rotation, scale, weights", what, excerpt(path.dump()))));
        }
        if (channel.path != Path::Weights && figure.has_matrix(channel.node))
            throw InputError(
                fmt::format("{} moves node {}, which has a matrix; allowed: translation, rotation and "
                            "scale",
                            what, channel.node));
        const json& samplers = gltf_member(animation, "samplers");
        const json& index = gltf_member(channels[c], "sampler");
        if (!index.is_number_unsigned() || index.get<std::size_t>() >= samplers.size())
            throw InputError(one_line(fmt::format("{} names sampler {}, but there are {}", what,
                                                  excerpt(index.dump()), samplers.size())));
        channel.sampler = read_sampler(samplers[index.get<std::size_t>()], type, columns, accessors, what);
        const std::vector<double>& times = channel.sampler.times;
        first_key_ = channels_.empty() ? times.front() : std::min(first_key_, times.front());
        last_key_ = channels_.empty() ? times.back() : std::max(last_key_, times.back());
        channels_.push_back(std::move(channel));
    }
    if (channels_.empty()) throw InputError("its animation moves nothing; allowed: at least one channel");
}

void GltfAnimation::apply(double time, GltfPose& pose) const
{
    for (const Channel& channel : channels_) {
        std::vector<double> value = channel.sampler.at(time);
        GltfNodePose& node = pose[channel.node];
        switch (channel.path) {
            case Path::Translation:
                node.translation = {value[0], value[1], value[2]};
                break;
            case Path::Rotation:
                node.rotation = to_quaternion(value.data());
                break;
            case Path::Scale:
                node.scale = {value[0], value[1], value[2]};
                break;
            case Path::Weights:
                node.weights = std::move(value);
                break;
        }
    }
}

}  // namespace arris
