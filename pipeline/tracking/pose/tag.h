#pragma once

#include <array>
#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace pleinair::tracking {

/// A tag's corners in an image, in the AprilTag library's order; see tagCorners().
using TagCornersPx = std::array<glm::dvec2, 4>;

/// The tag frame, shared by tracking, scenes and simulated cameras. It is that of the AprilTag
/// library 3.3 (the object points of its estimate_tag_pose). The origin is the tag's centre. Seen
/// as the tag's image is published (AprilRobotics' apriltag-imgs, apriltag_to_image), x points
/// right, y down, and z into the tag, away from the viewer. So the cameraFromTag of a tag that
/// faces the camera upright has no rotation.
///
/// The corners are those of the black border's outer edge. They begin at the image's bottom left
/// and go counter-clockwise: bottom left, bottom right, top right, top left. OpenCV's
/// DICT_APRILTAG_36h11 images are rotated by 180° against these; there the first corner is the
/// image's top right.
///
/// `edge` in metres.
constexpr std::array<glm::dvec3, 4> tagCorners(double edge) {
  const double half = edge / 2.0;
  return {glm::dvec3(-half, half, 0.0), glm::dvec3(half, half, 0.0), glm::dvec3(half, -half, 0.0),
          glm::dvec3(-half, -half, 0.0)};
}

/// An expected tag.
struct TagMarker {
  int id = 0;
  double edgeMetres = 0.0;  ///< of the black square
  /// Its pose in the frame of tagCorners(). A tag without it does not locate the world.
  std::optional<glm::dmat4> worldFromTag;
};

}  // namespace pleinair::tracking
