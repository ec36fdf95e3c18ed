#pragma once

#include <string>

#include "firmware_app/live/interaction/live_caption.h"
#include "firmware_app/live/interaction/live_tuning.h"
#include "hal/clock.h"
#include "hal/outputs/window/window.h"

namespace pleinair::app {

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
  void notify(const std::string& notice) { caption_.notify(notice); }
  /// Puts a text on the desktop's clipboard, which keeps it while the window is open.
  void copy(const std::string& text) { window_.setClipboard(text); }
  /// Shows a text in the caption for as long as it is not empty.
  void pin(const std::string& text) { caption_.pin(text); }
  /// Updates title and caption. To be called before each image, and regularly while there is none.
  /// `imageFollows`: an image will draw the caption soon; otherwise it is drawn now. Errors: those
  /// of hal::Window::redraw().
  hal::Result<void> update(double framesPerSecond, bool imageFollows);

 private:
  void press(const hal::KeyPressed& key, Requests& requests);

  hal::Window& window_;
  LiveTuning& tuning_;
  const hal::Clock& clock_;
  LiveCaption caption_;
  bool isFullScreen_ = false;
  double drawnOpacity_ = 0.0;
  hal::TimePoint updated_;
};

}  // namespace pleinair::app
