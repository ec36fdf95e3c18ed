#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <opencv2/core/matx.hpp>

#include "pipeline/calibration/lens_fit.h"

namespace pleinair::calibration {

using LensMatx = cv::Matx<double, kLensParameters, kLensParameters>;
using LensVec = cv::Vec<double, kLensParameters>;
using LensPoseMatx = cv::Matx<double, kLensParameters, 6>;

/// The fitted parameters: a lens, and a pose of the board per view.
struct LensState {
  LensVec lens;
  std::vector<glm::dmat4> cameraFromBoard;
};

tracking::CameraModel cameraOf(const LensVec& lens, hal::FrameSize size);

/// Derivative of a projection by the lens's parameters: pixels per unit of each parameter, rows u
/// and v; zero for parameters that the model lacks. `plane`: the ray's x/z and y/z.
cv::Matx<double, 2, kLensParameters> lensJacobian(const LensVec& lens, const glm::dvec2& plane,
                                                  LensModel model);

/// The part of one view in the normal equations; J by lens and pose, r the residuals, weights
/// included.
struct ViewEquations {
  LensMatx lens;        ///< JlᵀJl
  LensPoseMatx mixed;   ///< JlᵀJp
  cv::Matx66d pose;     ///< JpᵀJp
  LensVec lensScore;    ///< Jlᵀr
  cv::Vec6d poseScore;  ///< Jpᵀr
};

ViewEquations viewEquations(const tracking::CameraModel& camera, LensModel model,
                            const FitView& view, const glm::dmat4& cameraFromBoard, double huberPx);

/// Sum of squared distances (px²), Huber's beyond `huberPx`; infinite where the state is invalid.
double lensCost(const LensState& state, std::span<const FitView> views, hal::FrameSize size,
                double huberPx);

}  // namespace pleinair::calibration
