#include "firmware_app/measured_engine.h"

namespace pleinair::app {

hal::Result<measure::PaintedFrame> MeasuredEngine::paint(const hal::CapturedFrame& frame) {
  const hal::Result<Picture> picture = painter_.paint(frame, parameters_);
  if (!picture) return tl::unexpected(picture.error());
  hal::Result<hal::Image> output = painter_.still();
  if (!output) return tl::unexpected(output.error());
  const hal::FrameFormat& format = frame.image.format;
  if (format.pixelFormat == hal::PixelFormat::kRgb8 && format.size == size_) {
    return measure::PaintedFrame{.input = hal::Image(frame.image), .output = std::move(*output)};
  }
  hal::Result<hal::Image> input = painter_.cameraStill();
  if (!input) return tl::unexpected(input.error());
  return measure::PaintedFrame{.input = std::move(*input), .output = std::move(*output)};
}

}  // namespace pleinair::app
