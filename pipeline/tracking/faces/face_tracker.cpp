#include "pipeline/tracking/faces/face_tracker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "pipeline/tracking/faces/face_cascades.h"
#include "pipeline/tracking/faces/face_detector.h"
#include "pipeline/tracking/image/luma_pyramid.h"

namespace pleinair::tracking {
namespace {

constexpr int kLongSidePx = 320;
constexpr double kSearchSeconds = 0.55;
/// Parts of a search that a frame does, whatever the rate of frames.
constexpr double kLeastPart = 1.0 / 40.0;
constexpr double kMostPart = 1.0 / 6.0;
constexpr double kMostStepSeconds = 1.0;
/// Hits of a face that was not known; one of fewer must be found by two searches in turn.
constexpr int kSureHits = 4;

constexpr int kPatchPx = 24;     // side of a patch, which is a face's appearance
constexpr int kReachPx = 6;      // of these, that it moves in a frame, at most
constexpr float kBorder = 0.1F;  // of the side, around it, that its patch includes
/// A px of its patch, in its sides.
constexpr float kPxOfSide = (1.0F + 2.0F * kBorder) / kPatchPx;
constexpr float kSame = 0.6F;      // correlation from which it is the same face
constexpr float kClear = 0.8F;     // from which its appearance follows it
constexpr float kGrowth = 1.04F;   // of its side in a frame, that is tried
constexpr float kBetter = 0.005F;  // correlation by which another size must be better
constexpr double kLearning = 0.1;  // part of its appearance that is new, a frame

constexpr double kFoundSeconds = 4.0;  // that it is followed without being found
constexpr double kComingSeconds = 0.4;
constexpr double kGoingSeconds = 0.6;
constexpr float kDeadBand = 0.07F;   // of its side: so far it goes before its place follows
constexpr float kNear = 0.6F;        // of the side: what is found there is the same face
constexpr float kMostRatio = 1.7F;   // of its sides
constexpr float kDuplicate = 0.4F;   // of the side: two that are so near are one
constexpr float kFoundShare = 0.5F;  // of what is found, in what is known

/// A face that is followed, px of the reduced image.
struct KnownFace {
  cv::Point2f centre;
  float side = 0.0F;
  cv::Point2f reportedCentre;
  float reportedSide = 0.0F;
  cv::Mat patch;
  double sinceFound = 0.0;  // s
  double presence = 0.0;
  bool isLost = false;
};

/// Samples the square around a centre, `reach` px of the patch wider on each side.
void samplePatch(const cv::Mat& picture, cv::Point2f centre, float side, int reach,
                 cv::Mat& patch) {
  const float scale = kPxOfSide * side;
  const int size = kPatchPx + 2 * reach;
  const float first = -0.5F * static_cast<float>(size - 1) * scale;
  const cv::Matx23f fromPatch(scale, 0.0F, centre.x + first, 0.0F, scale, centre.y + first);
  cv::warpAffine(picture, patch, fromPatch, {size, size}, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
                 cv::BORDER_REPLICATE);
}

/// How far apart two faces are: below 1, they are one.
float distanceOf(cv::Point2f a, float sideOfA, cv::Point2f b, float sideOfB) {
  const float larger = std::max(sideOfA, sideOfB);
  if (larger > kMostRatio * std::min(sideOfA, sideOfB)) return 1.0F;
  const cv::Point2f apart = a - b;
  return std::hypot(apart.x, apart.y) / (kNear * larger);
}

/// From the largest of three neighbours to the top of their parabola.
float peakOf(float before, float here, float after) {
  const float bend = before - 2.0F * here + after;
  return bend < -1e-6F ? std::clamp(0.5F * (before - after) / bend, -0.5F, 0.5F) : 0.0F;
}

}  // namespace

struct FaceTracker::State {
  struct Match {
    cv::Point2f centre;
    float side;
    float correlation;
  };

  /// Each search is by the next one: what one of them does not find, another one may. The first
  /// search is by all.
  std::array<FaceDetector, kFaceCascades> detectors{FaceDetector(faceCascades()[0]),
                                                    FaceDetector(faceCascades()[1])};
  std::size_t detector = 0;
  cv::Mat reduced;
  cv::Mat patch;
  cv::Mat correlations;
  std::vector<KnownFace> known;
  std::vector<FoundFace> before;  // what the search before the last one found
  std::vector<Face> faces;
  hal::FrameSize frameSize;
  hal::TimePoint lastTime;
  bool hasPast = false;

  const cv::Mat& reduce(const LumaPyramid& pyramid);
  Match match(const cv::Mat& picture, const KnownFace& face, float side);
  void followAppearance(const cv::Mat& picture, KnownFace& face);
  void search(const cv::Mat& picture, double seconds);
  void take(const cv::Mat& picture, FaceDetector& by);
  void takeFound(const cv::Mat& picture, const FoundFace& found);
  void mergeDuplicates();
  KnownFace* nearest(const FoundFace& found);
  bool isSure(const FoundFace& found) const;
  void age(double seconds);
  void report(const LumaPyramid& pyramid, const cv::Mat& picture);
};

const cv::Mat& FaceTracker::State::reduce(const LumaPyramid& pyramid) {
  const cv::Mat& enough = pyramid.smallest(
      [](cv::Size size) { return std::max(size.width, size.height) >= kLongSidePx; });
  const int longSide = std::max(enough.cols, enough.rows);
  if (longSide <= kLongSidePx) return enough;
  const double scale = static_cast<double>(kLongSidePx) / longSide;
  cv::resize(enough, reduced, {}, scale, scale, cv::INTER_AREA);
  return reduced;
}

/// The place nearby of what correlates most with a face of this side.
FaceTracker::State::Match FaceTracker::State::match(const cv::Mat& picture, const KnownFace& face,
                                                    float side) {
  samplePatch(picture, face.centre, side, kReachPx, patch);
  cv::matchTemplate(patch, face.patch, correlations, cv::TM_CCOEFF_NORMED);
  double best = 0.0;
  cv::Point at;
  cv::minMaxLoc(correlations, nullptr, &best, nullptr, &at);
  const auto correlationAt = [&](int dx, int dy) {
    const int x = std::clamp(at.x + dx, 0, correlations.cols - 1);
    const int y = std::clamp(at.y + dy, 0, correlations.rows - 1);
    return correlations.at<float>(y, x);
  };
  const float here = correlationAt(0, 0);
  const cv::Point2f moved(
      static_cast<float>(at.x - kReachPx) + peakOf(correlationAt(-1, 0), here, correlationAt(1, 0)),
      static_cast<float>(at.y - kReachPx) +
          peakOf(correlationAt(0, -1), here, correlationAt(0, 1)));
  return {face.centre + moved * (side * kPxOfSide), side, static_cast<float>(best)};
}

void FaceTracker::State::followAppearance(const cv::Mat& picture, KnownFace& face) {
  Match best = match(picture, face, face.side);
  for (const float side : {face.side * kGrowth, face.side / kGrowth}) {
    const Match other = match(picture, face, side);
    if (other.correlation > best.correlation + kBetter) best = other;
  }
  face.isLost = best.correlation < kSame;
  if (face.isLost) return;
  face.centre = best.centre;
  face.side = best.side;
  if (best.correlation < kClear) return;
  samplePatch(picture, face.centre, face.side, 0, patch);
  cv::addWeighted(face.patch, 1.0 - kLearning, patch, kLearning, 0.0, face.patch);
}

KnownFace* FaceTracker::State::nearest(const FoundFace& found) {
  KnownFace* nearest = nullptr;
  float least = 1.0F;
  for (KnownFace& each : known) {
    const float distance = distanceOf(each.centre, each.side, found.centre, found.sidePx);
    if (distance >= least) continue;
    least = distance;
    nearest = &each;
  }
  return nearest;
}

/// Whether something that is not known is a face.
bool FaceTracker::State::isSure(const FoundFace& found) const {
  if (known.size() >= kMaxFaces) return false;
  return found.hits >= kSureHits || std::ranges::any_of(before, [&](const FoundFace& other) {
           return distanceOf(found.centre, found.sidePx, other.centre, other.sidePx) < 1.0F;
         });
}

void FaceTracker::State::search(const cv::Mat& picture, double seconds) {
  if (!hasPast) {
    for (FaceDetector& each : detectors) {
      each.search(picture, 1.0);
      take(picture, each);
    }
    return;
  }
  FaceDetector& by = detectors.at(detector);
  if (!by.search(picture, std::clamp(seconds / kSearchSeconds, kLeastPart, kMostPart))) return;
  take(picture, by);
  detector = (detector + 1) % kFaceCascades;
}

/// Takes what a search has found. It was of several frames: what it has found may have gone since,
/// so it is looked for once more.
void FaceTracker::State::take(const cv::Mat& picture, FaceDetector& by) {
  std::size_t asked = 0;
  for (const FoundFace& earlier : by.found()) {
    if (asked == kMaxFaces) break;
    if (nearest(earlier) == nullptr && !isSure(earlier)) continue;
    ++asked;
    const std::optional<FoundFace> now = by.findNear(picture, earlier);
    if (now) takeFound(picture, *now);
  }
  before = by.found();
  mergeDuplicates();
}

void FaceTracker::State::takeFound(const cv::Mat& picture, const FoundFace& found) {
  KnownFace* face = nearest(found);
  if (face == nullptr) {
    face = &known.emplace_back();
    face->reportedCentre = face->centre = found.centre;
    face->reportedSide = face->side = found.sidePx;
    face->presence = hasPast ? 0.0 : 1.0;
  } else {
    face->centre += kFoundShare * (found.centre - face->centre);
    face->side += kFoundShare * (found.sidePx - face->side);
  }
  face->sinceFound = 0.0;
  face->isLost = false;
  samplePatch(picture, face->centre, face->side, 0, face->patch);
}

/// Of two that have come to the same place, the one remains that was found later, or was known
/// first.
void FaceTracker::State::mergeDuplicates() {
  for (std::size_t i = 0; i < known.size();) {
    const auto isDuplicate = [&](const KnownFace& other) {
      const cv::Point2f apart = known[i].centre - other.centre;
      return &other != &known[i] && std::hypot(apart.x, apart.y) < kDuplicate * known[i].side &&
             known[i].sinceFound <= other.sinceFound;
    };
    const auto duplicate = std::ranges::find_if(known, isDuplicate);
    if (duplicate == known.end()) {
      ++i;
      continue;
    }
    known[i].presence = std::max(known[i].presence, duplicate->presence);
    known.erase(duplicate);
    i = 0;
  }
}

/// Lets faces come and go.
void FaceTracker::State::age(double seconds) {
  for (KnownFace& each : known) {
    each.sinceFound += seconds;
    const bool isThere = !each.isLost && each.sinceFound < kFoundSeconds;
    const double change = isThere ? seconds / kComingSeconds : -seconds / kGoingSeconds;
    each.presence = std::clamp(each.presence + change, 0.0, 1.0);
  }
  std::erase_if(known, [](const KnownFace& each) {
    return each.presence <= 0.0 && (each.isLost || each.sinceFound >= kFoundSeconds);
  });
}

/// Says where they are: they follow only as far as they leave a dead band.
void FaceTracker::State::report(const LumaPyramid& pyramid, const cv::Mat& picture) {
  const glm::dvec2 frame(pyramid.frameSize().width, pyramid.frameSize().height);
  const glm::dvec2 frameOfReduced = frame / glm::dvec2(picture.cols, picture.rows);
  faces.clear();
  for (KnownFace& each : known) {
    const float slack = kDeadBand * each.side;
    const cv::Point2f apart = each.centre - each.reportedCentre;
    const float distance = std::hypot(apart.x, apart.y);
    if (distance > slack) each.reportedCentre += apart * ((distance - slack) / distance);
    const float grown = each.side - each.reportedSide;
    if (std::abs(grown) > slack) each.reportedSide += grown - std::copysign(slack, grown);
    if (each.presence <= 0.0) continue;
    const glm::dvec2 centre(each.reportedCentre.x, each.reportedCentre.y);
    faces.push_back({.centre = frameOfReduced * (centre + 0.5),
                     .sidePx = frameOfReduced.x * each.reportedSide,
                     .presence = each.presence});
  }
}

FaceTracker::FaceTracker() : state_(std::make_unique<State>()) {}

FaceTracker::~FaceTracker() = default;

std::span<const Face> FaceTracker::follow(LumaFrame& frame, hal::TimePoint captureTime,
                                          bool isCut) {
  State& s = *state_;
  if (isCut || frame.size() != s.frameSize) reset();
  const auto pyramid = frame.pyramid();
  const cv::Mat& picture = s.reduce(*pyramid);
  const double step = s.hasPast ? hal::toSeconds(captureTime - s.lastTime) : 0.0;
  const double seconds = std::clamp(step, 0.0, kMostStepSeconds);
  for (KnownFace& each : s.known) s.followAppearance(picture, each);
  s.age(seconds);
  s.search(picture, seconds);
  s.report(*pyramid, picture);
  s.frameSize = frame.size();
  s.lastTime = captureTime;
  s.hasPast = true;
  return s.faces;
}

void FaceTracker::reset() {
  State& s = *state_;
  for (FaceDetector& each : s.detectors) each.reset();
  s.detector = 0;
  s.known.clear();
  s.before.clear();
  s.faces.clear();
  s.hasPast = false;
}

}  // namespace pleinair::tracking
