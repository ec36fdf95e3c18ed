#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "hal/error.h"

struct apriltag_family;  // of libapriltag

namespace pleinair::tracking {

/// A family of libapriltag, owned.
struct TagFamily {
  std::unique_ptr<apriltag_family, void (*)(apriltag_family*)> handle;
  int correctedBits = 1;  ///< to tabulate codes with
};

/// Throws hal::Failure (kInvalidArgument) for an unknown family, with all names.
TagFamily openTagFamily(std::string_view name);

/// A printed tag as cells, the white border included.
struct TagBitmap {
  int cells = 0;              ///< a side
  int edgeCells = 0;          ///< a side of what tagCorners() are the corners of
  std::vector<bool> isWhite;  ///< row by row from the top left of the upright tag

  bool whiteAt(int row, int column) const {
    return isWhite.at(static_cast<std::size_t>(row * cells + column));
  }
};

/// The tag as libapriltag publishes it (apriltag_to_image()). Throws hal::Failure
/// (kInvalidArgument) for an unknown family, and for an id that it lacks, with the ids that it has.
TagBitmap tagBitmap(std::string_view family, int id);

}  // namespace pleinair::tracking
