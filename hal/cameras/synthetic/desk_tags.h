#pragma once

#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

namespace pleinair::hal {

/// A tag that lies in the world, as a scene file describes it.
///
/// Tag frame: origin at the tag's centre, x right and y down as the upright tag is read, z away
/// from its reader (into the desk), metres. AprilTag's corner i lies at (−h, +h), (+h, +h),
/// (+h, −h), (−h, −h) with h = edge / 2: bottom left, then counter-clockwise as it is read. Those
/// are the object points of AprilTag 3.3's estimate_tag_pose().
struct DeskTag {
  int id = 0;
  std::string family;     ///< "tag36h11"
  double edgeMetres = 0;  ///< outer edge of the black border
  glm::dmat4 worldFromTag{1};
};

/// AprilTag's corner 0 … 3 in the frame of a tag with this edge (see DeskTag).
glm::dvec3 tagCorner(double edgeMetres, int corner);

/// The tags on the synthetic camera's desk; the same for every seed.
std::vector<DeskTag> deskTags();

}  // namespace pleinair::hal
