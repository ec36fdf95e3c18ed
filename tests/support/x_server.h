#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

#include "hal/image.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::support {

/// A private X server in memory (Xvfb) on a free display, without a window manager, for one test.
class XServer {
 public:
  /// The reason why it is not available here: Xvfb or xdotool is not installed. Empty if it is.
  static std::string missing();

  /// Returns when it accepts clients. Throws std::runtime_error. Precondition: missing() is empty.
  explicit XServer(hal::FrameSize screen = {800, 600});
  ~XServer();
  XServer(const XServer&) = delete;
  XServer& operator=(const XServer&) = delete;

  /// Ends it at once, under whatever is shown on it.
  void kill();

  /// For the environment variable DISPLAY.
  const std::string& display() const { return display_; }
  /// The content of the screen, as RGB8.
  hal::Image screen() const;
  /// Presses keys, in xdotool's names ("shift+Tab"), in the window with the focus.
  void press(const std::vector<std::string>& keys) const;
  /// Waits a few seconds for a window whose title matches a regular expression; false if there is
  /// none by then.
  bool waitForTitle(const std::string& pattern) const;

 private:
  int xdotool(const std::vector<std::string>& arguments) const;

  TemporaryFolder folder_;  ///< contains the screen's memory
  std::string display_;
  pid_t process_ = -1;
};

}  // namespace pleinair::support
