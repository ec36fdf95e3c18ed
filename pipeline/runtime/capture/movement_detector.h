#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "hal/clock.h"
#include "hal/frame_image.h"

namespace pleinair::runtime {

/// Whether something moves before a camera that stands: a coarse grid of mean brightness, four
/// times a second, against what it was in the seconds before. A change of all cells alike
/// (exposure, a lamp) and the camera's noise are no movement. Reads some 1 % of a frame, allocates
/// nothing. One thread.
class MovementDetector {
 public:
  static constexpr hal::Duration kInterval = std::chrono::milliseconds(250);

  /// Looks at a frame, if it is time for it; else its pixels are not mapped. Returns whether
  /// something moved. The first frame of a format moves nothing.
  bool look(const hal::FrameImage& image, hal::TimePoint captured);

 private:
  static constexpr int kColumns = 32;
  static constexpr int kRows = 24;
  static constexpr std::size_t kCells = std::size_t{kColumns} * kRows;
  using Grid = std::array<float, kCells>;

  static Grid gridOf(const hal::ImageView& image);
  bool hasMoved(const Grid& grid);

  std::optional<hal::FrameFormat> format_;
  hal::TimePoint lookedAt_;
  Grid usual_{};    ///< running mean
  Grid changes_{};  ///< a member for the sake of the stack
  Grid sorted_{};
};

}  // namespace pleinair::runtime
