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
  std::size_t levels = 1;             ///< of quality, the best one 0
  std::optional<std::size_t> pinned;  ///< always this one
  double overBudget = 0.95;           ///< share of the budget from which quality is lowered
  double cheapEnough = 0.8;  ///< share below which the level above has to stay, as expected
  hal::Duration raiseAfter = std::chrono::seconds(2);
  hal::Duration longestRaiseAfter = std::chrono::minutes(1);
};

/// Keeps the cost of frames within their budget by choosing a level of quality. It goes down after
/// three dear frames of five, and up where the level above is expected to fit for a while, from
/// what it cost when it was left; a rise that does not last makes the next one wait twice as long.
/// One thread.
class QualityGovernor {
 public:
  explicit QualityGovernor(GovernorRules rules);

  std::size_t level() const { return level_; }
  bool isLowest() const { return rules_.pinned || level_ + 1 == rules_.levels; }
  std::uint64_t lowered() const { return lowered_; }  ///< how often so far
  std::uint64_t raised() const { return raised_; }    ///< likewise

  /// A frame painted at `level` took this share of its budget. True if the level changes.
  bool painted(double load, std::size_t level, hal::TimePoint now);

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
  std::uint64_t lowered_ = 0;
  std::uint64_t raised_ = 0;

  std::array<double, kWindow> recent_{};  ///< loads since the change, the last kWindow
  std::size_t seen_ = 0;                  ///< since the change
  double smooth_ = 0.0;
  std::optional<double> loadBefore_;  ///< of the level that was left downwards last
  struct Learnt {
    double ratio = 1.0;  ///< how much dearer than level i + 1 level i was
    hal::TimePoint at;
  };
  std::vector<Learnt> learnt_;
  hal::TimePoint cheapSince_;
  std::optional<hal::TimePoint> raisedAt_;  ///< until that rise has proved itself
  hal::Duration raiseAfter_;
};

}  // namespace pleinair::runtime
