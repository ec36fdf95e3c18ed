#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "firmware_app/live/live_controls.h"
#include "pipeline/engine/painter.h"
#include "pipeline/runtime/frame_painter.h"

namespace pleinair::app {

/// The engine's Painter for a live pipeline, in its own GL context. It applies the parameter sets
/// and snapshot requests of `controls`, which outlives it. Paint thread only.
class LivePainter final : public runtime::FramePainter {
 public:
  /// Throws hal::Failure.
  LivePainter(const PainterOptions& options, const std::vector<hal::OutputFormat>& outputs,
              LiveControls& controls);

  hal::Result<void> paint(const hal::CapturedFrame& frame, std::size_t quality) override;
  hal::Answer poll(std::size_t output, OutputFrame& frame) override;
  void wait(hal::Duration limit) override;
  void open(std::size_t output, const hal::OutputFormat& format) override;
  void close(std::size_t output) override;
  std::span<const gpu::PassTime> passTimes() const override { return painter_.passTimes(); }

 private:
  /// Paints a blank frame at each quality level with the first parameter set, which the Painter,
  /// warmed up with the defaults, does not know: buffers are allocated and programs used for the
  /// first time here instead of in the first frame.
  void warmUp(const PainterOptions& options);

  Painter painter_;
  LiveControls& controls_;
  std::vector<int> readbacks_;
  std::shared_ptr<const PaintParameters> seen_;  ///< the origin of parameters_
  PaintParameters parameters_;
};

}  // namespace pleinair::app
