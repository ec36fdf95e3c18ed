#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "hal/clock.h"
#include "pipeline/calibration/coverage.h"
#include "pipeline/calibration/lens_fit.h"

namespace pleinair::calibration {

struct ViewSelectionOptions {
  /// Whether pictures follow each other in time, so that the board's speed can be told: a movie or
  /// a camera; not photographs.
  bool isMovement = true;
  std::size_t mostViews = 40;
};

/// A view that was taken.
struct SelectedView {
  std::uint64_t frame = 0;  ///< number in the recording
  BoardSighting sighting;
  ViewTraits traits;
  double speed = 0.0;  ///< of the board, px a second; 0 where it cannot be told
};

/// What became of a picture.
enum class ViewOutcome { kTaken, kNoBoard, kBlurred, kMoving, kNothingNew };

struct ViewCounts {
  std::uint64_t pictures = 0;
  std::uint64_t withBoard = 0;
  std::uint64_t blurred = 0;
  std::uint64_t moving = 0;
  std::uint64_t nothingNew = 0;
};

/// Picks views out of what a camera sees, as they come: sharp, still, and such as add something. A
/// sharper one takes the place of one that shows the same.
class ViewSelector {
 public:
  ViewSelector(const Board& board, hal::FrameSize size, ViewSelectionOptions options = {});

  /// The next picture's sighting. Where it is taken, views() has it.
  ViewOutcome offer(std::uint64_t frame, hal::TimePoint time,
                    std::optional<BoardSighting> sighting);

  const std::vector<SelectedView>& views() const { return views_; }
  const Coverage& coverage() const { return coverage_; }
  const ViewCounts& counts() const { return counts_; }
  /// How sharp the board has been seen; 0 before. Of the fifth sharpest picture, once there are
  /// five: a single one may be a mistake.
  double sharpestEdgePx() const;
  /// Boards whose edges are wider than this are not taken.
  double widestEdgePx() const;
  /// Whether all that is wanted is there, and enough views.
  bool isComplete() const;

  /// For fitLens().
  std::vector<FitView> fitViews() const;

 private:
  ViewOutcome judge(std::uint64_t frame, const BoardSighting& sighting,
                    std::optional<double> speed);
  /// px a second against the last picture; nothing where that cannot be told.
  std::optional<double> speedOf(hal::TimePoint time, const BoardSighting& sighting) const;
  /// In diagonals of the picture; a board that is turned otherwise counts as one elsewhere.
  double differenceOf(const SelectedView& a, const SelectedView& b) const;
  void noteSharpness(double edgeWidthPx);
  void take(SelectedView view);
  void drop(std::size_t index);
  /// A view that the others make superfluous.
  std::optional<std::size_t> spareView() const;

  const Board& board_;
  hal::FrameSize size_;
  ViewSelectionOptions options_;
  double diagonalPx_;
  std::vector<SelectedView> views_;
  Coverage coverage_;
  ViewCounts counts_;
  std::vector<double> sharpest_;  ///< edge widths, rising; the first few
  std::optional<BoardSighting> last_;
  hal::TimePoint lastTime_;
};

/// Mean distance (px) of the corners that both show; nothing where those are fewer than four.
std::optional<double> cornerDistancePx(const BoardSighting& a, const BoardSighting& b);

}  // namespace pleinair::calibration
