// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/report/peak_sampler.h"

#include <cmath>
#include <numeric>

namespace arris {
namespace {

constexpr std::size_t kMaxBuckets = 500;  // of two samples each; even, so that all buckets merge in pairs

}  // namespace

void PeakSampler::Bucket::take(const Numbered& candidate)
{
    if (!least || candidate.sum < least->sum) least = candidate;
    if (!greatest || candidate.sum > greatest->sum) greatest = candidate;
}

void PeakSampler::add(const Sample& sample)
{
    const double sum = std::accumulate(sample.values.begin(), sample.values.end(), 0.0);
    if (!std::isfinite(sum) || !std::isfinite(sample.x)) return;
    if (count_ / samples_a_bucket_ >= static_cast<std::int64_t>(kMaxBuckets)) merge_pairs();
    const auto bucket = static_cast<std::size_t>(count_ / samples_a_bucket_);
    if (bucket == buckets_.size()) buckets_.emplace_back();
    buckets_[bucket].take({count_++, sum, sample});
}

void PeakSampler::merge_pairs()
{
    for (std::size_t i = 0; i < buckets_.size(); i += 2) {
        Bucket merged = buckets_[i];
        if (i + 1 < buckets_.size()) {
            merged.take(*buckets_[i + 1].least);
            merged.take(*buckets_[i + 1].greatest);
        }
        buckets_[i / 2] = std::move(merged);
    }
    buckets_.resize((buckets_.size() + 1) / 2);
    samples_a_bucket_ *= 2;
}

std::vector<Sample> PeakSampler::samples() const
{
    std::vector<Sample> kept;
    for (const Bucket& bucket : buckets_) {
        const bool is_rising = bucket.least->number < bucket.greatest->number;
        const Numbered& first = is_rising ? *bucket.least : *bucket.greatest;
        const Numbered& second = is_rising ? *bucket.greatest : *bucket.least;
        kept.push_back(first.sample);
        if (first.number != second.number) kept.push_back(second.sample);
    }
    return kept;
}

}  // namespace arris
