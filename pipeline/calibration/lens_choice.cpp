#include "pipeline/calibration/lens_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "hal/median.h"

namespace pleinair::calibration {
namespace {

constexpr std::size_t kFolds = 5;
constexpr double kFirstHuberPx = 2.0;
constexpr double kHuberSigmas = 2.0;
constexpr double kPointSigmas = 6.0;
constexpr double kViewShare = 3.0;  // relative to the median view's error
constexpr double kMinSigmaPx = 0.03;
constexpr double kIndifference = 1.02;
constexpr double kUnknown = std::numeric_limits<double>::infinity();

double distancePx(const LensFit& fit, std::size_t view, const tracking::Correspondence& point) {
  const glm::dvec3 seen(fit.cameraFromBoard[view] * glm::dvec4(point.target, 1.0));
  return glm::distance(fit.camera.project(seen), point.px);
}

/// Standard deviation of the residuals along one axis, from the median distance (Rayleigh
/// distribution).
double robustSigma(const LensFit& fit, std::span<const FitView> views) {
  std::vector<double> distances;
  for (std::size_t v = 0; v < views.size(); ++v) {
    for (const auto& point : views[v]) distances.push_back(distancePx(fit, v, point));
  }
  return std::max(kMinSigmaPx, hal::medianOf(distances) / 1.1774);
}

double viewError(const LensFit& fit, std::size_t view, const FitView& points) {
  std::vector<double> distances;
  for (const auto& point : points) distances.push_back(distancePx(fit, view, point));
  return hal::medianOf(distances);
}

/// A fit to all views that gives little weight to contradicting ones.
std::optional<LensFit> robustFit(std::span<const FitView> views, hal::FrameSize size) {
  std::optional<LensFit> fit = fitLens(views, size, LensModel::kK1, nullptr, kFirstHuberPx);
  if (!fit) return std::nullopt;
  fit = fitLens(views, size, LensModel::kK1K2P, &*fit, kFirstHuberPx);
  if (!fit) return std::nullopt;
  return fitLens(views, size, LensModel::kK1K2P, &*fit, kHuberSigmas * robustSigma(*fit, views));
}

/// Puts the views and points that agree into `choice`.
void reject(std::span<const FitView> views, const LensFit& fit, LensChoice& choice) {
  std::vector<double> errors;
  for (std::size_t v = 0; v < views.size(); ++v) errors.push_back(viewError(fit, v, views[v]));
  const double sigma = robustSigma(fit, views);
  const double limit = kViewShare * std::max(hal::medianOf(std::vector(errors)), kMinSigmaPx);
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (errors[v] > limit) continue;
    FitView kept;
    for (const auto& point : views[v]) {
      if (distancePx(fit, v, point) <= kPointSigmas * sigma) kept.push_back(point);
    }
    if (kept.size() * 2 < views[v].size() || kept.size() < 4) continue;
    choice.rejectedPoints += views[v].size() - kept.size();
    choice.used.push_back(std::move(kept));
    choice.usedViews.push_back(v);
  }
}

/// RMS distance in views that were not fitted: a cross-validation in five parts.
double heldOutRms(const std::vector<FitView>& views, hal::FrameSize size, const LensFit& whole) {
  double squares = 0.0;
  std::size_t points = 0;
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    std::vector<FitView> rest;
    LensFit start = whole;
    start.cameraFromBoard.clear();
    for (std::size_t v = 0; v < views.size(); ++v) {
      if (v % kFolds == fold) continue;
      rest.push_back(views[v]);
      start.cameraFromBoard.push_back(whole.cameraFromBoard[v]);
    }
    const std::optional<LensFit> fit = fitLens(rest, size, whole.model, &start);
    if (!fit) return kUnknown;
    for (std::size_t v = fold; v < views.size(); v += kFolds) {
      const auto pose = tracking::refinePose(fit->camera, views[v], whole.cameraFromBoard[v]);
      if (!pose) return kUnknown;
      squares += pose->rmsPx * pose->rmsPx * static_cast<double>(views[v].size());
      points += views[v].size();
    }
  }
  return std::sqrt(squares / static_cast<double>(points));
}

struct Trial {
  LensFit fit;
  double heldOutRmsPx = kUnknown;
};

}  // namespace

std::optional<LensChoice> chooseLens(std::span<const FitView> views, hal::FrameSize size) {
  if (views.size() < kMinFittedViews) return std::nullopt;
  const std::optional<LensFit> robust = robustFit(views, size);
  if (!robust) return std::nullopt;
  LensChoice choice;
  reject(views, *robust, choice);
  if (choice.used.size() < kMinFittedViews) return std::nullopt;

  LensFit start = *robust;
  start.cameraFromBoard.clear();
  for (const std::size_t v : choice.usedViews) {
    start.cameraFromBoard.push_back(robust->cameraFromBoard[v]);
  }
  std::vector<Trial> trials;
  double lowestRms = kUnknown;
  for (const LensModel model : kLensModels) {
    std::optional<LensFit> fit = fitLens(choice.used, size, model, &start);
    if (!fit) continue;
    const double heldOut = heldOutRms(choice.used, size, *fit);
    lowestRms = std::min(lowestRms, heldOut);
    trials.push_back({std::move(*fit), heldOut});
  }
  const auto chosen = std::ranges::find_if(trials, [&](const Trial& trial) {
    return trial.heldOutRmsPx * trial.heldOutRmsPx <= kIndifference * lowestRms * lowestRms;
  });
  if (chosen == trials.end()) return std::nullopt;
  choice.fit = std::move(chosen->fit);
  choice.heldOutRmsPx = chosen->heldOutRmsPx;
  return choice;
}

}  // namespace pleinair::calibration
