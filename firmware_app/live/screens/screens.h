#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "firmware_app/live/screens/last_painting.h"
#include "firmware_app/live/screens/waiting_state.h"
#include "hal/clock.h"
#include "hal/error.h"
#include "hal/image.h"
#include "pipeline/runtime/output/output_stage.h"

namespace pleinair::app {

/// The outputs of a live painting that are all that people see of it, and the pictures that they
/// show while there are no paintings. Main thread.
class Screens {
 public:
  /// `choice`: the camera that was asked for. `state`: where the last painting is kept, and was by
  /// the run before; empty: nowhere. The clock outlives this.
  Screens(std::string choice, const std::filesystem::path& state, const hal::Clock& clock);

  /// Has waiting pictures shown again after each `interval`, so that they prove that screens still
  /// show something; zero: never.
  void renewAfter(hal::Duration interval) { renewal_ = interval; }
  /// The stage outlives this, and keeps its last frame. `keepsPainting`: whether its last painting
  /// is kept, and that of the run before is shown. `isStepped`: by this thread, as its output.
  void add(runtime::OutputStage& stage, bool keepsPainting, bool isStepped = false);
  bool isEmpty() const { return screens_.empty(); }
  std::vector<runtime::OutputStage*> stages() const;

  /// Draws the waiting pictures that are due and hands them to the stages, and keeps the last
  /// painting where that is due. To be called several times a second.
  void update(const LiveProgress& progress);
  /// Steps the stages, which have no threads yet, until each has shown its first picture, has
  /// failed or takes longer than a second.
  void showFirst(hal::Clock& clock);

  /// Keeps the last painting where that is due at the end of the run. The stages still exist.
  void finish();
  /// Why a painting could not be read or kept, once.
  std::optional<hal::Error> takeFailure() { return std::exchange(failure_, std::nullopt); }

 private:
  /// The text and the shape that a waiting picture was drawn for.
  struct Drawn {
    present::WaitingText text;
    hal::FrameFormat format;
    int quarterTurns = 0;
    bool isMirrored = false;
    std::uint64_t starts = 0;  ///< of the output, which forgets its picture
    friend bool operator==(const Drawn&, const Drawn&) = default;
  };
  struct Screen {
    runtime::OutputStage* stage = nullptr;
    bool keepsPainting = false;
    bool isStepped = false;
    std::optional<Drawn> shown;
    std::shared_ptr<const hal::Image> picture;  ///< for `shown`
    hal::TimePoint handedOver;
  };
  void draw(Screen& screen, const Drawn& wanted);
  void show(Screen& screen, bool fades) const;
  void keep(hal::TimePoint now);
  std::uint64_t paintingsShown() const;
  std::optional<hal::Image> lastPainting() const;
  static std::optional<hal::Image> uprightFrameOf(const runtime::OutputStage& stage);

  std::string choice_;
  present::WaitingPictures pictures_;
  std::uint64_t frames_ = 0;  ///< that were drawn washed out
  LastPainting store_;
  std::optional<hal::Image> last_;  ///< the one of the run before
  std::uint64_t kept_ = 0;          ///< paintingsShown(), when one was last kept
  std::optional<hal::Error> failure_;
  const hal::Clock& clock_;
  hal::Duration renewal_{0};
  WaitingState state_;
  std::vector<Screen> screens_;
};

}  // namespace pleinair::app
