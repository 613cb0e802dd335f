// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/deform/usda_cache.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <utility>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle_input/formats/input_file.h"
#include "geometry/obstacle_input/usd/usda_scanner.h"
#include "geometry/obstacle_input/usd/usda_stage.h"
#include "geometry/obstacle_input/usd/usda_transform.h"

namespace arris {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& why)
{
    throw InputError(path + ": " + why);
}

/// The points of a Mesh at any time code, interpolated linearly between samples, as USD does.
class UsdPoints {
  public:
    UsdPoints(const InputFile& file, UsdAttribute attribute) : file_(file), attribute_(std::move(attribute))
    {
        if (attribute_.samples.empty()) attribute_.samples = {{0.0, *attribute_.value}};
    }

    void read(double time_code, std::vector<Vec3>& points)
    {
        const std::vector<UsdSample>& samples = attribute_.samples;
        const auto after =
            std::upper_bound(samples.begin(), samples.end(), time_code,
                             [](double code, const UsdSample& sample) { return code < sample.time_code; });
        const auto next = static_cast<std::size_t>(after - samples.begin());
        const std::size_t last = next == 0 ? 0 : next - 1;
        points = at(last);
        if (next == 0 || next == samples.size() || !(time_code > samples[last].time_code)) return;
        const double share =
            (time_code - samples[last].time_code) / (samples[next].time_code - samples[last].time_code);
        const std::vector<Vec3>& other = at(next);
        for (std::size_t v = 0; v < points.size(); ++v)
            points[v] = (1.0 - share) * points[v] + share * other[v];
    }

  private:
    struct Held {
        std::size_t sample = 0;
        std::vector<Vec3> points;  // empty: none yet
    };

    // Of two neighbouring samples one is even.
    const std::vector<Vec3>& at(std::size_t sample)
    {
        Held& held = held_[sample % 2];
        if (held.points.empty() || held.sample != sample) {
            held.points.clear();
            parse(attribute_.samples[sample].value, held.points);
            held.sample = sample;
        }
        return held.points;
    }

    void parse(const UsdValue& value, std::vector<Vec3>& points) const
    {
        UsdScanner scan(file_, value.place);
        std::vector<double> numbers;
        scan.require('[');
        for (std::size_t v = 0; v < value.groups; ++v) {
            numbers.clear();
            if (v > 0) scan.require(',');
            scan.take_tuple(3, numbers);
            points.emplace_back(numbers[0], numbers[1], numbers[2]);
        }
        scan.take(',');
        scan.require(']');
    }

    const InputFile& file_;
    UsdAttribute attribute_;
    std::array<Held, 2> held_;
};

/// The time codes at which a mesh's points or placements have samples, ascending; 0 where it rests.
std::vector<double> find_time_codes(const UsdAttribute& points, const UsdTransform& transform)
{
    std::vector<double> codes = transform.time_codes();
    for (const UsdSample& sample : points.samples) codes.push_back(sample.time_code);
    if (codes.empty()) return {0.0};
    std::sort(codes.begin(), codes.end());
    codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
    return codes;
}

void require_counts(const std::string& path, const std::string& mesh, const UsdAttribute& points,
                    int vertex_count)
{
    const auto require = [&](const UsdValue& value, const std::string& where) {
        if (value.groups != static_cast<std::size_t>(vertex_count))
            refuse(path,
                   fmt::format("Mesh {} has {}{}; allowed: {}, the number of vertices in the obstacle's file",
                               mesh, counted(static_cast<long long>(value.groups), "point", "points"), where,
                               vertex_count));
    };
    for (const UsdSample& sample : points.samples)
        require(sample.value, fmt::format(" at time code {}", sample.time_code));
    if (points.samples.empty()) require(*points.value, "");
}

class UsdCache : public VertexCache {
  public:
    UsdCache(std::unique_ptr<InputFile> file, UsdAttribute points, UsdTransform transform,
             std::vector<double> time_codes, std::vector<double> times, const DeclaredFrame& declared)
        : VertexCache(std::move(times), points.type != "point3d[]", declared),
          file_(std::move(file)),
          points_(*file_, std::move(points)),
          transform_(std::move(transform)),
          time_codes_(std::move(time_codes))
    {
    }

    std::string describe(std::size_t sample) const override
    {
        return fmt::format("{}: time code {}", file_->path(), time_codes_[sample]);
    }

    void read(std::size_t sample, std::vector<Vec3>& vertices) override
    {
        points_.read(time_codes_[sample], vertices);
        const Eigen::Matrix4d placement = transform_.at(time_codes_[sample]);
        for (Vec3& vertex : vertices) vertex = (placement * vertex.homogeneous()).head<3>();
    }

  private:
    std::unique_ptr<InputFile> file_;
    UsdPoints points_;
    UsdTransform transform_;
    std::vector<double> time_codes_;  // of the samples used
};

/// s after the first time code.
std::vector<double> to_times(const std::string& path, const std::vector<double>& codes, double per_second)
{
    std::vector<double> times;
    for (const double code : codes) {
        times.push_back((code - codes.front()) / per_second);
        if (times.size() > 1 && !(times.back() > times[times.size() - 2] && times.back() < 1e9))
            refuse(path, fmt::format("time code {} is {} s after the first; allowed: times that ascend", code,
                                     times.back()));
    }
    return times;
}

}  // namespace

std::unique_ptr<VertexCache> open_usda(const VertexCacheRequest& request)
{
    auto file = std::make_unique<InputFile>(request.path);
    const UsdStage stage = read_usda_stage(*file);
    const int prim = find_usda_mesh(*file, stage, request.prim);
    const std::string mesh = one_line(stage.path(prim));
    const UsdAttribute* points = stage.prims[prim].find("points");
    if (points == nullptr || (!points->value && points->samples.empty()))
        refuse(request.path, fmt::format("Mesh {} has no points", mesh));
    if (stage.prims[prim].has_skeleton && points->samples.empty())
        refuse(request.path,
               fmt::format("Mesh {} is moved by a skeleton or blend shapes (UsdSkel), which are not "
                           "read; allowed: points with time samples",
                           mesh));
    require_counts(request.path, mesh, *points, request.vertex_count);
    UsdTransform transform(*file, stage, prim);
    std::vector<double> codes = find_time_codes(*points, transform);
    const SampleRange range = find_sample_range(request, codes.size());
    codes = std::vector<double>(codes.begin() + static_cast<std::ptrdiff_t>(range.first),
                                codes.begin() + static_cast<std::ptrdiff_t>(range.first + range.count));
    std::vector<double> times =
        to_times(request.path, codes, request.frames_per_second.value_or(stage.time_codes_per_second));
    return std::make_unique<UsdCache>(std::move(file), *points, std::move(transform), std::move(codes),
                                      std::move(times), DeclaredFrame{stage.metres_per_unit, stage.up});
}

}  // namespace arris
