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
    /// .mdd, .pc2, .usda (.usd), .gltf, .glb, or a name with %d or %04d in place of a number, which ends in
    /// .obj
    std::string path;
    /// Default: times of an MDD file, time codes a second of a USD text, else 24 frames a second
    std::optional<double> frames_per_second;
    std::optional<int> first, last;        ///< samples used; default: all
    int vertex_count = 0;                  ///< of the mesh that they move
    std::optional<std::string> prim;       ///< path of the Mesh in a USD text; default: the only one
    std::optional<std::string> animation;  ///< name of that of a glTF file; default: the only one
};

/// Samples used of a file's.
struct SampleRange {
    std::size_t first = 0, count = 0;
};

/// The samples that the request asks for, of `samples`, at least one. Throws InputError that begins with the
/// path.
SampleRange find_sample_range(const VertexCacheRequest& request, std::size_t samples);

/// What the file itself says of its numbers.
struct DeclaredFrame {
    std::optional<double> metres_per_unit;
    std::optional<char> up;
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

    /// Unit and upward axis, where the file declares them.
    const DeclaredFrame& declared() const { return declared_; }

    /// A sample used in words, for messages: "body.pc2: sample 12", "body_0012.obj".
    virtual std::string describe(std::size_t sample) const = 0;

    /// The places of one sample. They may be infinite or NaN. Throws InputError, one line with the file's
    /// name.
    virtual void read(std::size_t sample, std::vector<Vec3>& vertices) = 0;

  protected:
    VertexCache(std::vector<double> times, bool is_single, DeclaredFrame declared = {})
        : times_(std::move(times)), is_single_(is_single), declared_(declared)
    {
    }

  private:
    std::vector<double> times_;
    bool is_single_;
    DeclaredFrame declared_;
};

/// Opens MDD (LightWave; big-endian, with times) and PC2 files (3ds Max; little-endian, with the number of
/// frames from sample to sample), sequences of OBJ files, of which the vertices are read, and USD texts: the
/// points of one Mesh, placed as it and the prims above it are. Samples count from 0; those of a sequence are
/// its files' numbers, those of a USD text all time codes of points and placements. Counts are compared with
/// the file's length before anything is allocated, and at most two samples are in memory at a time. glTF
/// files are held in memory: their animation is sampled from its first to its last key, and moves the
/// vertices that their import finds (GltfFigure).
///
/// Throws InputError, one line that begins with the path: for a file that is missing, not regular, of another
/// format, too short or too long; without samples; with another number of vertices than the mesh; with times
/// that do not ascend; for a sequence with gaps; for `first` and `last` beyond its samples.
std::unique_ptr<VertexCache> open_vertex_cache(const VertexCacheRequest& request);

/// Whether the path's extension is one of USD, text or binary; whether it is one of glTF.
bool is_usd_file(const std::string& path);
bool is_gltf_file(const std::string& path);

/// The files that a path of a request names: itself, or those of the sequence that exist, by number.
std::vector<std::string> list_cache_files(const std::string& path);

}  // namespace arris
