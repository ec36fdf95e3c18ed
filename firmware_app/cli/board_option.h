#pragma once

#include <optional>
#include <string>

#include "pipeline/calibration/board.h"

namespace pleinair::app {

/// A board as options of the command line tell it.
struct BoardOption {
  std::string kind;               ///< --board: "checkerboard:9x6" or "aprilgrid:6x6"
  std::optional<double> square;   ///< --square, metres
  std::optional<double> tagEdge;  ///< --tag-edge, metres
  std::optional<double> spacing;  ///< --spacing, of the tag edge
  std::optional<int> firstId;     ///< --first-id
};

/// Throws hal::Failure (kInvalidArgument): what is unknown, out of range, missing, or not of
/// that kind of board.
calibration::Board boardOf(const BoardOption& option);

}  // namespace pleinair::app
