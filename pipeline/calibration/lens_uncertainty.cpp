#include "pipeline/calibration/lens_uncertainty.h"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <opencv2/core.hpp>

#include "pipeline/calibration/lens_equations.h"

namespace pleinair::calibration {
namespace {

constexpr int kPlacesAcross = 9;
constexpr int kPlacesDown = 7;

using ByLens = cv::Matx<double, 2, kLensParameters>;
using ByTurn = cv::Matx<double, 2, 3>;

ByTurn turnJacobian(const tracking::CameraModel& camera, const glm::dvec3& ray) {
  const auto byPoint = camera.projectWithJacobian(ray).pxByCameraPoint;
  ByTurn result;
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 unit(0.0);
    unit[axis] = 1.0;
    const glm::dvec2 column = byPoint * glm::cross(unit, ray);
    result(0, axis) = column.x;
    result(1, axis) = column.y;
  }
  return result;
}

std::vector<glm::dvec2> places(hal::FrameSize size) {
  std::vector<glm::dvec2> all;
  for (int row = 0; row < kPlacesDown; ++row) {
    for (int column = 0; column < kPlacesAcross; ++column) {
      all.emplace_back(size.width * column / (kPlacesAcross - 1.0),
                       size.height * row / (kPlacesDown - 1.0));
    }
  }
  return all;
}

}  // namespace

std::vector<PlaceUncertainty> placeUncertainties(const LensFit& fit) {
  const LensVector parameters = parametersOf(fit.camera);
  const LensVec lens(parameters.data());
  std::vector<PlaceUncertainty> certainties;
  std::vector<ByLens> byLens;
  std::vector<ByTurn> byTurn;
  cv::Matx33d turns = cv::Matx33d::zeros();
  cv::Matx<double, 3, kLensParameters> turnByLens;
  for (const glm::dvec2& px : places(fit.camera.imageSize())) {
    certainties.push_back({px, std::numeric_limits<double>::infinity()});
    const auto ray = fit.camera.unproject(px);
    byLens.push_back(ray ? lensJacobian(lens, glm::dvec2(*ray), fit.model) : ByLens::zeros());
    byTurn.push_back(ray ? turnJacobian(fit.camera, *ray) : ByTurn::zeros());
    turns += byTurn.back().t() * byTurn.back();
    turnByLens += byTurn.back().t() * byLens.back();
  }
  turnByLens = turns.inv(cv::DECOMP_SVD) * turnByLens;
  const cv::Matx<double, kLensParameters, kLensParameters> covariance(fit.covariance.data());
  for (std::size_t i = 0; i < certainties.size(); ++i) {
    if (byLens[i] == ByLens::zeros()) continue;
    const ByLens left = byLens[i] - byTurn[i] * turnByLens;
    const double variance = cv::trace(left * covariance * left.t());
    if (std::isfinite(variance)) certainties[i].sigmaPx = std::sqrt(std::max(0.0, variance));
  }
  return certainties;
}

bool foldsInImage(const tracking::CameraModel& camera) {
  constexpr double kBeyond = 1.02;
  constexpr int kSteps = 200;
  const hal::FrameSize size = camera.imageSize();
  const glm::dvec2 centre(camera.intrinsics().cx, camera.intrinsics().cy);
  for (const glm::dvec2& px : places(size)) {
    const bool isBorder = px.x == 0.0 || px.y == 0.0 || px.x == size.width || px.y == size.height;
    if (!isBorder) continue;
    const auto ray = camera.unproject(centre + kBeyond * (px - centre));
    if (!ray) return true;
    double before = 0.0;
    for (int step = 1; step <= kSteps; ++step) {
      const glm::dvec2 plane = glm::dvec2(*ray) * (static_cast<double>(step) / kSteps);
      const double distance = glm::distance(camera.project({plane, 1.0}), centre);
      if (!(distance > before)) return true;
      before = distance;
    }
  }
  return false;
}

}  // namespace pleinair::calibration
