#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <tuple>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "hal/cameras/synthetic/synthetic_camera.h"
#include "hal/image.h"

namespace pleinair::hal::synthetic {

/// Small frames, far apart in time: the workbench is painted fast and the frames differ.
inline SyntheticOptions smallOptions() {
  return {.size = {160, 120}, .framePeriod = std::chrono::milliseconds(200)};
}

/// The same of one shot, without noise.
inline SyntheticOptions noiseFreeOptions(SyntheticShot shot) {
  SyntheticOptions options = smallOptions();
  options.shot = shot;
  options.noiseSigma = 0;
  return options;
}

/// Keeps the workbench of a seed and size alive, so that a suite paints it once.
inline void keepWorkbenchOf(const SyntheticOptions& options) {
  static SteppedClock clock;
  static std::map<std::tuple<std::uint32_t, int, int>, std::unique_ptr<SyntheticCamera>> keepers;
  auto& keeper = keepers[{options.seed, options.size.width, options.size.height}];
  if (keeper) return;
  keeper = std::make_unique<SyntheticCamera>(
      SyntheticOptions{.size = options.size, .seed = options.seed}, clock);
  EXPECT_TRUE(keeper->start({}));
}

/// The first `count` frames of a new camera.
inline std::vector<Image> capturedFrames(const SyntheticOptions& options, int count) {
  SteppedClock clock;
  SyntheticCamera camera(options, clock);
  std::vector<Image> images;
  const Result<StreamFormat> format = camera.start({});
  keepWorkbenchOf(options);
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

/// The share of a frame's pixels that show something that moves.
inline double shareOf(const MovingMask& mask) {
  return static_cast<double>(std::ranges::count(mask.bytes, 255)) /
         static_cast<double>(mask.bytes.size());
}

}  // namespace pleinair::hal::synthetic
