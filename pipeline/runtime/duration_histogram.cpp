#include "pipeline/runtime/duration_histogram.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>

namespace pleinair::runtime {

// Below kSubBuckets a bucket is 1 µs wide; from there each power of two has kSubBuckets buckets.
std::size_t DurationHistogram::bucketOf(std::uint64_t microseconds) {
  if (microseconds < kSubBuckets) return static_cast<std::size_t>(microseconds);
  const auto power = static_cast<int>(std::bit_width(microseconds) -
                                      std::bit_width(std::uint64_t{kSubBuckets - 1}));
  const std::uint64_t within = (microseconds >> (power - 1)) - kSubBuckets;
  const std::size_t bucket = static_cast<std::size_t>(power) * kSubBuckets + within;
  return std::min(bucket, std::size_t{kSubBuckets} * kPowers - 1);
}

std::uint64_t DurationHistogram::upperEdge(std::size_t bucket) {
  const std::size_t power = bucket / kSubBuckets;
  const std::uint64_t within = bucket % kSubBuckets;
  if (power == 0) return within + 1;
  return (kSubBuckets + within + 1) << (power - 1);
}

void DurationHistogram::add(hal::Duration duration) {
  const auto microseconds = std::chrono::duration_cast<std::chrono::microseconds>(duration).count();
  ++buckets_.at(bucketOf(static_cast<std::uint64_t>(std::max<std::int64_t>(microseconds, 0))));
  ++count_;
  sum_ += duration;
  max_ = std::max(max_, duration);
}

void DurationHistogram::add(const DurationHistogram& other) {
  for (std::size_t i = 0; i < buckets_.size(); ++i) buckets_.at(i) += other.buckets_.at(i);
  count_ += other.count_;
  sum_ += other.sum_;
  max_ = std::max(max_, other.max_);
}

void DurationHistogram::clear() {
  *this = {};
}

hal::Duration DurationHistogram::percentile(double share) const {
  if (count_ == 0) return hal::Duration{0};
  const auto rank = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < buckets_.size(); ++i) {
    seen += buckets_.at(i);
    if (seen >= std::max<std::uint64_t>(rank, 1)) {
      return std::min<hal::Duration>(std::chrono::microseconds(upperEdge(i)), max_);
    }
  }
  return max_;
}

void RecentDurations::add(hal::Duration duration, hal::TimePoint now) {
  if (count_ == 0) turned_ = now;
  if (now - turned_ >= kHalf) {
    if (now - turned_ >= 2 * kHalf) halves_.at(current_).clear();
    current_ = 1 - current_;
    halves_.at(current_).clear();
    turned_ = now;
  }
  halves_.at(current_).add(duration);
  ++count_;
  sum_ += duration;
}

DurationHistogram RecentDurations::recent(hal::TimePoint now) const {
  // Only add() makes the halves take turns; halves that are too old are left out here.
  const hal::Duration age = now - turned_;
  if (age >= 2 * kHalf) return {};
  DurationHistogram recent = halves_.at(current_);
  if (age < kHalf) recent.add(halves_.at(1 - current_));
  return recent;
}

}  // namespace pleinair::runtime
