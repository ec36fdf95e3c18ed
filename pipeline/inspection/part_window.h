#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/image.h"
#include "pipeline/inspection/structure_match.h"
#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::inspection {

inline constexpr int kWindowPx = 160;

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

/// A triangle of a machine's surface, in its frame, and the number of its part.
struct PartTriangle {
  std::array<glm::dvec3, 3> corners;
  std::size_t part = 0;
};

/// How far the nearest of the triangles stands out of the window where a camera at
/// `cameraFromModel` sees it, whatever else is before it: in halves of a side, by rows, kWindowPx
/// squared.
std::vector<ReliefPixel> windowRelief(const PartWindow& window, const glm::dmat4& cameraFromModel,
                                      std::span<const PartTriangle> triangles);

/// How far (px of the window) a point that stands out of the window by half a side, towards the
/// first camera, moves from its place in the first picture to that in the second one.
glm::dvec2 reliefShiftPx(const PartWindow& window, const glm::dmat4& cameraFromModel,
                         const glm::dmat4& otherFromModel);

/// A window's picture, or why there is none that could be compared.
struct WindowPicture {
  hal::Image luma;           ///< grey, kWindowPx squared
  double shareInside = 0.0;  ///< of the window, in the picture
  double halfPx = 0.0;       ///< half a side of the window in the picture, from its centre
};

/// Resamples the picture's luma on the window. Points behind the camera or beside the picture are
/// black.
WindowPicture windowPicture(const PartWindow& window, const PosedPicture& picture);

/// The angle between the directions in which two cameras see a point of the machine.
double viewAngleRad(const glm::dvec3& point, const glm::dmat4& cameraFromModel,
                    const glm::dmat4& otherFromModel);

}  // namespace pleinair::inspection
