#include "pipeline/tracking/motion/dense_flow.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "pipeline/tracking/image/homography.h"
#include "pipeline/tracking/image/parallel_loop.h"
#include "pipeline/tracking/image/search_patch.h"
#include "pipeline/tracking/motion/static_regions.h"

namespace pleinair::tracking {
namespace {

// Index in LumaPyramid::levels(), where each level is followed by its gradients.
constexpr std::size_t kHalf = 2;
constexpr int kMinSidePx = 96;  // of an image in which flow is estimated
// Predicted errors; docs/measured.md compares them with true ones.
constexpr double kPlacing = 1.0;
constexpr double kForwardBackwardPart = 0.7;
constexpr double kMinErrorPx = 0.03;
constexpr double kMaxErrorPx = 100.0;
/// Error per largest difference to a neighbour: at a motion boundary a patch may have followed
/// either motion.
constexpr double kEdgePart = 0.1;
/// The homography is preferred where its variance exceeds the search's by less than this part of
/// the noise's variance.
constexpr double kToleratedVariance = 0.5;
/// Error of the guesses: the search's, and the homography's in predicted errors.
constexpr double kSearchedPx = 0.3;
constexpr double kAlongErrors = 2.0;
/// A patch can confirm the homography when it can be placed this well. The homography's predicted
/// error is scaled by the second number then.
constexpr double kConfirmingPx = 0.4;
constexpr double kGuessMargin = 1.5;

}  // namespace

DenseFlowEstimator::DenseFlowEstimator() {
  reset();
}

void DenseFlowEstimator::reset() {
  for (Direction& direction : directions_) {
    direction.search = cv::DISOpticalFlow::create(cv::DISOpticalFlow::PRESET_ULTRAFAST);
    direction.search->setFinestScale(1);
    direction.search->setPatchStride(5);
    direction.search->setGradientDescentIterations(8);
    direction.coarse.release();
  }
}

void DenseFlowEstimator::place(const LumaPyramid& current) {
  const cv::Size size = current.picture().size();
  frameSize_ = current.frameSize();
  reduction_ = current.reduction();
  grid_ = {size.width / kStepPx, size.height / kStepPx};
  stepPx_ = glm::dvec2(frameSize_.width, frameSize_.height) / glm::dvec2(grid_.width, grid_.height);
  for (Direction& direction : directions_)
    direction.nodes.resize(static_cast<std::size_t>(grid_.pixels()));
}

glm::dvec2 DenseFlowEstimator::nodePx(std::size_t index) const {
  const int i = static_cast<int>(index);
  return stepPx_ * (glm::dvec2(i % grid_.width, i / grid_.width) + 0.5);
}

void DenseFlowEstimator::estimateDirection(Direction& direction, const LumaPyramid& from,
                                           const LumaPyramid& to, const cv::Mat& fromSmall,
                                           const cv::Mat& toSmall,
                                           const HomographyGuess& homography, double noise) const {
  direction.search->calc(fromSmall, toSmall, direction.coarse);
  const cv::Mat& picture = from.picture();
  for (std::size_t i = 0; i < direction.nodes.size(); ++i) {
    if (staticErrors_[i] < StaticRegions::kNotStatic) continue;
    const glm::dvec2 px = nodePx(i);
    const cv::Point middle = FlowPatch::middleNear(picture, from.ownPx(px));
    const FlowPatch patch(picture, middle);
    const cv::Vec2f coarse =
        direction.coarse.at<cv::Vec2f>(std::min(middle.y / 2, direction.coarse.rows - 1),
                                       std::min(middle.x / 2, direction.coarse.cols - 1));
    PatchMatch best = patch.at(to.picture(), 2.0 * glm::dvec2(coarse[0], coarse[1]));
    bool followsImage = false;
    if (homography.isKnown) {
      const PatchMatch there =
          patch.at(to.picture(), (movedBy(homography.toFromFrom, px) - px) / reduction_);
      const double allowed = best.variance + kToleratedVariance * noise * noise;
      followsImage = there.isInside && (!best.isInside || there.variance < allowed);
      if (followsImage) best = there;
    }
    if (best.isInside && !(followsImage && homography.isHeld)) {
      best =
          patch.refined(to.picture(), best, noise, followsImage ? homography.guessPx : kSearchedPx);
    }
    const glm::dvec2 moved = reduction_ * best.moved;
    double error = kMaxErrorPx;
    if (best.isInside) {
      error = kPlacing * patch.placing(noise) * std::sqrt(best.variance);
      // A patch that confirms the homography is as accurate as the two measurements combined.
      const double guess = kGuessMargin * homography.guessPx;
      if (followsImage && error < kConfirmingPx) {
        error = 1.0 / std::sqrt(1.0 / (error * error) + 1.0 / (guess * guess));
      }
      error = std::sqrt(error * error + kMinErrorPx * kMinErrorPx);
    }
    direction.nodes[i] = {static_cast<float>(moved.x), static_cast<float>(moved.y),
                          static_cast<float>(std::min(error * reduction_.x, kMaxErrorPx)), 0.0F};
  }
}

/// Largest difference of a node's motion to a neighbour's.
double DenseFlowEstimator::edge(const std::vector<glm::vec4>& nodes, std::size_t index) const {
  const int i = static_cast<int>(index);
  const int column = i % grid_.width;
  const int row = i / grid_.width;
  float most = 0.0F;
  const auto compare = [&](int other) {
    const glm::vec2 apart = glm::vec2(nodes[static_cast<std::size_t>(other)] - nodes[index]);
    most = std::max(most, glm::dot(apart, apart));
  };
  if (column > 0) compare(i - 1);
  if (column + 1 < grid_.width) compare(i + 1);
  if (row > 0) compare(i - grid_.width);
  if (row + 1 < grid_.height) compare(i + grid_.width);
  return static_cast<double>(std::sqrt(most));
}

/// Adds the forward-backward disagreement to the nodes' errors.
void DenseFlowEstimator::addDisagreement(const std::vector<glm::vec4>& back,
                                         std::vector<glm::vec4>& nodes) const {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (staticErrors_[i] < StaticRegions::kNotStatic) continue;
    glm::vec4& node = nodes[i];
    const glm::dvec2 there = (nodePx(i) + glm::dvec2(node)) / stepPx_ - 0.5;
    const int x = std::clamp(static_cast<int>(std::floor(there.x)), 0, grid_.width - 2);
    const int y = std::clamp(static_cast<int>(std::floor(there.y)), 0, grid_.height - 2);
    const glm::vec2 part = glm::clamp(glm::vec2(there) - glm::vec2(x, y), 0.0F, 1.0F);
    const glm::vec4* const at = &back[static_cast<std::size_t>(y * grid_.width + x)];
    const glm::vec2 returned = glm::mix(
        glm::mix(glm::vec2(at[0]), glm::vec2(at[1]), part.x),
        glm::mix(glm::vec2(at[grid_.width]), glm::vec2(at[grid_.width + 1]), part.x), part.y);
    const double apart = static_cast<double>(glm::length(glm::vec2(node) + returned));
    const glm::dvec3 errors(node.z, kForwardBackwardPart * apart, kEdgePart * edge(nodes, i));
    const double error = glm::length(errors);
    node.z = static_cast<float>(std::min(error, kMaxErrorPx));
  }
}

/// Writes the flow of the static nodes. Returns whether other nodes remain.
bool DenseFlowEstimator::writeStaticNodes(const StaticRegionDetector* staticRegions) {
  staticErrors_.assign(directions_[0].nodes.size(), StaticRegions::kNotStatic);
  if (staticRegions == nullptr) return true;
  bool isMoving = false;
  for (std::size_t i = 0; i < staticErrors_.size(); ++i) {
    const float error = staticRegions->errorAt(nodePx(i), frameSize_);
    staticErrors_[i] = error;
    isMoving = isMoving || error >= StaticRegions::kNotStatic;
    for (Direction& direction : directions_) direction.nodes[i] = {0.0F, 0.0F, error, 0.0F};
  }
  return isMoving;
}

void DenseFlowEstimator::update(const LumaPyramid& previous, const LumaPyramid& current,
                                const std::optional<ImageHomography>& picture,
                                const StaticRegionDetector* staticRegions, double noise) {
  grid_ = {};
  const cv::Size size = current.picture().size();
  if (std::min(size.width, size.height) < kMinSidePx || current.levels().size() <= kHalf) return;
  place(current);
  if (!writeStaticNodes(staticRegions)) return;
  previous.levels()[kHalf].copyTo(small_[0]);
  current.levels()[kHalf].copyTo(small_[1]);
  HomographyGuess forward;
  if (picture) {
    forward = {.toFromFrom = picture->currentFromPrevious,
               .guessPx = kAlongErrors * picture->errorPx / reduction_.x,
               .isKnown = true,
               .isHeld = picture->currentFromPrevious == glm::dmat3(1.0)};
  }
  HomographyGuess backward = forward;
  backward.toFromFrom = glm::inverse(forward.toFromFrom);
  parallelFor(2, [&](int direction) {
    if (direction == 0) {
      estimateDirection(directions_[0], previous, current, small_[0], small_[1], forward, noise);
    } else {
      estimateDirection(directions_[1], current, previous, small_[1], small_[0], backward, noise);
    }
  });
  // Each direction is compared with the other as it was measured, before either is changed.
  std::vector<glm::vec4>& there = directions_[0].nodes;
  std::vector<glm::vec4>& back = directions_[1].nodes;
  addDisagreement(back, there);
  addDisagreement(there, back);
}

DenseFlow DenseFlowEstimator::flow() const {
  if (grid_.pixels() == 0) return {};
  return {.nodes = grid_,
          .stepPx = glm::vec2(stepPx_),
          .forward = directions_[0].nodes,
          .backward = directions_[1].nodes};
}

}  // namespace pleinair::tracking
