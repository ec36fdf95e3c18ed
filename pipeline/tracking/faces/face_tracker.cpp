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
constexpr int kSureHits = 4;      // of a face that was not known; of fewer, two searches in turn
constexpr int kPatchPx = 24;      // a face's looks: so many px a side
constexpr int kReachPx = 6;       // of these, that it moves in a frame, at most
constexpr float kBorder = 0.1F;   // of the side, around it, that its looks include
constexpr float kAlike = 0.6F;    // correlation from which it is the same face
constexpr float kLearns = 0.8F;   // from which its looks follow it
constexpr float kGrowth = 1.04F;        // of its side in a frame, that is tried
constexpr float kClearlyMore = 0.005F;  // alike, from which it has grown
constexpr double kLearning = 0.1; // part of its looks that is new, a frame
constexpr double kFoundSeconds = 4.0;  // that it is followed without being found
constexpr double kComingSeconds = 0.4;
constexpr double kGoingSeconds = 0.6;
constexpr float kRest = 0.07F;  // of its side: so far it goes before its place follows
constexpr float kNear = 0.6F;   // of the side: what is found there is the same face
constexpr float kTwins = 0.4F;  // of the side: two that are so near are one
constexpr float kMostRatio = 1.7F;  // of its sides
constexpr float kFoundShare = 0.5F; // of what is found, in what is known

/// A px of its looks, in its sides.
constexpr float kPxOfSide = (1.0F + 2.0F * kBorder) / kPatchPx;

/// A face that is followed, px of the reduced image.
struct Known {
  cv::Point2f centre;  // where it is
  float side = 0.0F;
  cv::Point2f restCentre;  // where it is said to be
  float restSide = 0.0F;
  cv::Mat looks;
  double sinceFound = 0.0;  // s
  double presence = 0.0;
  bool isLost = false;
};

/// The square around a centre, with px of its own, `reach` of them wider on each side.
void cut(const cv::Mat& picture, cv::Point2f centre, float side, int reach, cv::Mat& patch) {
  const float pxOfOwn = kPxOfSide * side;
  const int size = kPatchPx + 2 * reach;
  const float first = -0.5F * static_cast<float>(size - 1) * pxOfOwn;
  const cv::Matx23f fromOwn(pxOfOwn, 0.0F, centre.x + first, 0.0F, pxOfOwn, centre.y + first);
  cv::warpAffine(picture, patch, fromOwn, {size, size}, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
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
  /// Each search is by the next one: what one of them does not find, another one may. The first
  /// search is by all.
  std::array<FaceDetector, kFaceCascades> detectors{FaceDetector(faceCascades()[0]),
                                                    FaceDetector(faceCascades()[1])};
  std::size_t detector = 0;
  cv::Mat reduced;
  cv::Mat patch;
  cv::Mat scores;
  std::vector<Known> known;
  std::vector<FoundFace> before;  // what the search before the last one found
  std::vector<Face> faces;
  hal::FrameSize frameSize;
  hal::TimePoint lastTime;
  bool hasPast = false;

  struct Match {
    cv::Point2f centre;
    float side;
    float alike;  // correlation
  };

  const cv::Mat& reduce(const LumaPyramid& pyramid);
  Match match(const cv::Mat& picture, const Known& face, float side);
  void followLooks(const cv::Mat& picture, Known& face);
  void search(const cv::Mat& picture);
  void take(const cv::Mat& picture, FaceDetector& by);
  void joinTwins();
  Known* nearest(const FoundFace& found);
  bool isSure(const FoundFace& found) const;
  void report(double seconds, const LumaPyramid& pyramid, const cv::Mat& picture);
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

/// The place nearby of what looks most like a face of this side.
FaceTracker::State::Match FaceTracker::State::match(const cv::Mat& picture, const Known& face,
                                                    float side) {
  cut(picture, face.centre, side, kReachPx, patch);
  cv::matchTemplate(patch, face.looks, scores, cv::TM_CCOEFF_NORMED);
  double best = 0.0;
  cv::Point at;
  cv::minMaxLoc(scores, nullptr, &best, nullptr, &at);
  const auto scoreAt = [&](int dx, int dy) {
    const int x = std::clamp(at.x + dx, 0, scores.cols - 1);
    const int y = std::clamp(at.y + dy, 0, scores.rows - 1);
    return scores.at<float>(y, x);
  };
  const float own = scoreAt(0, 0);
  const cv::Point2f moved(
      static_cast<float>(at.x - kReachPx) + peakOf(scoreAt(-1, 0), own, scoreAt(1, 0)),
      static_cast<float>(at.y - kReachPx) + peakOf(scoreAt(0, -1), own, scoreAt(0, 1)));
  return {face.centre + moved * (side * kPxOfSide), side, static_cast<float>(best)};
}

/// To the place nearby, and the size, that look most like it.
void FaceTracker::State::followLooks(const cv::Mat& picture, Known& face) {
  Match best = match(picture, face, face.side);
  for (const float side : {face.side * kGrowth, face.side / kGrowth}) {
    const Match other = match(picture, face, side);
    if (other.alike > best.alike + kClearlyMore) best = other;
  }
  face.isLost = best.alike < kAlike;
  if (face.isLost) return;
  face.centre = best.centre;
  face.side = best.side;
  if (best.alike < kLearns) return;
  cut(picture, face.centre, face.side, 0, patch);
  cv::addWeighted(face.looks, 1.0 - kLearning, patch, kLearning, 0.0, face.looks);
}

Known* FaceTracker::State::nearest(const FoundFace& found) {
  Known* nearest = nullptr;
  float least = 1.0F;
  for (Known& each : known) {
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

void FaceTracker::State::search(const cv::Mat& picture) {
  if (!hasPast) {
    for (FaceDetector& each : detectors) {
      each.search(picture, 1.0);
      take(picture, each);
    }
    return;
  }
  FaceDetector& by = detectors.at(detector);
  if (!by.search(picture, 1.0 / kSearchFrames)) return;
  take(picture, by);
  detector = (detector + 1) % kFaceCascades;
}

/// Takes what a search has found.
void FaceTracker::State::take(const cv::Mat& picture, FaceDetector& by) {
  for (const FoundFace& earlier : by.found()) {
    // A search is of several frames: what it has found may have gone on since.
    const std::optional<FoundFace> here = by.findNear(picture, earlier);
    if (!here) continue;
    const FoundFace& found = *here;
    Known* face = nearest(found);
    const bool isNew = face == nullptr;
    if (isNew && !isSure(found)) continue;
    if (isNew) {
      face = &known.emplace_back();
      face->restCentre = face->centre = found.centre;
      face->restSide = face->side = found.sidePx;
      face->presence = hasPast ? 0.0 : 1.0;
    } else {
      face->centre += kFoundShare * (found.centre - face->centre);
      face->side += kFoundShare * (found.sidePx - face->side);
    }
    face->sinceFound = 0.0;
    face->isLost = false;
    cut(picture, face->centre, face->side, 0, face->looks);
  }
  before = by.found();
  joinTwins();
}

/// Of two that have come to the same place, the one remains that was found later, or was known first.
void FaceTracker::State::joinTwins() {
  for (std::size_t i = 0; i < known.size(); ++i) {
    const auto isTwin = [&](const Known& other) {
      const cv::Point2f apart = known[i].centre - other.centre;
      return &other != &known[i] && std::hypot(apart.x, apart.y) < kTwins * known[i].side &&
             known[i].sinceFound <= other.sinceFound;
    };
    const auto twin = std::ranges::find_if(known, isTwin);
    if (twin == known.end()) continue;
    known[i].presence = std::max(known[i].presence, twin->presence);
    known.erase(twin);
    i = static_cast<std::size_t>(-1);  // from the first again
  }
}

/// Lets faces come and go, and says where they are.
void FaceTracker::State::report(double seconds, const LumaPyramid& pyramid,
                                const cv::Mat& picture) {
  for (Known& each : known) {
    each.sinceFound += seconds;
    const bool isThere = !each.isLost && each.sinceFound < kFoundSeconds;
    const double change = isThere ? seconds / kComingSeconds : -seconds / kGoingSeconds;
    each.presence = std::clamp(each.presence + change, 0.0, 1.0);
    const cv::Point2f apart = each.centre - each.restCentre;
    const float distance = std::hypot(apart.x, apart.y);
    const float slack = kRest * each.side;
    if (distance > slack) each.restCentre += apart * ((distance - slack) / distance);
    const float grown = each.side - each.restSide;
    if (std::abs(grown) > slack) each.restSide += grown - std::copysign(slack, grown);
  }
  std::erase_if(known, [](const Known& each) {
    return each.presence <= 0.0 && (each.isLost || each.sinceFound >= kFoundSeconds);
  });
  const glm::dvec2 frame(pyramid.frameSize().width, pyramid.frameSize().height);
  const glm::dvec2 frameOfOwn = frame / glm::dvec2(picture.cols, picture.rows);
  faces.clear();
  for (const Known& each : known) {
    if (each.presence <= 0.0) continue;
    faces.push_back({frameOfOwn * (glm::dvec2(each.restCentre.x, each.restCentre.y) + 0.5),
                     frameOfOwn.x * each.restSide, each.presence});
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
  const double seconds = s.hasPast ? hal::toSeconds(captureTime - s.lastTime) : 0.0;
  for (Known& each : s.known) s.followLooks(picture, each);
  s.search(picture);
  s.report(std::max(seconds, 0.0), *pyramid, picture);
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
