#include "firmware_app/procedure/step_view.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "firmware_app/procedure/step_close_up.h"

namespace pleinair::app {

std::span<const ViewAngles> candidateViews() {
  static constexpr std::array<ViewAngles, 10> kViews{{{30.0, 35.0},
                                                      {-30.0, 35.0},
                                                      {0.0, 25.0},
                                                      {30.0, 65.0},
                                                      {-60.0, 20.0},
                                                      {60.0, 20.0},
                                                      {150.0, 30.0},
                                                      {-150.0, 30.0},
                                                      {150.0, 60.0},
                                                      {180.0, 15.0}}};
  return kViews;
}

scene::Model withParts(const scene::Model& model, std::span<const std::size_t> parts) {
  scene::Model chosen = model;
  chosen.parts.clear();
  for (const std::size_t part : parts) {
    chosen.parts.push_back(model.parts[part]);
    chosen.parts.back().radiansPerSecond = 0.0;
  }
  scene::numberParts(chosen);
  return chosen;
}

tracking::CameraModel stepCamera(hal::FrameSize size) {
  const double f = 0.5 * size.height / std::tan(0.5 * glm::radians(kStepViewDeg));
  return {{.fx = f, .fy = f, .cx = 0.5 * size.width, .cy = 0.5 * size.height}, {}, size};
}

namespace {

/// `centre` in the upright frame; `radius`: what is in view around it, metres.
glm::dmat4 cameraAt(const ViewAngles& view, const glm::dvec3& centre, double radius,
                    const glm::dmat3& uprightFromModel) {
  const double distance = radius / std::sin(0.5 * glm::radians(kStepViewDeg));
  const double a = glm::radians(view.azimuthDeg);
  const double e = glm::radians(view.elevationDeg);
  const glm::dvec3 toViewer(std::cos(e) * std::sin(a), -std::cos(e) * std::cos(a), std::sin(e));
  const glm::dvec3 ahead = -toViewer;
  const glm::dvec3 right = glm::normalize(glm::cross(ahead, glm::dvec3(0.0, 0.0, 1.0)));
  const glm::dvec3 down = glm::cross(ahead, right);
  const glm::dvec3 eye = centre + distance * toViewer;
  glm::dmat4 matrix(1.0);
  const std::array<glm::dvec3, 3> rows{right, down, ahead};
  for (int row = 0; row < 3; ++row) {
    const glm::dvec3& axis = rows.at(static_cast<std::size_t>(row));
    for (int column = 0; column < 3; ++column) matrix[column][row] = axis[column];
    matrix[3][row] = -glm::dot(axis, eye);
  }
  return matrix * glm::dmat4(uprightFromModel);
}

}  // namespace

glm::dmat4 cameraFromModel(const ViewAngles& view, const scene::BoundingSphere& focus,
                           const scene::BoundingSphere& whole, const glm::dmat3& uprightFromModel) {
  constexpr double kFocusShare = 1.8;  // radii of the focus in half of the picture
  constexpr double kWholeShare = 0.55;
  const double radius =
      std::max({kFocusShare * focus.radiusMetres, kWholeShare * whole.radiusMetres, 1e-4});
  const double inView = std::min(radius, 1.05 * std::max(whole.radiusMetres, focus.radiusMetres));
  // A little towards the middle of the machine, so that the surroundings show where the part is.
  const glm::dvec3 centre =
      uprightFromModel * glm::mix(glm::dvec3(focus.centre), glm::dvec3(whole.centre), 0.2);
  return cameraAt(view, centre, inView, uprightFromModel);
}

glm::dmat4 closeUpFromModel(const ViewAngles& view, const scene::BoundingSphere& part,
                            const glm::dmat3& uprightFromModel) {
  constexpr double kPartShare = 2.0;  // radii of the part in half of the circle
  const double radius = std::max(kPartShare * part.radiusMetres / kCloseUpShare, 1e-4);
  return cameraAt(view, uprightFromModel * part.centre, radius, uprightFromModel);
}

}  // namespace pleinair::app
