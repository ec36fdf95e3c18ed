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

/// How a board is turned to the camera, of those that count.
enum class Tilt { kLeftNearer, kRightNearer, kTopNearer, kBottomNearer };
inline constexpr std::size_t kTilts = 4;

/// What one view adds to a calibration.
struct ViewTraits {
  std::bitset<kCells> cells;  ///< of the picture, row by row: those in which a corner lies
  /// Slope of the board's distance to the right and downwards: positive where its left, or its
  /// upper side is nearer; about 1 at 45°. From a guessed focal length.
  glm::dvec2 slope{0.0};
  double size = 0.0;  ///< root of the share of the picture between the board's outermost corners

  bool has(Tilt tilt) const;
  bool isNear() const;
};

/// Precondition: at least 4 corners, not in a line.
ViewTraits traitsOf(const Board& board, const BoardSighting& sighting, hal::FrameSize size);

/// What a set of views covers, and what it still wants.
class Coverage {
 public:
  static constexpr int kWantedPerCell = 2;
  static constexpr int kWantedPerTilt = 2;
  static constexpr int kWantedNear = 2;
  static constexpr int kWantedFar = 3;

  void add(const ViewTraits& traits) { count(traits, 1); }
  void remove(const ViewTraits& traits) { count(traits, -1); }

  /// How much of what is wanted a view would bring: cells it fills, more for tilts and sizes.
  double gain(const ViewTraits& traits) const;
  /// Whether nothing would be missing without this view, which is in.
  bool canSpare(const ViewTraits& traits) const;

  int viewsInCell(int column, int row) const;
  int viewsWith(Tilt tilt) const { return tilts_.at(static_cast<std::size_t>(tilt)); }
  /// Of the cells, that any view reaches.
  double coveredShare() const;
  /// The parts of the picture, of nine, that views hardly reach: "the upper left corner".
  std::vector<std::string> uncoveredRegions() const;
  /// What to do next: "bring the board to the upper left corner"; nothing where all is there.
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
