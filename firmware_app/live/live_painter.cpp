#include "firmware_app/live/live_painter.h"

#include <cassert>
#include <utility>

namespace pleinair::app {

LivePainter::LivePainter(const PainterOptions& options,
                         const std::vector<hal::FrameFormat>& outputs, LiveControls& controls)
    : painter_(options), controls_(controls), seen_(controls.parameters()), parameters_(*seen_) {
  for (const hal::FrameFormat& format : outputs) readers_.push_back(painter_.openReadback(format));
}

hal::Result<void> LivePainter::paint(const hal::CapturedFrame& frame, std::size_t quality) {
  if (auto newest = controls_.parameters(); newest != seen_) {
    parameters_ = *newest;
    seen_ = std::move(newest);
  }
  parameters_.quality = quality;
  for (const int reader : closed_) {
    for (;;) {
      const hal::Result<bool> taken = painter_.take(reader, dropped_, false);
      if (!taken) return tl::unexpected(taken.error());
      if (!*taken) break;
    }
  }
  const bool isStill = controls_.takeSnapshotRequest();
  if (!isStill) {
    const auto painted = painter_.paint(frame, parameters_);
    return painted ? hal::Result<void>() : tl::unexpected(painted.error());
  }
  // A still is the finished picture at its best, whatever is looked at.
  PaintParameters parameters = parameters_;
  parameters.view.clear();
  parameters.quality = 0;
  if (const auto painted = painter_.paint(frame, parameters); !painted) {
    return tl::unexpected(painted.error());
  }
  controls_.putSnapshot(painter_.snapshot());
  return {};
}

void LivePainter::open(std::size_t output, const hal::FrameFormat& format) {
  assert(output == readers_.size());
  readers_.push_back(painter_.openReadback(format));
}

void LivePainter::close(std::size_t output) {
  closed_.push_back(readers_.at(output));
}

hal::Result<bool> LivePainter::take(std::size_t output, OutputFrame& picture) {
  return painter_.take(readers_.at(output), picture, false);
}

}  // namespace pleinair::app
