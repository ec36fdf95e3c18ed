#pragma once

#include <algorithm>
#include <iterator>

#include <opencv2/core/matx.hpp>

#include "pipeline/tracking/pose/pose_refinement.h"

namespace pleinair::tracking {

/// Conversions between PoseCovariance and a matrix for calculations.
using Matrix6 = cv::Matx<double, 6, 6>;

inline Matrix6 matrixOf(const PoseCovariance& covariance) {
  return Matrix6(covariance.data());
}

inline PoseCovariance arrayOf(const Matrix6& matrix) {
  PoseCovariance out{};
  std::copy(std::begin(matrix.val), std::end(matrix.val), out.begin());
  return out;
}

}  // namespace pleinair::tracking
