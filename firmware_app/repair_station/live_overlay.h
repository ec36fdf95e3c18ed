#pragma once

#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "firmware_app/overlay/step_content.h"
#include "hal/clock.h"
#include "hal/image.h"
#include "hal/pixel_format.h"
#include "pipeline/overlay/overlay_content.h"
#include "pipeline/scene/models/model.h"

namespace pleinair::app {

/// Makes the overlay of a procedure's current step when it changes, on threads of its own: the
/// instruction and the marks at once, and the inset and the movie, which take longer, after them.
/// Main thread.
class LiveOverlay {
 public:
  /// `machine`: the scene's model, which outlives this; null: there is none. `output`: size of the
  /// pictures. `cards`: ids of command cards.
  LiveOverlay(const scene::Model* machine, std::filesystem::path folder, hal::FrameSize output,
              bool showsInset, std::vector<int> cards);
  ~LiveOverlay();
  LiveOverlay(const LiveOverlay&) = delete;
  LiveOverlay& operator=(const LiveOverlay&) = delete;

  /// Shows a text for some seconds, in place of the last one: a check that failed.
  void notify(const std::string& text, hal::TimePoint now);
  /// The same for a failure, such as a full disk, which stands above other texts for its time.
  void notifyFailure(const std::string& text, hal::TimePoint now);
  /// The overlay, once it is made, if it is another one than that of the last call; else null. A
  /// new step comes without its inset first, whose place stays clear, and with it some 0.1 s later;
  /// its movie comes once it is decoded. Of a new text both are those before. The first call waits
  /// for all but the movie.
  std::shared_ptr<const overlay::OverlayContent> update(StepShown shown, hal::TimePoint now);

 private:
  using Content = std::shared_ptr<const overlay::OverlayContent>;
  using Movie = std::shared_ptr<const overlay::PanelMovie>;

  /// A part of a step that is made after its instruction: its inset, or its movie.
  template <class T>
  struct Late {
    std::optional<StepShown> of;  ///< the step that it was made for last, or is being made for
    T made{};
    std::future<T> making;  ///< the last member: its thread may use others of this class
    bool isFor(const StepShown& shown) const;
    bool isToBeMadeFor(const StepShown& shown) const;
    void take();
  };

  Content make(const StepShown& shown, hal::Image inset, Movie movie) const;
  hal::Image draw(const StepShown& shown) const;
  bool takeMade();
  void makeLate();

  const scene::Model* machine_;
  std::filesystem::path folder_;
  hal::FrameSize output_;
  bool showsInset_;
  std::vector<int> cards_;
  StepShown last_;  ///< that was made, or is being made
  Content content_;
  bool hasInset_ = false;  ///< the content that was made last, or is being made
  bool hasMovie_ = false;  ///< the same: also where the step has none
  struct Passing {
    std::string text;
    hal::TimePoint ends;
    const std::string& at(hal::TimePoint now);
  };
  Passing notice_;
  Passing failure_;
  // The last members: they use others.
  std::future<Content> making_;
  Late<hal::Image> inset_;
  std::stop_source movieEnds_;
  Late<Movie> movie_;
};

}  // namespace pleinair::app
