// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "geometry/obstacle/point_cache.h"

namespace arris {

/// What the head of a file of poses says.
struct PoseFileHead {
    std::vector<double> times;  ///< s, ascending, at least one
    std::size_t point_count = 0;
    bool is_single = false;  ///< places are stored in single precision
    PoseInterpolation interpolation = PoseInterpolation::Cubic;
};

/// Poses of a deforming obstacle in a file: a head with its checksum, then samples of one length, each with
/// its checksum. The file stays open, so that it may be removed.
class PoseFile : public PoseSource {
  public:
    /// Opens and verifies a file, which is untrusted: throws InputError naming it if it is missing, of
    /// another kind or version, damaged, or holds values that are not allowed. One sample is in memory at a
    /// time.
    static std::shared_ptr<const PoseFile> open(const std::string& path);

    ~PoseFile() override;
    PoseFile(const PoseFile&) = delete;
    PoseFile& operator=(const PoseFile&) = delete;

    const std::vector<double>& times() const override { return head_.times; }
    std::size_t point_count() const override { return head_.point_count; }
    const PoseFileHead& head() const { return head_; }

    /// Throws InputError if the sample is damaged.
    void read(std::size_t sample, std::vector<Vec3>& points) const override;

    /// Bytes of the file.
    std::uint64_t size() const;

    /// Writes the same file under another name, atomically. Throws std::system_error naming the path.
    void copy_to(const std::string& path) const;

  private:
    friend class PoseFileWriter;
    PoseFile(int descriptor, std::string path);

    void read_head();
    void read_bytes(std::uint64_t offset, char* bytes, std::size_t count) const;
    std::uint64_t file_bytes() const;
    [[noreturn]] void fail(const std::string& what) const;

    int descriptor_;
    std::string path_;
    PoseFileHead head_;
    std::uint64_t head_bytes_ = 0;
    mutable std::string bytes_;  // of a sample
};

/// Writes poses to a temporary file without a name, which vanishes when the last user closes it.
class PoseFileWriter {
  public:
    /// Throws std::system_error naming the folder of temporary files where that has no room.
    explicit PoseFileWriter(PoseFileHead head);
    ~PoseFileWriter();
    PoseFileWriter(const PoseFileWriter&) = delete;
    PoseFileWriter& operator=(const PoseFileWriter&) = delete;

    void add(const std::vector<Vec3>& points);
    std::shared_ptr<const PoseFile> finish();  ///< after the last sample; once

  private:
    PoseFileHead head_;
    std::string folder_;
    int descriptor_ = -1;
    std::string bytes_;
};

}  // namespace arris
