#pragma once

#include <glm/mat4x4.hpp>

namespace pleinair::scene {

/// Authors of scenes see a tag as it lies on a desk or hangs on a wall: x to its right, y to its
/// top, z out of it towards the viewer (the attach frame). Tracking's tag frame (tagCorners()) has
/// the same origin and x, but y down and z into the tag. The same half turn about x goes from a
/// camera as authors see it (x right, y up, z towards the viewer) to OpenCV's camera frame. It is
/// its own inverse.
inline constexpr glm::dmat4 kTagFromAttach{1.0, 0.0, 0.0,  0.0, 0.0, -1.0, 0.0, 0.0,
                                           0.0, 0.0, -1.0, 0.0, 0.0, 0.0,  0.0, 1.0};
inline constexpr glm::dmat4 kAttachFromTag = kTagFromAttach;

}  // namespace pleinair::scene
