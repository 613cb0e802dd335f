// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace arris {

/// Values at one x, such as the seconds of each phase at one time.
struct Sample {
    double x = 0.0;
    std::vector<double> values;
};

/// Thins a stream of any length to at most 1000 samples for a plot, in constant memory, and keeps its peaks:
/// the stream is divided into equal runs of successive samples, and each run keeps the samples with the least
/// and the greatest sum. Samples with a value that is not finite are ignored.
class PeakSampler {
  public:
    void add(const Sample& sample);

    /// The samples kept, in the order of the stream.
    std::vector<Sample> samples() const;

  private:
    struct Numbered {
        std::int64_t number;
        double sum;
        Sample sample;
    };
    struct Bucket {
        std::optional<Numbered> least, greatest;

        void take(const Numbered& candidate);
    };

    void merge_pairs();

    std::vector<Bucket> buckets_;
    std::int64_t samples_a_bucket_ = 1;
    std::int64_t count_ = 0;
};

}  // namespace arris
