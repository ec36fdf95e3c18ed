#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "pipeline/engine/painter.h"
#include "pipeline/measure/measurement.h"

namespace pleinair::app {

/// The engine as a MeasuredPainter.
class MeasuredEngine final : public measure::MeasuredPainter {
 public:
  /// `painter` must outlive it and paints frames of `size`. `readsMovers`: labels of movers are
  /// read back as well.
  MeasuredEngine(Painter& painter, PaintParameters parameters, hal::FrameSize size,
                 bool readsMovers)
      : painter_(painter),
        parameters_(std::move(parameters)),
        size_(size),
        readsMovers_(readsMovers) {}

  hal::Result<measure::PaintedFrame> paint(const hal::CapturedFrame& frame) override {
    const hal::Result<Picture> picture = painter_.paint(frame, parameters_);
    if (!picture) return tl::unexpected(picture.error());
    hal::Result<hal::Image> output = painter_.snapshot();
    if (!output) return tl::unexpected(output.error());
    hal::Result<std::vector<marks::Anchor>> anchors = painter_.anchors();
    if (!anchors) return tl::unexpected(anchors.error());
    hal::Result<std::optional<hal::Image>> movers;
    if (readsMovers_) movers = painter_.movers();
    if (!movers) return tl::unexpected(movers.error());
    measure::PaintedFrame painted{.input = {},
                                  .output = std::move(*output),
                                  .anchors = std::move(*anchors),
                                  .movers = std::move(*movers)};
    const hal::FrameFormat& format = frame.image.format;
    if (format.pixelFormat == hal::PixelFormat::kRgb8 && format.size == size_) {
      painted.input = hal::Image(frame.image);
      return painted;
    }
    hal::Result<hal::Image> input = painter_.cameraSnapshot();
    if (!input) return tl::unexpected(input.error());
    painted.input = std::move(*input);
    return painted;
  }
  void reset() override { painter_.reset(); }

 private:
  Painter& painter_;
  PaintParameters parameters_;
  hal::FrameSize size_;
  bool readsMovers_;
};

}  // namespace pleinair::app
