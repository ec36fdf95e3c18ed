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

/// A lens and a board's pose in each view: what is fitted.
struct LensState {
  LensVec lens;
  std::vector<glm::dmat4> cameraFromBoard;
};

tracking::CameraModel cameraOf(const LensVec& lens, hal::FrameSize size);

/// How much the lens's parameters move a projection; those that the model has not, not at all.
/// Pixels by unit of each parameter, rows u and v. `plane`: the ray's x/z and y/z.
cv::Matx<double, 2, kLensParameters> lensJacobian(const LensVec& lens, const glm::dvec2& plane,
                                                  LensModel model);

/// One view's part of the normal equations; J of lens and pose, r the residuals, weights in.
struct ViewEquations {
  LensMatx lens;        ///< JlᵀJl
  LensPoseMatx mixed;   ///< JlᵀJp
  cv::Matx66d pose;     ///< JpᵀJp
  LensVec lensScore;    ///< Jlᵀr
  cv::Vec6d poseScore;  ///< Jpᵀr
};

ViewEquations viewEquations(const tracking::CameraModel& camera, LensModel model,
                            const FitView& view, const glm::dmat4& cameraFromBoard, double huberPx);

/// Sum of squared distances (px²), Huber's beyond `huberPx`; infinite where the state makes no
/// sense.
double lensCost(const LensState& state, std::span<const FitView> views, hal::FrameSize size,
                double huberPx);

}  // namespace pleinair::calibration
