#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "hal/clock.h"

namespace pleinair::runtime {

struct GovernorRules {
  std::size_t levels = 1;             ///< number of quality levels; 0 is the best
  std::optional<std::size_t> pinned;  ///< keeps this level
  double lowerAbove = 0.95;           ///< smoothed load above which quality is lowered
  double raiseBelow = 0.8;  ///< expected load of the level above below which quality is raised
  hal::Duration raiseAfter = std::chrono::seconds(2);
  hal::Duration maxRaiseAfter = std::chrono::minutes(1);
};

/// Keeps frames within their time budget by choosing the quality level. It lowers quality after
/// three of five frames were over budget, or the smoothed load is. It raises quality once the level
/// above has been expected to fit for a while, judged by the load when that level was left; if a
/// rise does not last, the next one waits twice as long. One thread.
class QualityGovernor {
 public:
  explicit QualityGovernor(GovernorRules rules);

  std::size_t level() const { return level_; }
  /// The best level that limit() permits.
  std::size_t best() const { return best_; }
  bool isLowest() const { return rules_.pinned || level_ + 1 == rules_.levels; }
  std::uint64_t lowered() const { return lowered_; }  ///< number of times so far
  std::uint64_t raised() const { return raised_; }    ///< number of times so far

  /// Notes that a frame painted at `level` took the share `load` of its time budget. Returns
  /// whether the level changes.
  bool painted(double load, std::size_t level, hal::TimePoint now);

  /// Permits this level and lower ones only, at once, until it is called again; 0: all. A level
  /// that is kept (GovernorRules::pinned) stays.
  void limit(std::size_t best, hal::TimePoint now);

 private:
  static constexpr std::size_t kWindow = 5;
  static constexpr std::size_t kEnough = 3;

  bool isOverBudget() const;
  double median() const;
  void lower(hal::TimePoint now);
  void raise(hal::TimePoint now);
  void change(std::size_t level, hal::TimePoint now);
  void learnRatio(hal::TimePoint now);
  double ratioAbove(hal::TimePoint now) const;
  bool mayRaise(hal::TimePoint now);

  GovernorRules rules_;
  std::size_t level_ = 0;
  std::size_t best_ = 0;
  std::uint64_t lowered_ = 0;
  std::uint64_t raised_ = 0;

  std::array<double, kWindow> recent_{};  ///< the last kWindow loads at this level
  std::size_t seen_ = 0;                  ///< number of frames at this level
  double smooth_ = 0.0;
  std::optional<double> loadBefore_;  ///< median load of the level above when it was left
  struct Learnt {
    double ratio = 1.0;  ///< load of level i divided by that of level i + 1
    hal::TimePoint at;
  };
  std::vector<Learnt> learnt_;
  hal::TimePoint fitsSince_;
  std::optional<hal::TimePoint> raisedAt_;  ///< time of a rise that has not yet lasted for kProof
  hal::Duration raiseAfter_;
};

}  // namespace pleinair::runtime
