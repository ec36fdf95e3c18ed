#include "pipeline/tracking/motion/canvas_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "pipeline/tracking/image/homography.h"

namespace pleinair::tracking {
namespace {

constexpr int kLongSidePx = 256;  // longer side of the reduced image in which points are followed
constexpr int kCandidates = 400;
/// The best point of each grid cell is used, so that one high-contrast object does not dominate the
/// image.
constexpr int kColumns = 8;
constexpr int kRows = 6;
constexpr int kPerField = 2;
constexpr int kMinPoints = 10;
constexpr double kQuality = 0.002;  // relative to the best corner's strength
constexpr double kSpacingPx = 6.0;
constexpr int kLevels = 3;
constexpr double kOutlierPx = 1.0;
constexpr double kMaxError = 24.0;  // mean difference in a point's window, grey levels
constexpr double kStillPx = 0.33;   // smaller motion counts as rest; px of the frame
/// A new key frame is taken when an image corner has moved by this part of the image's side, or
/// when half of the points are lost.
constexpr double kKeyShift = 0.15;
// Zoom from the key frame; more, or less than the inverse, is rejected as a wrong fit.
constexpr double kMaxZoom = 2.0;
const cv::Size kWindow{15, 15};

double distance(cv::Point2f a, cv::Point2f b) {
  return std::hypot(static_cast<double>(a.x - b.x), static_cast<double>(a.y - b.y));
}

/// Largest distance between the positions to which the two move a corner of the frame.
double apartPx(const PlaneSimilarity& a, const PlaneSimilarity& b, hal::FrameSize size) {
  double most = 0.0;
  for (const double x : {0.0, static_cast<double>(size.width)}) {
    for (const double y : {0.0, static_cast<double>(size.height)}) {
      most = std::max(most, glm::distance(a({x, y}), b({x, y})));
    }
  }
  return most;
}

/// The turn, zoom and shift nearest to a homography over the whole image (Umeyama, 1991).
PlaneSimilarity nearestTo(const glm::dmat3& homography, hal::FrameSize size) {
  glm::dvec2 from(0.0);
  glm::dvec2 to(0.0);
  double count = 0.0;
  forGridCentres(size, [&](const glm::dvec2& px) {
    from += px;
    to += movedBy(homography, px);
    count += 1.0;
  });
  from /= count;
  to /= count;
  glm::dvec2 products(0.0);
  double squares = 0.0;
  forGridCentres(size, [&](const glm::dvec2& px) {
    const glm::dvec2 a = px - from;
    products += PlaneSimilarity::product({a.x, -a.y}, movedBy(homography, px) - to);
    squares += glm::dot(a, a);
  });
  PlaneSimilarity nearest{.linear = products / squares};
  nearest.shift = to - PlaneSimilarity::product(nearest.linear, from);
  return nearest;
}

}  // namespace

struct CanvasMotion::State {
  hal::FrameSize size;
  double reduction = 1.0;  // size of a reduced px, in frame px
  cv::Mat reduced;
  std::vector<cv::Mat> pyramid;
  std::vector<cv::Mat> keyPyramid;
  std::vector<cv::Point2f> candidates;
  std::vector<cv::Point2f> keyPoints;
  // Positions of the key points: in this frame, in the last one, in the one before.
  std::vector<cv::Point2f> points;
  std::vector<unsigned char> found;
  std::vector<float> errors;
  std::vector<cv::Point2f> from;
  std::vector<cv::Point2f> to;
  PlaneSimilarity firstFromKey;
  PlaneSimilarity firstFromFrame;
  PlaneSimilarity firstFromSeen;  // motion as measured, including steps too small to be followed

  /// Follows the measured motion unless it is too small.
  void moveTo(const PlaneSimilarity& seen) {
    firstFromSeen = seen;
    if (apartPx(seen, firstFromFrame, size) > kStillPx * firstFromFrame.scale()) {
      firstFromFrame = seen;
    }
  }

  void reduce(const hal::PlaneView& luma, hal::FrameSize frameSize) {
    auto* const bytes = const_cast<std::uint8_t*>(luma.bytes.data());  // OpenCV only reads them
    const cv::Mat full(frameSize.height, frameSize.width, CV_8UC1, bytes, luma.strideBytes);
    const int longSide = std::max(frameSize.width, frameSize.height);
    reduction = std::max(1.0, static_cast<double>(longSide) / kLongSidePx);
    const cv::Size small(std::max(1, static_cast<int>(std::lround(frameSize.width / reduction))),
                         std::max(1, static_cast<int>(std::lround(frameSize.height / reduction))));
    cv::resize(full, reduced, small, 0.0, 0.0, cv::INTER_AREA);
    cv::buildOpticalFlowPyramid(reduced, pyramid, kWindow, kLevels);
  }

  /// Makes this frame the key frame, from which later ones are measured.
  void makeKey() {
    firstFromKey = firstFromFrame;
    firstFromSeen = firstFromFrame;
    std::swap(keyPyramid, pyramid);
    candidates.clear();
    cv::goodFeaturesToTrack(reduced, candidates, kCandidates, kQuality, kSpacingPx);
    keyPoints.clear();
    std::array<int, kColumns * kRows> taken{};
    for (const cv::Point2f& p : candidates) {  // sorted by strength
      const int column = static_cast<int>(p.x) * kColumns / reduced.cols;
      const int row = static_cast<int>(p.y) * kRows / reduced.rows;
      if (taken[static_cast<std::size_t>(row * kColumns + column)]++ < kPerField) {
        keyPoints.push_back(p);
      }
    }
    points = keyPoints;
  }

  /// Measures frameFromKey in px of the frame. Returns false where too few points agree.
  bool measure(PlaneSimilarity& frameFromKey) {
    if (keyPoints.size() < kMinPoints) return false;
    cv::calcOpticalFlowPyrLK(
        keyPyramid, pyramid, keyPoints, points, found, errors, kWindow, kLevels,
        cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 20, 0.01),
        cv::OPTFLOW_USE_INITIAL_FLOW, 1e-3);
    from.clear();
    to.clear();
    for (std::size_t i = 0; i < keyPoints.size(); ++i) {
      if (found[i] == 0 || static_cast<double>(errors[i]) > kMaxError) {
        points[i] = keyPoints[i];
        continue;
      }
      from.push_back(keyPoints[i]);
      to.push_back(points[i]);
    }
    if (from.size() < kMinPoints) return false;
    const cv::Mat fit =
        cv::estimateAffinePartial2D(from, to, cv::noArray(), cv::RANSAC, kOutlierPx, 500, 0.995, 5);
    if (fit.empty()) return false;
    frameFromKey.linear = {fit.at<double>(0, 0), fit.at<double>(1, 0)};
    // Points that have collapsed into one fit a similarity of zoom zero, which has no inverse.
    const double zoom = frameFromKey.scale();
    if (!(zoom < kMaxZoom && zoom > 1.0 / kMaxZoom)) return false;
    // Integer pixel centres there, +0.5 here.
    const glm::dvec2 half(0.5);
    const glm::dvec2 shift(fit.at<double>(0, 2), fit.at<double>(1, 2));
    frameFromKey.shift =
        reduction * (shift + half - PlaneSimilarity::product(frameFromKey.linear, half));
    return agreeing(frameFromKey) * 2 >= keyPoints.size();
  }

  std::size_t agreeing(const PlaneSimilarity& frameFromKey) const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
      const glm::dvec2 at((from[i].x + 0.5) * reduction, (from[i].y + 0.5) * reduction);
      const glm::dvec2 wanted = frameFromKey(at) / reduction - 0.5;
      const cv::Point2f there(static_cast<float>(wanted.x), static_cast<float>(wanted.y));
      if (distance(there, to[i]) < 2.0 * kOutlierPx) ++count;
    }
    return count;
  }

  bool isFarFromKey(const PlaneSimilarity& frameFromKey) const {
    return apartPx(frameFromKey, {}, size) > kKeyShift * std::max(size.width, size.height);
  }
};

CanvasMotion::CanvasMotion() : state_(std::make_unique<State>()) {}

CanvasMotion::~CanvasMotion() = default;

void CanvasMotion::reset() {
  state_->size = {};
  state_->firstFromFrame = {};
  state_->firstFromSeen = {};
}

const PlaneSimilarity& CanvasMotion::follow(const hal::PlaneView& luma, hal::FrameSize size) {
  State& s = *state_;
  s.reduce(luma, size);
  if (s.size != size) {
    s.size = size;
    s.makeKey();
    return s.firstFromFrame;
  }
  PlaneSimilarity frameFromKey;
  if (!s.measure(frameFromKey)) {
    s.makeKey();
    return s.firstFromFrame;
  }
  s.moveTo(s.firstFromKey * frameFromKey.inverse());
  if (s.isFarFromKey(frameFromKey)) s.makeKey();
  return s.firstFromFrame;
}

const PlaneSimilarity& CanvasMotion::follow(const ImageMotion& motion) {
  State& s = *state_;
  // They are of earlier frames; the next frame that comes as luma becomes a key frame.
  s.keyPoints.clear();
  s.size = motion.frameSize;
  if (motion.isCut || !motion.picture) return s.firstFromFrame;
  const glm::dmat3& currentFromPrevious = motion.picture->currentFromPrevious;
  if (currentFromPrevious == glm::dmat3(1.0)) return s.firstFromFrame;
  s.moveTo(s.firstFromSeen * nearestTo(currentFromPrevious, s.size).inverse());
  return s.firstFromFrame;
}

}  // namespace pleinair::tracking
