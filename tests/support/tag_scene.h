#pragma once

#include <cstdint>
#include <span>

#include <glm/mat4x4.hpp>

#include "hal/image.h"
#include "pipeline/tracking/camera/camera_model.h"
#include "pipeline/tracking/pose/tag.h"

namespace pleinair::support {

/// A tag36h11 in the world, on white paper two cells wider than the black square.
struct SceneTag {
  int id = 0;
  double edgeMetres = 0.1;
  glm::dmat4 worldFromTag{1.0};
};

struct TagPictureOptions {
  int samplesPerSide = 5;  ///< per pixel: its area is integrated over samplesPerSide² points
  double black = 30.0;
  double white = 220.0;
  double background = 120.0;
  double noiseSigma = 0.0;  ///< grey levels
  std::uint32_t noiseSeed = 1;
};

/// A pose from a rotation vector (rad; its direction is the axis) and a translation (metres).
glm::dmat4 poseOf(const glm::dvec3& rotationVector, const glm::dvec3& translation);

/// Renders a grey image of tags through a lens, from the library's own bitmaps (apriltag_to_image).
/// Each tag must lie in front of the camera and face it; later ones cover earlier ones.
hal::Image renderTags(const tracking::CameraModel& camera, const glm::dmat4& cameraFromWorld,
                      std::span<const SceneTag> tags, const TagPictureOptions& options = {});

/// The image positions of a tag's corners, through the lens.
tracking::TagCornersPx trueCorners(const tracking::CameraModel& camera,
                                   const glm::dmat4& cameraFromTag, double edgeMetres);

/// The same image in another format with neutral colour; also mosaics and subsampled formats.
hal::Image neutralPicture(const hal::Image& grey, hal::PixelFormat format);

}  // namespace pleinair::support
