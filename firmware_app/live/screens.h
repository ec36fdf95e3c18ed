#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware_app/live/last_painting.h"
#include "firmware_app/live/waiting_state.h"
#include "hal/clock.h"
#include "hal/image.h"
#include "pipeline/runtime/output_stage.h"

namespace pleinair::app {

/// The outputs of a live painting that are all that people see of it, and the pictures that they
/// show while there are no paintings. Main thread.
class Screens {
 public:
  /// `choice`: the camera that was asked for. `last`: the painting that the run before kept. The
  /// clock outlives this.
  Screens(std::string choice, std::optional<hal::Image> last, const hal::Clock& clock);

  /// The stage outlives this, and keeps its last frame. It lends surfaces, or is waited for.
  void add(runtime::OutputStage& stage) { screens_.push_back({.stage = &stage, .shown = {}}); }
  bool isEmpty() const { return screens_.empty(); }
  std::vector<runtime::OutputStage*> stages() const;

  /// Draws the waiting pictures that are due and hands them to the stages. To be called several
  /// times a second.
  void update(const LiveProgress& progress);
  /// Steps the stages, which have no threads yet, until each has shown its first picture, has
  /// failed or takes longer than a second.
  void showFirst(hal::Clock& clock);

  /// The last frame of the first screen that has shown one, upright.
  std::optional<hal::Image> lastPainting() const;

 private:
  /// What a waiting picture depends on.
  struct Drawn {
    present::WaitingText text;
    hal::FrameFormat format;
    int quarterTurns = 0;
    std::uint64_t starts = 0;  ///< of the output, which forgets its picture
    friend bool operator==(const Drawn&, const Drawn&) = default;
  };
  struct Screen {
    runtime::OutputStage* stage = nullptr;
    std::optional<Drawn> shown;
  };
  void draw(Screen& screen, const Drawn& wanted, bool fades) const;
  static std::optional<hal::Image> uprightFrameOf(const runtime::OutputStage& stage);

  std::string choice_;
  std::optional<hal::Image> last_;
  const hal::Clock& clock_;
  WaitingState state_;
  std::vector<Screen> screens_;
};

}  // namespace pleinair::app
