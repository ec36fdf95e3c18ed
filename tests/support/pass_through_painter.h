#pragma once

#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "hal/image.h"
#include "pipeline/runtime/paint/frame_painter.h"

namespace pleinair::support {

/// A painter without a GPU: passes each frame to all outputs at once, grey, at the frame's size.
class PassThroughPainter final : public runtime::FramePainter {
 public:
  hal::Result<void> paint(const hal::CapturedFrame& frame, std::size_t) override {
    for (std::size_t i = 0; i < waiting_.size(); ++i) {
      if (isOpen_[i]) waiting_[i].push_back(frame);
    }
    return {};
  }
  void open(std::size_t, const hal::OutputFormat&) override {
    waiting_.emplace_back();
    isOpen_.push_back(true);
  }
  void close(std::size_t output) override {
    waiting_.at(output).clear();
    isOpen_.at(output) = false;
  }
  hal::Answer poll(std::size_t output, OutputFrame& picture) override {
    auto& pictures = waiting_.at(output);
    if (pictures.empty()) return false;
    const hal::CapturedFrame frame = std::move(pictures.front());
    pictures.pop_front();
    if (picture.image.format() != frame.image.format) {
      picture.image = hal::Image(frame.image);
    } else {
      for (int y = 0; y < picture.image.size().height; ++y) {
        std::ranges::copy(frame.image.map().view().row(0, y), picture.image.row(0, y).begin());
      }
    }
    picture.sequence = frame.sequence;
    picture.captureTime = frame.captureTime;
    return true;
  }
  void wait(hal::Duration) override {}  // all is ready at once

 private:
  std::vector<std::deque<hal::CapturedFrame>> waiting_;
  std::vector<bool> isOpen_;
};

}  // namespace pleinair::support
