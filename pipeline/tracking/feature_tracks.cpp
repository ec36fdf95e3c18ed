#include "pipeline/tracking/feature_tracks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace pleinair::tracking {
namespace {

constexpr int kLongSidePx = 640;  // of the picture that is followed
constexpr int kColumns = 10;
constexpr int kRows = 8;
constexpr std::size_t kPerTag = 16;
/// Least eigenvalue of the gradients in a window, OpenCV's measure: about 1.3 levels a pixel.
constexpr float kLeastCorner = 1e-4F;
constexpr double kSpacingPx = 9.0;  // between features, of the followed picture
constexpr double kBorderPx = 6.0;
constexpr int kLevels = 3;
constexpr float kLargestDifference = 16.0F;  // mean grey levels in a feature's window
constexpr double kBackPx = 0.4;              // from where a feature came
/// The key frame is worn when so few of its features are found …
constexpr double kLeastFound = 0.6;
/// … or these have moved by such a part of the longer side on average …
constexpr double kFarShift = 0.12;
/// … or their distances from their middle have changed so much, by turn or zoom.
constexpr double kFarTurn = 0.2;
const cv::Size kWindow{15, 15};

bool isNear(const cv::Point2f& a, const cv::Point2f& b, double px) {
  return std::hypot(static_cast<double>(a.x - b.x), static_cast<double>(a.y - b.y)) < px;
}

}  // namespace

struct FeatureTracks::State {
  hal::FrameSize size;
  double reduction = 1.0;  // frame px in a followed px
  bool hasKey = false;
  std::uint32_t nextId = 0;
  cv::Mat reduced;
  std::vector<cv::Mat> pyramid;
  std::vector<cv::Mat> keyPyramid;
  std::vector<FeatureTrack> tracks;
  // Of each track, in the followed picture's px with integer centres.
  std::vector<cv::Point2f> keyPoints;
  std::vector<cv::Point2f> points;
  std::vector<cv::Point2f> back;
  std::vector<unsigned char> found;
  std::vector<unsigned char> foundBack;
  std::vector<float> differences;
  std::vector<float> unused;
  cv::Mat corners;  // how good a corner each pixel of the pyramid's second level is

  void load(const hal::PlaneView& luma, hal::FrameSize frameSize) {
    auto* const bytes = const_cast<std::uint8_t*>(luma.bytes.data());  // OpenCV only reads them
    const cv::Mat full(frameSize.height, frameSize.width, CV_8UC1, bytes, luma.strideBytes);
    const int longSide = std::max(frameSize.width, frameSize.height);
    reduction = std::max(1.0, static_cast<double>(longSide) / kLongSidePx);
    if (reduction > 1.0) {
      const cv::Size small(
          std::max(1, static_cast<int>(std::lround(frameSize.width / reduction))),
          std::max(1, static_cast<int>(std::lround(frameSize.height / reduction))));
      cv::resize(full, reduced, small, 0.0, 0.0, cv::INTER_AREA);
    } else {
      reduced = full;
    }
    cv::buildOpticalFlowPyramid(reduced, pyramid, kWindow, kLevels, true, cv::BORDER_REFLECT_101,
                                cv::BORDER_CONSTANT, false);
  }

  glm::dvec2 framePx(const cv::Point2f& p) const {
    return reduction * (glm::dvec2(p.x, p.y) + 0.5);
  }
  cv::Point2f followedPx(const glm::dvec2& px) const {
    const glm::dvec2 p = px / reduction - 0.5;
    return {static_cast<float>(p.x), static_cast<float>(p.y)};
  }
  bool isInside(const cv::Point2f& p) const {
    const cv::Size of = pyramid.front().size();
    return p.x > kBorderPx && p.y > kBorderPx && p.x < of.width - kBorderPx &&
           p.y < of.height - kBorderPx;
  }

  void followAll() {
    if (keyPoints.empty()) return;
    const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 20, 0.005);
    cv::calcOpticalFlowPyrLK(keyPyramid, pyramid, keyPoints, points, found, differences, kWindow,
                             kLevels, until, cv::OPTFLOW_USE_INITIAL_FLOW, 1e-3);
    back = keyPoints;
    const cv::TermCriteria briefly(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 5, 0.05);
    cv::calcOpticalFlowPyrLK(pyramid, keyPyramid, points, back, foundBack, unused, kWindow, 0,
                             briefly, cv::OPTFLOW_USE_INITIAL_FLOW, 1e-3);
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      tracks[i].isFound = found[i] != 0 && foundBack[i] != 0 &&
                          differences[i] < kLargestDifference && isInside(points[i]) &&
                          isNear(back[i], keyPoints[i], kBackPx);
      if (tracks[i].isFound) {
        tracks[i].px = framePx(points[i]);
      } else {
        points[i] = followedPx(tracks[i].px);
      }
    }
    shiftLost();
  }

  /// What was not found is looked for next time where the found ones have gone.
  void shiftLost() {
    glm::dvec2 shift(0.0);
    std::size_t count = 0;
    for (const FeatureTrack& track : tracks) {
      if (!track.isFound) continue;
      shift += track.px - track.keyPx;
      ++count;
    }
    if (count == 0) return;
    shift /= static_cast<double>(count);
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      if (!tracks[i].isFound) points[i] = followedPx(tracks[i].keyPx + shift);
    }
  }

  void keepFound() {
    std::erase_if(tracks, [](const FeatureTrack& track) { return !track.isFound; });
    if (tracks.size() > kMostTracks) tracks.resize(kMostTracks);
    for (FeatureTrack& track : tracks) track.keyPx = track.px;
  }

  bool isFree(const cv::Point2f& p) const {
    return std::ranges::none_of(tracks, [&](const FeatureTrack& track) {
      return isNear(followedPx(track.keyPx), p, kSpacingPx);
    });
  }

  /// The best corner of a part of the second level's picture, taken out of it.
  bool takeBest(const cv::Rect& part, cv::Point2f& best) {
    double strength = 0.0;
    cv::Point at;
    cv::Mat view = corners(part);
    cv::minMaxLoc(view, nullptr, &strength, nullptr, &at);
    if (!(strength > kLeastCorner)) return false;
    const int reach = static_cast<int>(kSpacingPx / 2.0);
    const cv::Rect around(part.x + at.x - reach, part.y + at.y - reach, 2 * reach + 1,
                          2 * reach + 1);
    corners(around & cv::Rect({}, corners.size())).setTo(0.0F);
    best = {2.0F * static_cast<float>(part.x + at.x), 2.0F * static_cast<float>(part.y + at.y)};
    return true;
  }

  void addBestOf(cv::Rect part, std::size_t most) {
    part &= cv::Rect({}, corners.size());
    if (part.empty()) return;
    std::size_t added = 0;
    for (std::size_t tries = 0; tries < 2 * most + 2 && added < most; ++tries) {
      cv::Point2f at;
      if (tracks.size() >= kMostTracks || !takeBest(part, at)) return;
      if (!isInside(at) || !isFree(at)) continue;
      tracks.push_back({.id = nextId++, .keyPx = framePx(at), .px = framePx(at), .isFound = true});
      ++added;
    }
  }

  /// How many tracks a part of the second level's picture has.
  std::size_t countIn(const cv::Rect& part) const {
    return static_cast<std::size_t>(std::ranges::count_if(tracks, [&](const FeatureTrack& track) {
      const cv::Point2f p = followedPx(track.keyPx);
      return part.contains(cv::Point(static_cast<int>(p.x / 2.0F), static_cast<int>(p.y / 2.0F)));
    }));
  }

  void addNew(std::span<const TagCornersPx> tags) {
    constexpr std::size_t kSecondLevel = 2;      // each level's derivatives follow it
    if (pyramid.size() <= kSecondLevel) return;  // too small a picture to have one
    cv::cornerMinEigenVal(pyramid[kSecondLevel], corners, 5);
    for (const TagCornersPx& tag : tags) {
      cv::Rect2f box(0.5F * followedPx(tag[0]), cv::Size2f(1.0F, 1.0F));
      for (const glm::dvec2& px : tag) {
        box |= cv::Rect2f(0.5F * followedPx(px), cv::Size2f(1.0F, 1.0F));
      }
      const cv::Rect part = box;
      const std::size_t there = countIn(part);
      if (there < kPerTag) addBestOf(part, kPerTag - there);
    }
    for (int row = 0; row < kRows; ++row) {
      for (int column = 0; column < kColumns; ++column) {
        const cv::Point from(corners.cols * column / kColumns, corners.rows * row / kRows);
        const cv::Point to(corners.cols * (column + 1) / kColumns,
                           corners.rows * (row + 1) / kRows);
        const cv::Rect part(from, to);
        if (countIn(part) == 0) addBestOf(part, 1);
      }
    }
  }
};

FeatureTracks::FeatureTracks() : state_(std::make_unique<State>()) {}
FeatureTracks::~FeatureTracks() = default;

void FeatureTracks::reset() {
  state_->hasKey = false;
  state_->tracks.clear();
  state_->keyPoints.clear();
  state_->points.clear();
}

std::span<const FeatureTrack> FeatureTracks::tracks() const {
  return state_->tracks;
}

void FeatureTracks::follow(const hal::PlaneView& luma, hal::FrameSize size) {
  State& s = *state_;
  if (s.size != size) reset();
  s.size = size;
  s.load(luma, size);
  if (s.hasKey) s.followAll();
}

bool FeatureTracks::isKeyWorn() const {
  const State& s = *state_;
  if (!s.hasKey) return true;
  glm::dvec2 from(0.0);
  glm::dvec2 to(0.0);
  double found = 0.0;
  for (const FeatureTrack& track : s.tracks) {
    if (!track.isFound) continue;
    from += track.keyPx;
    to += track.px;
    found += 1.0;
  }
  if (found < kLeastFound * static_cast<double>(s.tracks.size())) return true;
  if (found == 0.0) return false;  // there is nothing to follow
  from /= found;
  to /= found;
  if (glm::distance(from, to) > kFarShift * std::max(s.size.width, s.size.height)) return true;
  double change = 0.0;
  double extent = 0.0;
  for (const FeatureTrack& track : s.tracks) {
    if (!track.isFound) continue;
    change += glm::distance(track.px - to, track.keyPx - from);
    extent += glm::length(track.keyPx - from);
  }
  return change > kFarTurn * extent;
}

void FeatureTracks::makeKey(std::span<const TagCornersPx> tags) {
  State& s = *state_;
  s.keepFound();
  s.addNew(tags);
  std::swap(s.keyPyramid, s.pyramid);
  s.hasKey = true;
  s.keyPoints.clear();
  for (const FeatureTrack& track : s.tracks) s.keyPoints.push_back(s.followedPx(track.keyPx));
  s.points = s.keyPoints;
}

}  // namespace pleinair::tracking
