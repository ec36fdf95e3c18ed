#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "hal/clock.h"
#include "pipeline/calibration/coverage.h"
#include "pipeline/calibration/lens_fit.h"

namespace pleinair::calibration {

struct ViewSelectionOptions {
  /// Whether images follow each other in time, as in a movie or from a camera but not in
  /// photographs. If so, the board's speed is measured.
  bool isSequence = true;
  std::size_t maxViews = 40;
};

/// A taken view.
struct SelectedView {
  std::uint64_t frame = 0;  ///< number in the recording
  BoardSighting sighting;
  ViewTraits traits;
  double speed = 0.0;  ///< of the board, px per second; 0 where it is unknown
};

/// Outcome of an image.
enum class ViewOutcome { kTaken, kNoBoard, kBlurred, kMoving, kNothingNew };

struct ViewCounts {
  std::uint64_t pictures = 0;
  std::uint64_t withBoard = 0;
  std::uint64_t blurred = 0;
  std::uint64_t moving = 0;
  std::uint64_t nothingNew = 0;
};

/// Selects views from a stream of images: sharp, at rest, and adding coverage. A sharper view
/// replaces one that shows the same.
class ViewSelector {
 public:
  ViewSelector(const Board& board, hal::FrameSize size, ViewSelectionOptions options = {});

  /// Takes the next image's sighting. If the outcome is kTaken, views() contains it.
  ViewOutcome offer(std::uint64_t frame, hal::TimePoint time,
                    std::optional<BoardSighting> sighting);

  const std::vector<SelectedView>& views() const { return views_; }
  const Coverage& coverage() const { return coverage_; }
  const ViewCounts& counts() const { return counts_; }
  /// Edge width of the sharpest board seen; 0 before the first. From five images on it is the fifth
  /// smallest width, since a single one may be an error.
  double sharpestEdgePx() const;
  /// Boards with wider edges are not taken.
  double widestEdgePx() const;
  /// Whether the coverage is complete and there are enough views.
  bool isComplete() const;

  /// The views as fitLens() takes them.
  std::vector<FitView> fitViews() const;

 private:
  ViewOutcome judge(std::uint64_t frame, const BoardSighting& sighting,
                    std::optional<double> speed);
  /// Speed since the last image, px per second; nothing where it is unknown.
  std::optional<double> speedOf(hal::TimePoint time, const BoardSighting& sighting) const;
  /// In diagonals of the image; a rotation of the board counts like a distance.
  double differenceOf(const SelectedView& a, const SelectedView& b) const;
  void noteSharpness(double edgeWidthPx);
  void take(SelectedView view);
  void drop(std::size_t index);
  /// A view that the others make redundant.
  std::optional<std::size_t> redundantView() const;

  const Board& board_;
  hal::FrameSize size_;
  ViewSelectionOptions options_;
  double diagonalPx_;
  std::vector<SelectedView> views_;
  Coverage coverage_;
  ViewCounts counts_;
  std::vector<double> sharpest_;  ///< the smallest edge widths, rising
  std::optional<BoardSighting> last_;
  hal::TimePoint lastTime_;
};

/// Mean distance (px) of the corners that both show; nothing if they share fewer than four.
std::optional<double> cornerDistancePx(const BoardSighting& a, const BoardSighting& b);

}  // namespace pleinair::calibration
