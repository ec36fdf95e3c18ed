#pragma once

#include <array>
#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace pleinair::tracking {

/// A tag's corners in a picture, in the AprilTag library's order; see tagCorners().
using TagCornersPx = std::array<glm::dvec2, 4>;

/// The tag frame, which tracking, scenes and simulated cameras share: the AprilTag library 3.3's
/// own (the object points of its estimate_tag_pose). The origin is the tag's centre; seen as the
/// tag's picture is published (AprilRobotics' apriltag-imgs, apriltag_to_image), x points right, y
/// down, and z into the tag, away from the viewer. So a tag that faces the camera upright has a
/// cameraFromTag without rotation.
///
/// The corners, of the black border's outer edge, begin at the picture's bottom left and go against
/// the clock: bottom left, bottom right, top right, top left. OpenCV's DICT_APRILTAG_36h11 pictures
/// are these rotated by 180°; for those the first corner is the picture's top right.
///
/// `edge` in metres.
constexpr std::array<glm::dvec3, 4> tagCorners(double edge) {
  const double half = edge / 2.0;
  return {glm::dvec3(-half, half, 0.0), glm::dvec3(half, half, 0.0), glm::dvec3(half, -half, 0.0),
          glm::dvec3(-half, -half, 0.0)};
}

/// A tag that is expected.
struct TagMarker {
  int id = 0;
  double edgeMetres = 0.0;  ///< of the black square
  /// Where it is, in the frame of tagCorners(). A tag without one does not tell where the world is.
  std::optional<glm::dmat4> worldFromTag;
};

}  // namespace pleinair::tracking
