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
  bool keepsPictures = false;  ///< of the taken views
};

/// One calibration: takes images, gives a report. One thread at a time.
class CalibrationSession {
 public:
  /// All images have `size`. Throws hal::Failure as tracking::TagDetector does.
  CalibrationSession(Board board, hal::FrameSize size, SessionOptions options = {});
  ~CalibrationSession();
  CalibrationSession(const CalibrationSession&) = delete;
  CalibrationSession& operator=(const CalibrationSession&) = delete;

  /// Takes the next image. Precondition: it is complete and of the session's size.
  ViewOutcome offer(const hal::ImageView& picture, hal::TimePoint time);

  const Board& board() const { return board_; }
  const ViewSelector& selector() const { return selector_; }
  CalibrationReport solve() const { return solveCalibration(selector_, size_); }
  /// The grey image of a view of selector(), if pictures are kept.
  const hal::Image& pictureOf(const SelectedView& view) const;
  /// If no image showed the board: another board that was seen instead, such as "a checkerboard of
  /// 8x5 inner corners"; nothing if there was none. Searches a few images, which takes seconds.
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
  std::vector<hal::Image> samples_;  ///< images without the board
};

}  // namespace pleinair::calibration
