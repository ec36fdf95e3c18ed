#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <glm/mat4x4.hpp>

#include "hal/pixel_format.h"
#include "pipeline/tracking/camera/camera_model.h"
#include "pipeline/tracking/pose/pose_refinement.h"

namespace pleinair::calibration {

/// How many of Brown–Conrady's terms a lens gets; the others are 0. Each has those before it.
enum class LensModel { kPinhole, kK1, kK1K2, kK1K2P, kK1K2PK3 };
inline constexpr std::array kLensModels{LensModel::kPinhole, LensModel::kK1, LensModel::kK1K2,
                                        LensModel::kK1K2P, LensModel::kK1K2PK3};
std::string_view toString(LensModel model);  ///< "k1 k2 p1 p2"

/// fx fy cx cy k1 k2 p1 p2 k3, in this order.
inline constexpr std::size_t kLensParameters = 9;
using LensVector = std::array<double, kLensParameters>;
/// Row-major.
using LensMatrix = std::array<double, kLensParameters * kLensParameters>;

LensVector parametersOf(const tracking::CameraModel& camera);

/// How many of them a model leaves free.
std::size_t freeParameters(LensModel model);

/// A board's corners: where they are on it, and in one picture.
using FitView = std::vector<tracking::Correspondence>;

struct LensFit {
  LensModel model = LensModel::kPinhole;
  tracking::CameraModel camera{{}, {}, {1, 1}};
  std::vector<glm::dmat4> cameraFromBoard;  ///< of each view
  double rmsPx = 0.0;                       ///< of the distances of corners to their reprojections
  /// Of the parameters, from the residuals, those of one view taken for related (sandwich
  /// estimator, White 1980, clustered by view): a bent board or a rolling shutter moves a view's
  /// corners together. At least that of independent ones. 0 for parameters that are not free.
  LensMatrix covariance{};

  double sigma(std::size_t parameter) const;
};

/// Zhang's calibration ("A Flexible New Technique for Camera Calibration", PAMI 2000): the camera
/// and the boards' poses that together have the least squared reprojection error. Beyond `huberPx`
/// an error counts linearly. Levenberg–Marquardt on the parameters of the lens, each pose
/// eliminated (Schur complement), so that a fit of 40 views takes milliseconds. Without a start,
/// several focal lengths are tried. Nothing where the views do not hold together at all.
/// Precondition: at least 4 points a view, not in a line.
std::optional<LensFit> fitLens(std::span<const FitView> views, hal::FrameSize size, LensModel model,
                               const LensFit* start = nullptr,
                               double huberPx = std::numeric_limits<double>::infinity());

/// The pose of one board under a camera, from nothing; nothing where there is none.
std::optional<glm::dmat4> boardPose(const tracking::CameraModel& camera, const FitView& view);

}  // namespace pleinair::calibration
