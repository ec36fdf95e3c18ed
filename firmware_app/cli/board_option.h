#pragma once

#include <optional>
#include <string>

#include "pipeline/calibration/board.h"

namespace pleinair::app {

/// The command line's options for a board, unparsed.
struct BoardOption {
  std::string kind;               ///< --board: "checkerboard:9x6" or "aprilgrid:6x6"
  std::optional<double> square;   ///< --square, metres
  std::optional<double> tagEdge;  ///< --tag-edge, metres
  std::optional<double> spacing;  ///< in tag edges
  std::optional<int> firstId;     ///< --first-id
};

/// The board that the options describe. Throws hal::Failure (kInvalidArgument) for an option that
/// is unknown, out of range, missing, or for another kind of board.
calibration::Board boardOf(const BoardOption& option);

}  // namespace pleinair::app
