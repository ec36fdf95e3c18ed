#include "pipeline/tracking/pose/surface_corners.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <opencv2/core.hpp>

#include "pipeline/tracking/image/corners.h"
#include "pipeline/tracking/image/luma_pyramid.h"

namespace pleinair::tracking {
namespace {

constexpr int kColumns = 10;
constexpr int kRows = 8;
constexpr std::size_t kPerTag = 16;
constexpr double kBorderPx = 6.0;              // of the followed image
constexpr double kMaxDifference = 16.0;        // mean difference in a feature's window, grey levels
constexpr double kMaxForwardBackwardPx = 0.4;  // largest forward-backward error
/// The key frame is stale when fewer than this part of its features are found …
constexpr double kMinFoundShare = 0.6;
/// … or they have moved by this part of the longer side on average …
constexpr double kFarShift = 0.12;
/// … or a turn or zoom changed their distances from their centre by this part.
constexpr double kFarTurn = 0.2;

bool isNear(const cv::Point2f& a, const cv::Point2f& b, double px) {
  return std::hypot(static_cast<double>(a.x - b.x), static_cast<double>(a.y - b.y)) < px;
}

}  // namespace

struct SurfaceCorners::State {
  hal::FrameSize size;
  bool hasKey = false;
  std::uint32_t nextId = 0;
  std::shared_ptr<const LumaPyramid> pyramid;
  std::shared_ptr<const LumaPyramid> keyPyramid;
  PointFollower follower;
  CornerSearch corners;
  std::vector<FeatureTrack> tracks;
  // Per track, in px of the pyramids.
  std::vector<cv::Point2f> keyPoints;
  std::vector<cv::Point2f> points;

  void followAll() {
    follower.follow(*keyPyramid, *pyramid, keyPoints, points);
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      tracks[i].isFound = follower.isFound(i) && follower.difference(i) < kMaxDifference &&
                          pyramid->isInside(points[i], kBorderPx) &&
                          follower.forwardBackwardPx(i) < kMaxForwardBackwardPx;
      if (tracks[i].isFound) {
        tracks[i].px = pyramid->framePx(points[i]);
      } else {
        points[i] = pyramid->ownPx(tracks[i].px);
      }
    }
    shiftLost();
  }

  /// Predicts the positions of lost features for the next frame by the motion of the found ones.
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
      if (!tracks[i].isFound) points[i] = pyramid->ownPx(tracks[i].keyPx + shift);
    }
  }

  void keepFound() {
    std::erase_if(tracks, [](const FeatureTrack& track) { return !track.isFound; });
    if (tracks.size() > kMaxTracks) tracks.resize(kMaxTracks);
    for (FeatureTrack& track : tracks) track.keyPx = track.px;
  }

  bool isFree(const cv::Point2f& p) const {
    return std::ranges::none_of(tracks, [&](const FeatureTrack& track) {
      return isNear(pyramid->ownPx(track.keyPx), p, CornerSearch::kSpacingPx);
    });
  }

  void addBestOf(const cv::Rect& part, std::size_t most) {
    std::size_t added = 0;
    for (std::size_t tries = 0; tries < 2 * most + 2 && added < most; ++tries) {
      cv::Point2f at;
      if (tracks.size() >= kMaxTracks || !corners.takeStrongest(part, at)) return;
      if (!pyramid->isInside(at, kBorderPx) || !isFree(at)) continue;
      const glm::dvec2 px = pyramid->framePx(at);
      tracks.push_back({.id = nextId++, .keyPx = px, .px = px, .isFound = true});
      ++added;
    }
  }

  /// Number of tracks in a region of the second level's image.
  std::size_t countIn(const cv::Rect& part) const {
    return static_cast<std::size_t>(std::ranges::count_if(tracks, [&](const FeatureTrack& track) {
      const cv::Point2f p = pyramid->ownPx(track.keyPx);
      return part.contains(cv::Point(static_cast<int>(p.x / 2.0F), static_cast<int>(p.y / 2.0F)));
    }));
  }

  void addNew(std::span<const TagCornersPx> tags) {
    if (!corners.load(*pyramid)) return;  // the image is too small
    for (const TagCornersPx& tag : tags) {
      cv::Rect2f box(0.5F * pyramid->ownPx(tag[0]), cv::Size2f(1.0F, 1.0F));
      for (const glm::dvec2& px : tag) {
        box |= cv::Rect2f(0.5F * pyramid->ownPx(px), cv::Size2f(1.0F, 1.0F));
      }
      const cv::Rect part = box;
      const std::size_t there = countIn(part);
      if (there < kPerTag) addBestOf(part, kPerTag - there);
    }
    for (int row = 0; row < kRows; ++row) {
      for (int column = 0; column < kColumns; ++column) {
        const cv::Point from(corners.size().width * column / kColumns,
                             corners.size().height * row / kRows);
        const cv::Point to(corners.size().width * (column + 1) / kColumns,
                           corners.size().height * (row + 1) / kRows);
        const cv::Rect part(from, to);
        if (countIn(part) == 0) addBestOf(part, 1);
      }
    }
  }
};

SurfaceCorners::SurfaceCorners() : state_(std::make_unique<State>()) {}
SurfaceCorners::~SurfaceCorners() = default;

void SurfaceCorners::reset() {
  state_->hasKey = false;
  state_->tracks.clear();
  state_->keyPoints.clear();
  state_->points.clear();
}

std::span<const FeatureTrack> SurfaceCorners::tracks() const {
  return state_->tracks;
}

void SurfaceCorners::follow(std::shared_ptr<const LumaPyramid> now) {
  State& s = *state_;
  if (s.size != now->frameSize()) reset();
  s.size = now->frameSize();
  s.pyramid = std::move(now);
  if (s.hasKey) s.followAll();
}

bool SurfaceCorners::isKeyStale() const {
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
  if (found < kMinFoundShare * static_cast<double>(s.tracks.size())) return true;
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

void SurfaceCorners::makeKey(std::span<const TagCornersPx> tags) {
  State& s = *state_;
  s.keepFound();
  s.addNew(tags);
  s.keyPyramid = s.pyramid;
  s.hasKey = true;
  s.keyPoints.clear();
  for (const FeatureTrack& track : s.tracks)
    s.keyPoints.push_back(s.keyPyramid->ownPx(track.keyPx));
  s.points = s.keyPoints;
}

}  // namespace pleinair::tracking
