#pragma once

#include <array>
#include <cstddef>

#include "hal/pixel_format.h"

namespace pleinair::app {

/// The stages of the thesis's table 1, ms a frame.
enum class ThesisStage : std::size_t { kTensorField, kFeatures, kWarping, kPainting };
inline constexpr std::size_t kThesisStages = 4;

struct StageTimes {
  std::array<double, kThesisStages> stages{};  ///< waiting for the GPU at each pass: medians
  double whole = 0.0;                          ///< without: median
};

/// Paints the workbench with painterly, `frames` frames forwards and backwards, `rounds` times; run
/// nothing else meanwhile. Throws hal::Failure like Painter.
StageTimes measureStages(hal::FrameSize size, int frames, int rounds);

}  // namespace pleinair::app
