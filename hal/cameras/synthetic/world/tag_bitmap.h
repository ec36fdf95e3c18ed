#pragma once

#include <array>

namespace pleinair::hal::synthetic {

/// Cells across a tag36h11 with its white border; the black border's outer edge is 8 cells long.
inline constexpr int kTagCells = 10;
inline constexpr int kTagCellsPerEdge = 8;

/// Whether each cell is white, [row][column] from the top left of the upright tag.
using TagBitmap = std::array<std::array<bool, kTagCells>, kTagCells>;

/// The tag36h11 with this id as libapriltag draws it. Precondition: the family has the id.
TagBitmap tag36h11Bitmap(int id);

}  // namespace pleinair::hal::synthetic
