#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "firmware_app/live/interaction/live_caption.h"
#include "hal/output.h"
#include "pipeline/runtime/output/output_stage.h"

namespace pleinair::app {

/// A caption over the frames of an output of this format, in the upper left corner of the picture
/// as people see it, whichever way the display hangs. Null where there is no room.
std::shared_ptr<const runtime::Caption> captionFor(const std::string& text,
                                                   const hal::OutputFormat& format);

/// Draws captions and hands them to bare displays. Main thread.
class DisplayCaptions {
 public:
  /// Shows what the caption says on these outputs, which outlive this. To be called often: the
  /// opacity changes from frame to frame.
  void update(const std::vector<runtime::OutputStage*>& displays, const LiveCaption& caption);

 private:
  struct Drawn {
    std::string text;
    hal::FrameFormat format;
    int quarterTurns = 0;
    std::shared_ptr<const runtime::Caption> caption;
  };
  std::map<const runtime::OutputStage*, Drawn> drawn_;  ///< what is shown now
};

}  // namespace pleinair::app
