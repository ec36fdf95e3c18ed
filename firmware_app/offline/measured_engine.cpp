#include "firmware_app/offline/measured_engine.h"

namespace pleinair::app {

hal::Result<measure::PaintedFrame> MeasuredEngine::paint(const hal::CapturedFrame& frame) {
  const hal::Result<Picture> picture = painter_.paint(frame, parameters_);
  if (!picture) return tl::unexpected(picture.error());
  hal::Result<hal::Image> output = painter_.snapshot();
  if (!output) return tl::unexpected(output.error());
  hal::Result<std::vector<marks::Anchor>> anchors = painter_.anchors();
  if (!anchors) return tl::unexpected(anchors.error());
  measure::PaintedFrame painted{
      .input = {}, .output = std::move(*output), .anchors = std::move(*anchors)};
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

}  // namespace pleinair::app
