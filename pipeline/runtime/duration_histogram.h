#pragma once

#include <array>
#include <cstdint>

#include "hal/clock.h"

namespace pleinair::runtime {

/// A histogram of durations whose buckets grow with the duration, so that any percentile is known
/// to 1 % in fixed memory (after HdrHistogram). Range: 1 µs to about a minute; others are clamped.
class DurationHistogram {
 public:
  void add(hal::Duration duration);
  void add(const DurationHistogram& other);
  void clear();

  std::uint64_t count() const { return count_; }
  hal::Duration sum() const { return sum_; }
  hal::Duration max() const { return max_; }
  /// The duration that a share (0 … 1) of all durations do not exceed; 0 if there are none.
  hal::Duration percentile(double share) const;

 private:
  static constexpr int kSubBuckets = 128;  // in each power of two
  static constexpr int kPowers = 20;
  static std::size_t bucketOf(std::uint64_t microseconds);
  static std::uint64_t upperEdge(std::size_t bucket);

  std::array<std::uint64_t, std::size_t{kSubBuckets} * kPowers> buckets_{};
  std::uint64_t count_ = 0;
  hal::Duration sum_{0};
  hal::Duration max_{0};
};

/// A histogram of the durations added within the last 30 to 60 s. It consists of two histograms
/// that take turns every 30 s. Allocates nothing.
class RecentDurations {
 public:
  static constexpr hal::Duration kHalf = std::chrono::seconds(30);

  void add(hal::Duration duration, hal::TimePoint now);
  /// Precondition: `now` is not before the last add().
  DurationHistogram recent(hal::TimePoint now) const;
  std::uint64_t count() const { return count_; }  ///< since the start
  hal::Duration sum() const { return sum_; }      ///< since the start

 private:
  std::array<DurationHistogram, 2> halves_;
  std::size_t current_ = 0;
  hal::TimePoint turned_;
  std::uint64_t count_ = 0;
  hal::Duration sum_{0};
};

}  // namespace pleinair::runtime
