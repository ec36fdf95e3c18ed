#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "hal/error.h"
#include "pipeline/engine/painter.h"
#include "tests/support/needs_gpu.h"
#include "tests/support/test_pictures.h"

namespace pleinair {

/// The frame that a camera of 25 Hz takes at `number`.
inline hal::CapturedFrame frameOf(hal::Image image, int number) {
  const auto owned = std::make_shared<const hal::Image>(std::move(image));
  return {.image = owned->view(),
          .sequence = static_cast<std::uint64_t>(number),
          .captureTime = hal::TimePoint(hal::Duration(40'000'000) * number),
          .lease = owned};
}

inline hal::CapturedFrame testFrame(int number, hal::FrameSize size = {96, 64},
                                    hal::PixelFormat format = hal::PixelFormat::kRgb8) {
  return frameOf(support::testPicture({.pixelFormat = format, .size = size}, number), number);
}

inline std::vector<std::uint8_t> bytesOf(const hal::Image& image) {
  std::vector<std::uint8_t> bytes;
  for (const hal::PlaneView& plane : image.view().planes) {
    bytes.insert(bytes.end(), plane.bytes.begin(), plane.bytes.end());
  }
  return bytes;
}

/// Paints a frame and reads what came of it.
inline std::vector<std::uint8_t> painted(Painter& painter, const hal::CapturedFrame& frame,
                                         const PaintParameters& parameters) {
  const auto picture = painter.paint(frame, parameters);
  EXPECT_TRUE(picture) << picture.error().message();
  return bytesOf(hal::orThrow(painter.snapshot()));
}

inline std::vector<std::uint8_t> painted(Painter& painter, const hal::CapturedFrame& frame,
                                         std::string view = {}) {
  PaintParameters parameters = painter.defaultParameters();
  parameters.view = std::move(view);
  return painted(painter, frame, parameters);
}

class PainterTest : public support::NeedsGpu {};

}  // namespace pleinair
