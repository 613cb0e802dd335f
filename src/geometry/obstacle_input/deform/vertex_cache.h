// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// Samples a second where neither file nor scene says.
inline constexpr double kDefaultFramesPerSecond = 24.0;

struct VertexCacheRequest {
    std::string path;  ///< .mdd, .pc2, or a name with %d or %04d in place of a number, which ends in .obj
    std::optional<double> frames_per_second;  ///< default: times of an MDD file, else 24 frames a second
    std::optional<int> first, last;           ///< samples used; default: all
    int vertex_count = 0;                     ///< of the mesh that they move
};

/// Places of a mesh's vertices in time, as a file or a sequence of files holds them: in its units and axes,
/// for all its vertices in their order. Not thread-safe.
class VertexCache {
  public:
    virtual ~VertexCache() = default;

    /// s after the first sample used, ascending, at least one. Times that are multiples of one over a whole
    /// number of frames a second, to single precision, are these multiples.
    const std::vector<double>& times() const { return times_; }

    /// Whether the file holds single precision.
    bool is_single() const { return is_single_; }

    /// A sample used in words, for messages: "body.pc2: sample 12", "body_0012.obj".
    virtual std::string describe(std::size_t sample) const = 0;

    /// The places of one sample. They may be infinite or NaN. Throws InputError, one line with the file's
    /// name.
    virtual void read(std::size_t sample, std::vector<Vec3>& vertices) = 0;

  protected:
    VertexCache(std::vector<double> times, bool is_single) : times_(std::move(times)), is_single_(is_single)
    {
    }

  private:
    std::vector<double> times_;
    bool is_single_;
};

/// Opens MDD (LightWave; big-endian, with times) and PC2 files (3ds Max; little-endian, with the number of
/// frames from sample to sample), and sequences of OBJ files, of which the vertices are read. Samples count
/// from 0; those of a sequence are its files' numbers. Counts are compared with the file's length before
/// anything is allocated, and one sample is in memory at a time.
///
/// Throws InputError, one line that begins with the path: for a file that is missing, not regular, of another
/// format, too short or too long; without samples; with another number of vertices than the mesh; with times
/// that do not ascend; for a sequence with gaps; for `first` and `last` beyond its samples.
std::unique_ptr<VertexCache> open_vertex_cache(const VertexCacheRequest& request);

/// The files that a path of a request names: itself, or those of the sequence that exist, by number.
std::vector<std::string> list_cache_files(const std::string& path);

}  // namespace arris
