#pragma once

#include "pipeline/engine/painter.h"
#include "pipeline/measure/measurement.h"

namespace pleinair::app {

/// The engine as a MeasuredPainter.
class MeasuredEngine final : public measure::MeasuredPainter {
 public:
  /// `painter` must outlive it and paints frames of `size`.
  MeasuredEngine(Painter& painter, PaintParameters parameters, hal::FrameSize size)
      : painter_(painter), parameters_(std::move(parameters)), size_(size) {}

  hal::Result<measure::PaintedFrame> paint(const hal::CapturedFrame& frame) override;
  void reset() override { painter_.reset(); }

 private:
  Painter& painter_;
  PaintParameters parameters_;
  hal::FrameSize size_;
};

}  // namespace pleinair::app
