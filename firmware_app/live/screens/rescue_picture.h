#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware_app/live/runtime_rules.h"
#include "firmware_app/live/status/presentation_watch.h"
#include "hal/clock.h"
#include "hal/image.h"
#include "pipeline/present/waiting_picture.h"
#include "pipeline/runtime/frame_ledger.h"
#include "pipeline/runtime/output/output_stage.h"

namespace pleinair::app {

/// A picture with a text on screens, drawn by the processor: neither a camera nor GL is needed. A
/// screen that is not there, or goes, is waited for. One thread.
class RescuePicture {
 public:
  /// `targets`: outputs of kinds that show waiting pictures (hal::OutputTraits). `painting`: RGB8,
  /// washed out on the sheet; nothing: a landscape. The picture is shown again after each
  /// `renewal`; zero: never. The clock outlives this. Throws hal::Failure for a target that can
  /// be no output.
  RescuePicture(const std::vector<std::string>& targets, const OutputOpener& open,
                present::WaitingText text, std::optional<hal::Image> painting,
                hal::Duration renewal, hal::Clock& clock);

  /// To be called many times a second; never waits longer than a display takes to be opened.
  void step();
  std::vector<OutputProgress> progress() const;
  /// Why a screen shows nothing; empty: all show the picture.
  std::string problem() const;

 private:
  struct Screen {
    std::unique_ptr<runtime::OutputStage> stage;
    std::uint64_t drawnFor = 0;  ///< start of the output that the picture was drawn for
    std::shared_ptr<const hal::Image> picture;
    hal::TimePoint handedOver;
  };
  void draw(Screen& screen, std::uint64_t start) const;

  present::WaitingText text_;
  std::optional<hal::Image> painting_;
  hal::Duration renewal_;
  hal::Clock& clock_;
  runtime::FrameLedger ledger_;
  std::vector<Screen> screens_;
};

}  // namespace pleinair::app
