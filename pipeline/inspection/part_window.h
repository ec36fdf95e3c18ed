#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "hal/image.h"
#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::inspection {

/// A picture of the machine, and where the machine is in it.
struct PosedPicture {
  hal::ImageView image;
  tracking::CameraModel camera;  ///< of the image's size
  glm::dmat4 cameraFromModel{1.0};
};

/// A square in the machine's frame that faces the template's camera, about a part: what is compared
/// is resampled on it, so that pictures from nearby places lie on one another, lens and all.
struct PartWindow {
  glm::dvec3 centre{0.0};
  glm::dvec3 right{1.0, 0.0, 0.0};  ///< unit vectors in the machine's frame
  glm::dvec3 down{0.0, 1.0, 0.0};
  double halfMetres = 0.0;
};

/// The window about a sphere, as a camera at `cameraFromModel` sees it upright.
PartWindow windowAbout(const glm::dvec3& centre, double radiusMetres,
                       const glm::dmat4& cameraFromModel);

/// A window's picture, or why there is none that could be compared.
struct WindowPicture {
  hal::Image luma;           ///< grey, kWindowPx squared
  double shareInside = 0.0;  ///< of the window, in the picture
  double halfPx = 0.0;       ///< half a side of the window in the picture, from its centre
};
inline constexpr int kWindowPx = 160;

/// Resamples the picture's luma on the window. Points behind the camera or beside the picture are
/// black.
WindowPicture windowPicture(const PartWindow& window, const PosedPicture& picture);

/// The angle between the directions in which two cameras see a point of the machine.
double viewAngleRad(const glm::dvec3& point, const glm::dmat4& cameraFromModel,
                    const glm::dmat4& otherFromModel);

}  // namespace pleinair::inspection
