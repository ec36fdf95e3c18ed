#pragma once

#include <deque>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "firmware_app/config/input_map.h"
#include "firmware_app/repair_station/command_cards.h"
#include "firmware_app/repair_station/live_procedure.h"
#include "hal/clock.h"
#include "hal/error.h"
#include "hal/keyboards/buttons.h"
#include "pipeline/procedure/notices.h"
#include "pipeline/procedure/step_command.h"

namespace pleinair::app {

/// Commands of another thread to a procedure: those that the status server takes. Any thread.
class StepCommandQueue {
 public:
  static constexpr std::size_t kMaxWaiting = 16;

  /// Error: kBusy, while too many wait.
  hal::Result<void> put(procedure::StepCommand command);
  /// The oldest; nothing where none waits.
  std::optional<procedure::StepCommand> take();

 private:
  std::mutex mutex_;
  std::deque<procedure::StepCommand> waiting_;
};

/// The inputs of a procedure that is carried out, beside the keys of the window: buttons of mapped
/// devices, command cards, commands from elsewhere. Main thread, but for devicesChanged().
class StepInputs {
 public:
  /// `queue`: null where nothing comes from elsewhere. All references outlive this.
  StepInputs(InputMap map, hal::KeyboardDevices& devices, LiveProcedure& procedure,
             StepCommandQueue* queue, const hal::Clock& clock);

  /// Devices may have come or gone. Any thread.
  void devicesChanged() { buttons_.devicesChanged(); }
  /// While another console is in front, buttons are not for us.
  void setPaused(bool on) { buttons_.setPaused(on); }

  /// What happened since the last call, beside the commands that the procedure got.
  struct Taken {
    bool any = false;                  ///< somebody did something
    bool togglesRaw = false;           ///< the camera's picture, or the painting again
    std::vector<std::string> notices;  ///< a device that has come or gone
    std::vector<hal::Error> problems;  ///< of devices that cannot be read
  };
  /// Commands from elsewhere wait while the procedure is busy: a program may send some at once.
  Taken poll();
  /// Takes the tags of a frame, each frame once, for command cards.
  void see(std::span<const ShownTag> tags, hal::TimePoint captured);

 private:
  void obey(const procedure::StepCommand& command, const std::string& source);
  std::string nameOf(std::size_t device) const;
  const procedure::Notices& notices() const { return procedure::noticesIn(procedure_.language()); }

  InputMap map_;
  LiveProcedure& procedure_;
  StepCommandQueue* queue_;
  hal::Buttons buttons_;
  CommandCards cards_;
  std::vector<hal::ButtonPressed> pressed_;  ///< a member so that its memory is reused, as below
  std::optional<hal::TimePoint> seen_;       ///< the last frame
  Taken taken_;
};

}  // namespace pleinair::app
