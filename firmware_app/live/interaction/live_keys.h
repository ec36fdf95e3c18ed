#pragma once

#include <string>
#include <vector>

#include "firmware_app/live/interaction/live_tuning.h"
#include "hal/clock.h"
#include "hal/keyboards/keyboards.h"

namespace pleinair::app {

/// The keys of a live painting on a screen without a desktop: they do what a window's do, but for
/// the full screen, which it is. Main thread.
class LiveKeys {
 public:
  /// All references outlive this.
  LiveKeys(hal::KeyboardChoice choice, hal::KeyboardDevices& devices, LiveTuning& tuning,
           const hal::Clock& clock);

  /// Keyboards may have come or gone. Any thread.
  void devicesChanged() { keyboards_.devicesChanged(); }
  /// While another console is in front, keys are not for us.
  void setPaused(bool on) { keyboards_.setPaused(on); }

  /// The user's requests since the last call, and lines for the log.
  struct Taken {
    LiveRequests requests;
    bool anyKey = false;               ///< of any meaning
    std::vector<std::string> state;    ///< what a window would show in its caption
    std::vector<hal::Error> problems;  ///< of keyboards that cannot be read
  };
  Taken take();

 private:
  hal::Keyboards keyboards_;
  LiveTuning& tuning_;
  std::vector<hal::KeyPressed> keys_;  ///< a member so that its memory is reused
};

}  // namespace pleinair::app
