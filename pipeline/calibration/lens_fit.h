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

/// The Brown–Conrady terms of a lens model; the others are 0. Each model has the terms of the
/// previous one.
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

/// Number of parameters that a model leaves free.
std::size_t freeParameters(LensModel model);

/// Corners of a board: positions on the board and in one image.
using FitView = std::vector<tracking::Correspondence>;

struct LensFit {
  LensModel model = LensModel::kPinhole;
  tracking::CameraModel camera{{}, {}, {1, 1}};
  std::vector<glm::dmat4> cameraFromBoard;  ///< per view
  double rmsPx = 0.0;                       ///< reprojection error of the corners
  /// Covariance of the parameters, from the residuals. Residuals of one view are taken as
  /// correlated (sandwich estimator, White 1980, clustered by view): a bent board or a rolling
  /// shutter moves a view's corners together. It is at least that of independent residuals, and 0
  /// for parameters that are not free.
  LensMatrix covariance{};

  double sigma(std::size_t parameter) const;
};

/// Zhang's calibration ("A Flexible New Technique for Camera Calibration", PAMI 2000): finds the
/// camera and the boards' poses with the least squared reprojection error. Beyond `huberPx` an
/// error counts linearly. Levenberg–Marquardt on the parameters of the lens, each pose eliminated
/// (Schur complement), so that a fit of 40 views takes milliseconds. Without a start, several focal
/// lengths are tried. Returns nothing where the views contradict each other. Precondition: at least
/// 4 points per view, not collinear.
std::optional<LensFit> fitLens(std::span<const FitView> views, hal::FrameSize size, LensModel model,
                               const LensFit* start = nullptr,
                               double huberPx = std::numeric_limits<double>::infinity());

/// The pose of one board under a camera, without a start; nothing where there is none.
std::optional<glm::dmat4> boardPose(const tracking::CameraModel& camera, const FitView& view);

}  // namespace pleinair::calibration
