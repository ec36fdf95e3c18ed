#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

#include "hal/image.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::support {

/// An X server in memory (Xvfb) on a free display, without a window manager, for one test.
class XServer {
 public:
  /// Why none can be had here: Xvfb or xdotool is not installed. Empty: it can.
  static std::string missing();

  /// Returns when it takes clients. Throws std::runtime_error. Precondition: missing() is empty.
  explicit XServer(hal::FrameSize screen = {800, 600});
  ~XServer();
  XServer(const XServer&) = delete;
  XServer& operator=(const XServer&) = delete;

  /// Ends it at once, under whatever is shown on it.
  void kill();

  /// For the environment variable DISPLAY.
  const std::string& display() const { return display_; }
  /// What is on the screen, as RGB8.
  hal::Image screen() const;
  /// Presses keys, named as xdotool has them ("shift+Tab"), for the window with the focus.
  void press(const std::vector<std::string>& keys) const;
  /// Waits until a window with a title that matches (a regular expression) is shown, at most some
  /// seconds; false if there is none by then.
  bool waitForTitle(const std::string& pattern) const;

 private:
  int xdotool(const std::vector<std::string>& arguments) const;

  TemporaryFolder folder_;  ///< with the screen's memory
  std::string display_;
  pid_t process_ = -1;
};

}  // namespace pleinair::support
