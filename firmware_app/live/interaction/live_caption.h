#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "firmware_app/live/interaction/live_tuning.h"
#include "hal/clock.h"

namespace pleinair::app {

/// The opacity of a caption: full for three seconds after the last restart(), then fading for half
/// a second.
class Fading {
 public:
  static constexpr hal::Duration kStays = std::chrono::seconds(3);
  static constexpr hal::Duration kFades = std::chrono::milliseconds(500);

  void restart(hal::TimePoint now) { restartedAt_ = now; }
  /// From 0 to 1.
  double opacity(hal::TimePoint now) const {
    if (!restartedAt_) return 0.0;
    const std::chrono::duration<double> faded = now - *restartedAt_ - kStays;
    if (faded.count() <= 0.0) return 1.0;
    const double left = 1.0 - faded / std::chrono::duration<double>(kFades);
    return left > 0.0 ? left : 0.0;
  }

 private:
  std::optional<hal::TimePoint> restartedAt_;
};

/// What the caption of a live painting says, in a window or on a bare display: for a while what the
/// last key has changed, or a notice; the keys where help is called up; a pinned text all the time.
/// One thread.
class LiveCaption {
 public:
  /// Both outlive this.
  LiveCaption(const LiveTuning& tuning, const hal::Clock& clock) : tuning_(tuning), clock_(clock) {}

  /// A key with a meaning was pressed, and handled by the tuning.
  void keyPressed();
  /// Shows a notice until the next key.
  void notify(const std::string& notice);
  /// Shows a text for as long as it is not empty.
  void pin(const std::string& text) { pinned_ = text; }

  struct Shown {
    std::string text;
    double opacity = 0.0;  ///< 0: nothing is to be seen
  };
  Shown shown(double framesPerSecond) const;

 private:
  std::string fadingText(double framesPerSecond) const;

  const LiveTuning& tuning_;
  const hal::Clock& clock_;
  Fading fading_;
  std::string notice_;
  std::string pinned_;
};

}  // namespace pleinair::app
