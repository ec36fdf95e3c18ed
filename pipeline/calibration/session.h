#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "hal/image.h"
#include "pipeline/calibration/board_detector.h"
#include "pipeline/calibration/verdict.h"
#include "pipeline/calibration/view_selection.h"
#include "pipeline/tracking/image/luma.h"

namespace pleinair::calibration {

struct SessionOptions {
  ViewSelectionOptions selection;
  bool keepsPictures = false;  ///< of the views that are taken
};

/// One calibration: pictures in, a report out. One thread at a time.
class CalibrationSession {
 public:
  /// Pictures are of `size`. Throws hal::Failure as tracking::TagDetector.
  CalibrationSession(Board board, hal::FrameSize size, SessionOptions options = {});
  ~CalibrationSession();
  CalibrationSession(const CalibrationSession&) = delete;
  CalibrationSession& operator=(const CalibrationSession&) = delete;

  /// Precondition: complete, and of the session's size.
  ViewOutcome offer(const hal::ImageView& picture, hal::TimePoint time);

  const Board& board() const { return board_; }
  const ViewSelector& selector() const { return selector_; }
  CalibrationReport solve() const { return solveCalibration(selector_, size_); }
  /// The grey picture of a view of selector(), where pictures are kept.
  const hal::Image& pictureOf(const SelectedView& view) const;
  /// Where the board was in no picture, what was there instead: "a checkerboard of 8x5 inner
  /// corners"; nothing where nothing was. Looks at a few pictures; takes seconds.
  std::optional<std::string> otherBoard() const;

 private:
  struct Picture {
    std::uint64_t frame = 0;
    hal::Image grey;
  };
  void keep(std::uint64_t frame, const hal::PlaneView& luma);
  void keepSample(std::uint64_t frame, const hal::PlaneView& luma);

  Board board_;
  hal::FrameSize size_;
  SessionOptions options_;
  std::unique_ptr<BoardDetector> detector_;
  ViewSelector selector_;
  tracking::LumaConverter luma_;
  std::uint64_t frames_ = 0;
  std::vector<Picture> pictures_;
  std::vector<hal::Image> samples_;  ///< in which no board was found
};

}  // namespace pleinair::calibration
