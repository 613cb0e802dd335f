// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/deform/gltf_cache.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle_input/formats/mesh_file_check.h"
#include "geometry/obstacle_input/formats/mesh_file_limits.h"
#include "geometry/obstacle_input/formats/mesh_folder_io.h"
#include "geometry/obstacle_input/gltf/gltf_file.h"

namespace arris {
namespace {

// Ten hours at 24 frames a second. A key at 1e30 s would ask for more samples than there is memory.
constexpr double kMostSamples = 1e6;

GltfMotion read_motion(const VertexCacheRequest& request)
{
    const std::filesystem::path path(request.path);
    const std::string extension = to_lower(path.extension().string()).substr(1);
    const std::string bytes = without_marks(extension, read_regular_file(path, kLargestFile));
    check_mesh_bytes(extension, bytes);
    const std::filesystem::path parent = path.parent_path();
    return read_gltf_motion(extension == "glb", bytes, parent.empty() ? "." : parent, request.animation);
}

/// Samples of an animation: a frame apart, and one at the last key if that is at no frame.
struct Frames {
    double rate = 0.0;      ///< 1/s
    double duration = 0.0;  ///< s, from the first to the last key
    std::size_t whole = 0;  ///< frames in it
    bool has_rest = false;

    std::size_t count() const { return whole + (has_rest ? 2 : 1); }
    /// s, from one sample to a later one. Where both are at frames, the quotient of two whole numbers.
    double between(std::size_t first, std::size_t last) const
    {
        if (last <= whole) return static_cast<double>(last - first) / rate;
        return first <= whole ? duration - static_cast<double>(first) / rate : 0.0;
    }
};

Frames find_frames(const GltfAnimation& animation, double rate)
{
    const double first = animation.first_key(), last = animation.last_key();
    const double frames = (last - first) * rate;
    if (!(frames < kMostSamples))
        throw InputError(
            fmt::format("its animation takes {} frames, from {} s to {} s; allowed: fewer than {:g}", frames,
                        first, last, kMostSamples));
    // Keys are in single precision.
    const double rounding = static_cast<double>(std::numeric_limits<float>::epsilon()) *
                            (std::abs(first) + std::abs(last)) * rate;
    const double whole = std::floor(frames + rounding);
    return {rate, last - first, static_cast<std::size_t>(whole), frames - whole > rounding};
}

class GltfCache : public VertexCache {
  public:
    GltfCache(std::string path, GltfMotion motion, std::size_t first, double begin, std::vector<double> times)
        : VertexCache(std::move(times), true, {1.0, 'y'}),
          path_(std::move(path)),
          motion_(std::move(motion)),
          pose_(motion_.figure.rest()),
          first_(first),
          begin_(begin)
    {
    }

    std::string describe(std::size_t sample) const override
    {
        return fmt::format("{}: sample {}, at {:.6g} s", path_, first_ + sample, begin_ + times()[sample]);
    }

    void read(std::size_t sample, std::vector<Vec3>& vertices) override
    {
        motion_.animation.apply(begin_ + times()[sample], pose_);
        motion_.figure.place(pose_, vertices);
    }

  private:
    std::string path_;
    GltfMotion motion_;
    GltfPose pose_;
    std::size_t first_;
    double begin_;  // s in the animation, of the first sample used
};

std::unique_ptr<VertexCache> open(const VertexCacheRequest& request)
{
    GltfMotion motion = read_motion(request);
    if (const std::size_t count = motion.figure.vertex_count();
        count != static_cast<std::size_t>(request.vertex_count))
        throw InputError(
            fmt::format("shows {} vertices; allowed: {}, the number of vertices in the obstacle's file",
                        count, request.vertex_count));
    const Frames frames =
        find_frames(motion.animation, request.frames_per_second.value_or(kDefaultFramesPerSecond));
    const SampleRange range = find_sample_range(request, frames.count());
    std::vector<double> times;
    for (std::size_t k = 0; k < range.count; ++k)
        times.push_back(frames.between(range.first, range.first + k));
    const double begin = motion.animation.first_key() + frames.between(0, range.first);
    return std::make_unique<GltfCache>(request.path, std::move(motion), range.first, begin, std::move(times));
}

}  // namespace

std::unique_ptr<VertexCache> open_gltf(const VertexCacheRequest& request)
{
    try {
        return open(request);
    } catch (const InputError& error) {
        throw InputError(request.path + ": " + error.what());
    }
}

}  // namespace arris
