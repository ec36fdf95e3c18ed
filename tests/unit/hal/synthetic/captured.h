#pragma once

#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "hal/cameras/synthetic/synthetic_camera.h"
#include "hal/image.h"

namespace pleinair::hal::synthetic {

/// Small and far apart in time, so that the desk is quickly painted and frames differ.
inline SyntheticOptions smallOptions() {
  return {.size = {160, 120}, .framePeriod = std::chrono::milliseconds(200)};
}

/// The first `count` frames of a new camera.
inline std::vector<Image> capturedFrames(const SyntheticOptions& options, int count) {
  SteppedClock clock;
  SyntheticCamera camera(options, clock);
  std::vector<Image> images;
  const Result<StreamFormat> format = camera.start({});
  EXPECT_TRUE(format) << format.error().message();
  while (format && static_cast<int>(images.size()) < count) {
    const NextFrame next = camera.next(kNoDeadline);
    const auto* frame = std::get_if<CapturedFrame>(&next);
    EXPECT_NE(frame, nullptr);
    if (frame == nullptr) break;
    images.emplace_back(frame->image);
  }
  return images;
}

inline std::span<const std::uint8_t> bytesOf(const Image& image) {
  return image.view().planes[0].bytes;
}

}  // namespace pleinair::hal::synthetic
