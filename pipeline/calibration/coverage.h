#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "hal/pixel_format.h"
#include "pipeline/calibration/board_detector.h"

namespace pleinair::calibration {

inline constexpr int kCellColumns = 8;
inline constexpr int kCellRows = 6;
inline constexpr std::size_t kCells = std::size_t{kCellColumns} * kCellRows;

/// The required tilts of the board to the camera.
enum class Tilt { kLeftNearer, kRightNearer, kTopNearer, kBottomNearer };
inline constexpr std::size_t kTilts = 4;

/// The contribution of one view to a calibration.
struct ViewTraits {
  std::bitset<kCells> cells;  ///< the cells of the image that have a corner, row by row
  /// Gradient of the board's distance to the right and downwards: positive where its left or its
  /// upper side is nearer; about 1 at 45°. From a guessed focal length.
  glm::dvec2 slope{0.0};
  double size = 0.0;  ///< root of the image's share between the board's outermost corners

  bool has(Tilt tilt) const;
  bool isNear() const;
};

/// Precondition: at least 4 corners, not collinear.
ViewTraits traitsOf(const Board& board, const BoardSighting& sighting, hal::FrameSize size);

/// The coverage of a set of views, and what is missing.
class Coverage {
 public:
  static constexpr int kWantedPerCell = 2;
  static constexpr int kWantedPerTilt = 2;
  static constexpr int kWantedNear = 2;
  static constexpr int kWantedFar = 3;

  void add(const ViewTraits& traits) { count(traits, 1); }
  void remove(const ViewTraits& traits) { count(traits, -1); }

  /// Value of a view for the missing coverage: the number of cells it fills, more for tilts and
  /// sizes.
  double gain(const ViewTraits& traits) const;
  /// Whether the coverage would stay complete without this view, which it contains.
  bool isRedundant(const ViewTraits& traits) const;

  int viewsInCell(int column, int row) const;
  int viewsWith(Tilt tilt) const { return tilts_.at(static_cast<std::size_t>(tilt)); }
  /// Part of the cells with a corner in any view.
  double coveredShare() const;
  /// The nine regions of the image that views hardly reach: "the upper left corner".
  std::vector<std::string> uncoveredRegions() const;
  /// An instruction: "bring the board to the upper left corner"; nothing if the coverage is
  /// complete.
  std::optional<std::string> missingViews() const;
  bool isComplete() const { return !missingViews(); }

 private:
  void count(const ViewTraits& traits, int by);

  std::array<int, kCells> cells_{};
  std::array<int, kTilts> tilts_{};
  int near_ = 0;
  int far_ = 0;
};

}  // namespace pleinair::calibration
