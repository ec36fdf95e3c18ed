#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "firmware_app/live/live_tuning.h"
#include "hal/clock.h"
#include "hal/outputs/window/window.h"

namespace pleinair::app {

/// The opacity of the caption: full for three seconds after the last restart(), then fading for
/// half a second.
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

/// The window of a live painting: passes keys to the tuning, and shows the tuning's state in the
/// title and the caption. Only on the window's thread.
class LiveWindow {
 public:
  /// All references outlive this.
  LiveWindow(hal::Window& window, LiveTuning& tuning, const hal::Clock& clock);

  /// The user's requests since the last call.
  using Requests = LiveRequests;
  Requests takeRequests();

  /// Shows a notice in the caption until the next key.
  void notify(const std::string& notice);
  /// Updates title and caption. To be called before each image, and regularly while there is none.
  /// `imageFollows`: an image will draw the caption soon; otherwise it is drawn now. Errors: those
  /// of hal::Window::redraw().
  hal::Result<void> update(double framesPerSecond, bool imageFollows);

 private:
  void press(const hal::KeyPressed& key, Requests& requests);
  std::string caption(double framesPerSecond) const;

  hal::Window& window_;
  LiveTuning& tuning_;
  const hal::Clock& clock_;
  Fading fading_;
  std::string notice_;
  bool isFullScreen_ = false;
  double drawnOpacity_ = 0.0;
  hal::TimePoint updated_;
};

}  // namespace pleinair::app
