// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/files/csv_table.h"
#include "app/files/frame.h"
#include "app/run/checkpoint.h"
#include "app/scene/parts/run_config.h"

namespace arris {

/// Locks a run's folder against other processes during its lifetime. Throws InputError if another process
/// holds the lock.
class FolderLock {
  public:
    explicit FolderLock(const std::string& path);
    FolderLock(FolderLock&& other) noexcept;
    FolderLock& operator=(FolderLock&&) = delete;
    ~FolderLock();

  private:
    int descriptor_;
};

/// Where a new run writes its files.
struct RunTarget {
    std::string path;
    bool is_overwriting = false;
    std::string program = "arris";  ///< as it was called, for advice
};

/// The files that a run writes while it runs: CSV files, frames and the checkpoint.
class RunDirectory {
  public:
    /// Creates the folder of a new run. If it holds a run or another file with the name of one of a run's
    /// files: throws InputError, or with `is_overwriting` removes these files and no others.
    static RunDirectory create(const RunTarget& target, const RunConfig& config);

    /// Opens the folder of a run that has been created, and has made no step.
    static RunDirectory begin_again(const std::string& path, const RunConfig& config);

    /// Opens the files of a run after truncating them to its checkpoint.
    static RunDirectory reopen(const std::string& path, const Checkpoint& checkpoint,
                               const RunConfig& config);

    const std::string& path() const { return path_; }

    void append_step(const StepRow& row) { steps_.append(format_row(row)); }
    void append_probes(double time, const std::vector<ProbeSample>& samples)
    {
        probes_.append(format_row(time, samples));
    }
    void write_frame(std::int64_t index, const Frame& frame);
    void write_checkpoint(const Checkpoint& checkpoint);

  private:
    RunDirectory(std::string path, FolderLock lock, CsvWriter steps, CsvWriter probes);

    std::string path_;
    FolderLock lock_;
    CsvWriter steps_, probes_;
};

/// Throws InputError with the reason unless `path` is the folder of a run.
void require_run(const std::string& path);

/// <run_dir>/assembly, the folder of the run that sews the cloth of this one.
std::string assembly_directory(const std::string& run_dir);

/// <run_dir>/assembly/cloth.obj, the sewn cloth.
std::string assembly_cloth_file(const std::string& run_dir);

/// The folder of the run whose cloth is sewn in `assembly_dir`.
std::string worn_directory(const std::string& assembly_dir);

/// <run_dir>/checkpoint, <run_dir>/steps.csv, <run_dir>/probes.csv
std::string checkpoint_file(const std::string& run_dir);
std::string steps_file(const std::string& run_dir);
std::string probes_file(const std::string& run_dir);

}  // namespace arris
