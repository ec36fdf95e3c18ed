#pragma once

#include <array>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

namespace pleinair::hal {

/// A tag in the world, as a scene file describes it.
///
/// Tag frame: origin at the tag's centre, x right and y down as the upright tag is read, z away
/// from its reader (into the surface behind it), metres. AprilTag's corner i lies at (−h, +h), (+h,
/// +h), (+h, −h), (−h, −h) with h = edge / 2: bottom left first, then counter-clockwise as it is
/// read. These are the object points of AprilTag 3.3's estimate_tag_pose().
struct BenchTag {
  int id = 0;
  std::string family;     ///< "tag36h11"
  double edgeMetres = 0;  ///< outer edge of the black border
  glm::dmat4 worldFromTag{1};
};

/// AprilTag's corner 0 … 3 in the frame of a tag with this edge (see BenchTag).
glm::dvec3 tagCorner(double edgeMetres, int corner);

/// The tags of the synthetic camera's workbench; the same for every seed. Tag 0 lies on the bench's
/// top, at the world's origin and upright along its y; no object lies within 0.15 m along x and
/// 0.10 m along y of it.
std::vector<BenchTag> benchTags();

}  // namespace pleinair::hal

namespace pleinair::hal::synthetic {

/// Cells across a tag36h11 with its white border; the black border's outer edge is 8 cells long.
inline constexpr int kTagCells = 10;
inline constexpr int kTagCellsPerEdge = 8;

/// Whether each cell is white, [row][column] from the top left of the upright tag.
using TagBitmap = std::array<std::array<bool, kTagCells>, kTagCells>;

/// The tag36h11 with this id as libapriltag draws it. Precondition: the family has the id.
TagBitmap tag36h11Bitmap(int id);

}  // namespace pleinair::hal::synthetic
