#include "firmware_app/live/live_painter.h"

#include <cassert>
#include <utility>

namespace pleinair::app {

LivePainter::LivePainter(const PainterOptions& options,
                         const std::vector<hal::OutputFormat>& outputs, LiveControls& controls)
    : painter_(options), controls_(controls), seen_(controls.parameters()), parameters_(*seen_) {
  warmUp(options);
  for (std::size_t i = 0; i < outputs.size(); ++i) open(i, outputs[i]);
}

void LivePainter::warmUp(const PainterOptions& options) {
  const hal::Image blank(options.expectedFormat.value_or(
      hal::FrameFormat{.pixelFormat = hal::PixelFormat::kGrey8, .size = options.pictureSize}));
  const std::size_t levels = options.qualityLevels ? qualityLevels().size() : 1;
  for (parameters_.quality = 0; parameters_.quality < levels; ++parameters_.quality) {
    if (options.isCancelled && options.isCancelled()) return;
    // An error is reported by the first frame, which has it too.
    static_cast<void>(painter_.paint({.image = blank.view()}, parameters_));
  }
  painter_.reset();
}

hal::Result<void> LivePainter::paint(const hal::CapturedFrame& frame, std::size_t quality) {
  if (auto newest = controls_.parameters(); newest != seen_) {
    parameters_ = *newest;
    seen_ = std::move(newest);
  }
  parameters_.quality = quality;
  const bool isSnapshot = controls_.takeSnapshotRequest();
  if (!isSnapshot) {
    const auto painted = painter_.paint(frame, parameters_);
    return painted ? hal::Result<void>() : tl::unexpected(painted.error());
  }
  // A snapshot shows the finished picture at the best quality, whatever view is painted.
  PaintParameters parameters = parameters_;
  parameters.view.clear();
  parameters.quality = 0;
  if (const auto painted = painter_.paint(frame, parameters); !painted) {
    return tl::unexpected(painted.error());
  }
  controls_.putSnapshot(painter_.snapshot());
  return {};
}

hal::Answer LivePainter::poll(std::size_t output, OutputFrame& frame) {
  return painter_.poll(readbacks_.at(output), frame);
}

void LivePainter::wait(hal::Duration limit) {
  // The next poll() reports a lost GPU.
  [[maybe_unused]] const auto isReady = painter_.waitForAny(limit);
}

void LivePainter::open(std::size_t output, const hal::OutputFormat& format) {
  assert(output == readbacks_.size());
  readbacks_.push_back(painter_.openReadback(format.frame, format.quarterTurns));
}

void LivePainter::close(std::size_t output) {
  painter_.closeReadback(readbacks_.at(output));
}

}  // namespace pleinair::app
