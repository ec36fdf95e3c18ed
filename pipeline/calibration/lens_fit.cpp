#include "pipeline/calibration/lens_fit.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <opencv2/calib3d.hpp>

#include "pipeline/calibration/lens_equations.h"

namespace pleinair::calibration {
namespace {

constexpr int kMaxSteps = 100;
constexpr double kConvergedShare = 1e-9;  // of the cost, a step
constexpr double kMinNoisePx = 0.02;
constexpr double kUnknown = std::numeric_limits<double>::infinity();

/// Initial focal lengths, relative to the image's longer side: 90°, 64°, 45°, 28°, 14°.
constexpr std::array kStartFocals{0.5, 0.8, 1.2, 2.0, 4.0};

bool isFree(std::size_t parameter, LensModel model) {
  constexpr std::array kFirst{LensModel::kPinhole, LensModel::kPinhole, LensModel::kPinhole,
                              LensModel::kPinhole, LensModel::kK1,      LensModel::kK1K2,
                              LensModel::kK1K2P,   LensModel::kK1K2P,   LensModel::kK1K2PK3};
  return model >= kFirst.at(parameter);
}

glm::dmat4 moved(const glm::dmat4& pose, const cv::Vec6d& by) {
  const glm::dvec3 turn(by[0], by[1], by[2]);
  const double angle = glm::length(turn);
  glm::dmat4 result = pose;
  if (angle > 0.0) {
    const glm::dmat3 rotation(glm::rotate(glm::dmat4(1.0), angle, turn / angle));
    const glm::dmat3 turned = rotation * glm::dmat3(pose);
    for (int column = 0; column < 3; ++column) result[column] = {turned[column], 0.0};
  }
  result[3] += glm::dvec4(by[3], by[4], by[5], 0.0);
  return result;
}

/// A copy whose diagonal is increased by a share (Marquardt).
template <class Matrix>
Matrix damped(Matrix matrix, double by) {
  for (int i = 0; i < Matrix::rows; ++i) matrix(i, i) *= 1.0 + by;
  return matrix;
}

/// The equations of the lens after the poses were eliminated.
struct ReducedEquations {
  LensMatx lens;
  LensVec score;
  std::vector<cv::Matx66d> poseInverse;
};

ReducedEquations reduced(const std::vector<ViewEquations>& views, LensModel model, double damping) {
  ReducedEquations sum{};
  for (const ViewEquations& view : views) sum.lens += view.lens;
  sum.lens = damped(sum.lens, damping);
  for (const ViewEquations& view : views) {
    sum.poseInverse.push_back(damped(view.pose, damping).inv(cv::DECOMP_CHOLESKY));
    const LensPoseMatx gain = view.mixed * sum.poseInverse.back();
    sum.lens -= gain * view.mixed.t();
    sum.score += view.lensScore - gain * view.poseScore;
  }
  for (std::size_t i = 0; i < kLensParameters; ++i) {
    const int at = static_cast<int>(i);
    if (!isFree(i, model)) sum.lens(at, at) = 1.0;
  }
  return sum;
}

/// Inverse of a positive definite matrix whose units differ by many powers of ten; zeros if the
/// matrix is not positive definite.
LensMatx inverseOf(const LensMatx& matrix) {
  LensMatx scaled;
  LensVec scale;
  for (int i = 0; i < LensMatx::rows; ++i) {
    if (!(matrix(i, i) > 0.0)) return LensMatx::zeros();
    scale[i] = 1.0 / std::sqrt(matrix(i, i));
  }
  for (int i = 0; i < LensMatx::rows; ++i) {
    for (int j = 0; j < LensMatx::cols; ++j) scaled(i, j) = matrix(i, j) * scale[i] * scale[j];
  }
  bool isDefinite = false;
  LensMatx inverse = scaled.inv(cv::DECOMP_CHOLESKY, &isDefinite);
  if (!isDefinite) return LensMatx::zeros();
  for (int i = 0; i < LensMatx::rows; ++i) {
    for (int j = 0; j < LensMatx::cols; ++j) inverse(i, j) *= scale[i] * scale[j];
  }
  return inverse;
}

/// One fit in flight.
class Fitting {
 public:
  Fitting(std::span<const FitView> views, hal::FrameSize size, LensModel model, double huberPx,
          LensState start)
      : views_(views), size_(size), model_(model), huberPx_(huberPx), state_(std::move(start)) {}

  /// Returns false where the start is invalid.
  bool run() {
    cost_ = lensCost(state_, views_, size_, huberPx_);
    if (!std::isfinite(cost_)) return false;
    double damping = 1e-3;
    for (int step = 0; step < kMaxSteps; ++step) {
      const std::vector<ViewEquations> equations = linearised();
      const double before = cost_;
      constexpr double kMaxDamping = 1e8;
      while (!take(equations, damping)) {
        damping *= 10.0;
        if (damping > kMaxDamping) return true;  // no step lowers the cost
      }
      damping = std::max(damping / 10.0, 1e-12);
      if (before - cost_ <= kConvergedShare * before) return true;
    }
    return true;
  }

  LensFit result() const {
    std::size_t points = 0;
    for (const FitView& view : views_) points += view.size();
    const double squares = lensCost(state_, views_, size_, huberPx_);
    LensFit fit{.model = model_,
                .camera = cameraOf(state_.lens, size_),
                .cameraFromBoard = state_.cameraFromBoard,
                .rmsPx = std::sqrt(squares / static_cast<double>(points))};
    fit.covariance = covariance(squares, points);
    return fit;
  }

 private:
  std::vector<ViewEquations> linearised() const {
    const tracking::CameraModel camera = cameraOf(state_.lens, size_);
    std::vector<ViewEquations> equations;
    equations.reserve(views_.size());
    for (std::size_t v = 0; v < views_.size(); ++v) {
      equations.push_back(
          viewEquations(camera, model_, views_[v], state_.cameraFromBoard[v], huberPx_));
    }
    return equations;
  }

  /// Takes a step if it lowers the cost.
  bool take(const std::vector<ViewEquations>& equations, double damping) {
    const ReducedEquations system = reduced(equations, model_, damping);
    const LensVec step = inverseOf(system.lens) * system.score;
    LensState next{.lens = state_.lens + step};
    for (std::size_t v = 0; v < views_.size(); ++v) {
      const cv::Vec6d own =
          system.poseInverse[v] * (equations[v].poseScore - equations[v].mixed.t() * step);
      next.cameraFromBoard.push_back(moved(state_.cameraFromBoard[v], own));
    }
    const double cost = lensCost(next, views_, size_, huberPx_);
    if (!(cost < cost_)) return false;
    state_ = std::move(next);
    cost_ = cost;
    return true;
  }

  LensMatrix covariance(double squares, std::size_t points) const {
    const std::vector<ViewEquations> equations = linearised();
    const ReducedEquations system = reduced(equations, model_, 0.0);
    const LensMatx inverse = inverseOf(system.lens);
    const double unknowns = static_cast<double>(freeParameters(model_) + 6 * views_.size());
    const double spare = std::max(1.0, 2.0 * static_cast<double>(points) - unknowns);
    const LensMatx independent = inverse * std::max(squares / spare, kMinNoisePx * kMinNoisePx);
    LensMatrix result{};
    if (inverse(0, 0) == 0.0) {  // the views do not determine all parameters
      for (std::size_t i = 0; i < kLensParameters; ++i) {
        if (isFree(i, model_)) result[i * (kLensParameters + 1)] = kUnknown;
      }
      return result;
    }
    LensMatx scores{};
    for (std::size_t v = 0; v < views_.size(); ++v) {
      const LensVec score = equations[v].lensScore -
                            equations[v].mixed * system.poseInverse[v] * equations[v].poseScore;
      scores += score * score.t();
    }
    const LensMatx related = inverse * scores * inverse;
    for (std::size_t i = 0; i < kLensParameters; ++i) {
      for (std::size_t j = 0; j < kLensParameters; ++j) {
        if (!isFree(i, model_) || !isFree(j, model_)) continue;
        const int row = static_cast<int>(i);
        const int column = static_cast<int>(j);
        const auto growth = [&](int at) {
          return std::sqrt(std::max(1.0, related(at, at) / independent(at, at)));
        };
        result[i * kLensParameters + j] = independent(row, column) * growth(row) * growth(column);
      }
    }
    return result;
  }

  std::span<const FitView> views_;
  hal::FrameSize size_;
  LensModel model_;
  double huberPx_;
  LensState state_;
  double cost_ = 0.0;
};

std::optional<LensState> startWith(const LensVec& lens, std::span<const FitView> views,
                                   hal::FrameSize size) {
  const tracking::CameraModel camera = cameraOf(lens, size);
  LensState state{.lens = lens};
  for (const FitView& view : views) {
    const std::optional<glm::dmat4> pose = boardPose(camera, view);
    if (!pose) return std::nullopt;
    state.cameraFromBoard.push_back(*pose);
  }
  return state;
}

/// The best of several focal lengths, each fitted for a few steps.
std::optional<LensState> startState(std::span<const FitView> views, hal::FrameSize size,
                                    double huberPx) {
  std::optional<LensState> best;
  double leastCost = std::numeric_limits<double>::infinity();
  for (const double focal : kStartFocals) {
    const double f = focal * std::max(size.width, size.height);
    const LensVec lens(f, f, size.width / 2.0, size.height / 2.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    std::optional<LensState> state = startWith(lens, views, size);
    if (!state) continue;
    const double cost = lensCost(*state, views, size, huberPx);
    if (cost < leastCost) {
      leastCost = cost;
      best = std::move(state);
    }
  }
  return best;
}

}  // namespace

std::string_view toString(LensModel model) {
  constexpr std::array<std::string_view, 5> kNames{"no distortion", "k1", "k1 k2", "k1 k2 p1 p2",
                                                   "k1 k2 p1 p2 k3"};
  return kNames.at(static_cast<std::size_t>(model));
}

LensVector parametersOf(const tracking::CameraModel& camera) {
  const tracking::Intrinsics& i = camera.intrinsics();
  const tracking::Distortion& d = camera.distortion();
  return {i.fx, i.fy, i.cx, i.cy, d.k1, d.k2, d.p1, d.p2, d.k3};
}

std::size_t freeParameters(LensModel model) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < kLensParameters; ++i) count += isFree(i, model) ? 1 : 0;
  return count;
}

double LensFit::sigma(std::size_t parameter) const {
  return std::sqrt(covariance.at(parameter * (kLensParameters + 1)));
}

std::optional<glm::dmat4> boardPose(const tracking::CameraModel& camera, const FitView& view) {
  assert(view.size() >= 4);
  std::vector<cv::Point3d> onBoard;
  std::vector<cv::Point2d> onPlane;
  for (const tracking::Correspondence& point : view) {
    const std::optional<glm::dvec3> ray = camera.unproject(point.px);
    if (!ray) return std::nullopt;
    onBoard.emplace_back(point.target.x, point.target.y, point.target.z);
    onPlane.emplace_back(ray->x, ray->y);
  }
  cv::Vec3d turn;
  cv::Vec3d shift;
  if (!cv::solvePnP(onBoard, onPlane, cv::Matx33d::eye(), cv::noArray(), turn, shift, false,
                    cv::SOLVEPNP_IPPE)) {
    return std::nullopt;
  }
  glm::dmat4 pose = moved(glm::dmat4(1.0), {turn[0], turn[1], turn[2], 0.0, 0.0, 0.0});
  pose[3] = {shift[0], shift[1], shift[2], 1.0};
  if (!(shift[2] > 0.0)) return std::nullopt;
  return pose;
}

std::optional<LensFit> fitLens(std::span<const FitView> views, hal::FrameSize size, LensModel model,
                               const LensFit* start, double huberPx) {
  if (views.empty()) return std::nullopt;
  std::optional<LensState> state;
  if (start != nullptr && start->cameraFromBoard.size() == views.size()) {
    state = LensState{.lens = LensVec(parametersOf(start->camera).data()),
                      .cameraFromBoard = start->cameraFromBoard};
    for (std::size_t i = 0; i < kLensParameters; ++i) {
      if (!isFree(i, model)) state->lens[static_cast<int>(i)] = 0.0;
    }
  } else {
    state = startState(views, size, huberPx);
  }
  if (!state) return std::nullopt;
  Fitting fitting(views, size, model, huberPx, std::move(*state));
  if (!fitting.run()) return std::nullopt;
  return fitting.result();
}

}  // namespace pleinair::calibration
