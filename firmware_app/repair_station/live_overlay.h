#pragma once

#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware_app/overlay/step_content.h"
#include "hal/clock.h"
#include "hal/pixel_format.h"
#include "pipeline/overlay/overlay_content.h"
#include "pipeline/scene/models/model.h"

namespace pleinair::app {

/// Makes the overlay of a procedure's current step when it changes, on a thread of its own. Main
/// thread.
class LiveOverlay {
 public:
  /// `machine`: the scene's model, which outlives this; null: there is none. `output`: size of the
  /// pictures. `cards`: ids of command cards.
  LiveOverlay(const scene::Model* machine, std::filesystem::path folder, hal::FrameSize output,
              bool showsInset, std::vector<int> cards);

  /// Shows a text for some seconds, in place of the last one: a check that failed.
  void notify(const std::string& text, hal::TimePoint now);
  /// The same for a failure, such as a full disk, which stands above other texts for its time.
  void notifyFailure(const std::string& text, hal::TimePoint now);
  /// The overlay, once it is made, if it is another one than that of the last call; else null. A
  /// new step takes some 0.1 s, a new text a few ms; the first call waits for it.
  std::shared_ptr<const overlay::OverlayContent> update(StepShown shown, hal::TimePoint now);

 private:
  using Content = std::shared_ptr<const overlay::OverlayContent>;
  Content make(const StepShown& shown, const Content& before) const;

  const scene::Model* machine_;
  std::filesystem::path folder_;
  hal::FrameSize output_;
  bool showsInset_;
  std::vector<int> cards_;
  std::optional<StepShown> last_;  ///< that was made, or is being made
  Content content_;
  struct Passing {
    std::string text;
    hal::TimePoint ends;
    const std::string& at(hal::TimePoint now);
  };
  Passing notice_;
  Passing failure_;
  std::future<Content> making_;  ///< the last member: it uses others
};

}  // namespace pleinair::app
