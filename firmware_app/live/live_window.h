#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "firmware_app/live/live_tuning.h"
#include "hal/clock.h"
#include "hal/outputs/window/window.h"

namespace pleinair::app {

/// How much of a caption is to be seen: all of it for three seconds after it was last called up,
/// then less for half a second.
class Fading {
 public:
  static constexpr hal::Duration kStays = std::chrono::seconds(3);
  static constexpr hal::Duration kFades = std::chrono::milliseconds(500);

  void callUp(hal::TimePoint now) { calledUp_ = now; }
  /// From 0 to 1.
  double opacity(hal::TimePoint now) const {
    if (!calledUp_) return 0.0;
    const std::chrono::duration<double> faded = now - *calledUp_ - kStays;
    if (faded.count() <= 0.0) return 1.0;
    const double left = 1.0 - faded / std::chrono::duration<double>(kFades);
    return left > 0.0 ? left : 0.0;
  }

 private:
  std::optional<hal::TimePoint> calledUp_;
};

/// The window of a live painting: keys to the tuning, and what the tuning says to the title and the
/// caption. On the window's thread.
class LiveWindow {
 public:
  /// All outlive this.
  LiveWindow(hal::Window& window, LiveTuning& tuning, const hal::Clock& clock);

  /// What the user has asked for since the last call.
  struct Requests {
    bool quit = false;
    bool snapshot = false;
    bool tuned = false;  ///< parameters, view or look may have changed
  };
  Requests takeRequests();

  /// Says something in the caption until the next key.
  void notify(const std::string& notice);
  /// Brings title and caption up to date; to be called before each picture, and while none comes.
  /// Errors: redraw()'s, where no picture follows.
  hal::Result<void> update(double framesPerSecond, bool pictureFollows);

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
