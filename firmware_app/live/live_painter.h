#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "firmware_app/live/live_controls.h"
#include "pipeline/engine/painter.h"
#include "pipeline/runtime/frame_painter.h"

namespace pleinair::app {

/// The engine's Painter for a live chain, with the parameters and snapshots that are asked for
/// meanwhile. `controls` outlives it.
class LivePainter final : public runtime::FramePainter {
 public:
  /// Throws hal::Failure.
  LivePainter(const PainterOptions& options, const std::vector<hal::FrameFormat>& outputs,
              LiveControls& controls);

  hal::Result<void> paint(const hal::CapturedFrame& frame, std::size_t quality) override;
  hal::Result<bool> take(std::size_t output, OutputFrame& picture) override;
  void open(std::size_t output, const hal::FrameFormat& format) override;
  void close(std::size_t output) override;

 private:
  Painter painter_;
  LiveControls& controls_;
  std::vector<int> readers_;
  std::vector<int> closed_;  ///< readers whose pictures are dropped
  OutputFrame dropped_;
  std::shared_ptr<const PaintParameters> seen_;  ///< what parameters_ was made from
  PaintParameters parameters_;
};

}  // namespace pleinair::app
