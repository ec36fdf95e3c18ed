#pragma once

#include <algorithm>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "hal/clock.h"
#include "pipeline/procedure/stepper.h"

namespace pleinair::app {

/// A still of the camera that a procedure waits for.
struct PendingStill {
  std::string step;  ///< that it belongs to
  /// The version by which it was asked for.
  std::shared_ptr<const procedure::Procedure> version;
  std::string when;  ///< "before", "after", "check", "extra"
  /// The answer that ends the step once the still is saved; nothing: the step goes on.
  std::optional<procedure::Answer> answer;
  bool compares = false;  ///< the still, compared with the template, is the answer
  hal::TimePoint requested{};

  bool endsStep() const { return answer || compares; }
};

/// The stills that are wanted, one after the other. One thread.
class PendingStills {
 public:
  /// A camera that gives no frame is not waited for longer.
  static constexpr hal::Duration kPatience = std::chrono::seconds(3);

  void add(PendingStill still) {
    stills_.push_back(std::move(still));
    if (stills_.size() == 1) isAsked_ = false;
  }
  /// Whether one is to be asked of the camera, once for each.
  bool takeRequest() {
    if (stills_.empty() || isAsked_) return false;
    isAsked_ = true;
    return true;
  }
  /// Removes the one that has come; nothing where none is wanted.
  std::optional<PendingStill> take() {
    if (stills_.empty()) return std::nullopt;
    PendingStill still = std::move(stills_.front());
    stills_.pop_front();
    isAsked_ = false;
    return still;
  }
  /// Whether an answer waits for its still.
  bool hasAnswer() const { return std::ranges::any_of(stills_, &PendingStill::endsStep); }
  /// Removes all if the first one is overdue; returns whether an answer was among them.
  bool dropOverdue(hal::TimePoint now) {
    if (stills_.empty() || now - stills_.front().requested < kPatience) return false;
    const bool had = hasAnswer();
    clear();
    return had;
  }
  void clear() {
    stills_.clear();
    isAsked_ = false;
  }

 private:
  std::deque<PendingStill> stills_;
  bool isAsked_ = false;
};

}  // namespace pleinair::app
