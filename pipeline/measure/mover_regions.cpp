#include "pipeline/measure/mover_regions.h"

#include <chrono>
#include <cstddef>

#include <opencv2/imgproc.hpp>

#include "pipeline/measure/image_measures.h"
#include "pipeline/measure/input/picture.h"

namespace pleinair::measure {
namespace {

using namespace std::chrono_literals;

constexpr int kStillLevels = 8;
constexpr int kReturnedLevels = 4;
constexpr double kSmooth = 2.0;  // sigma, px
constexpr hal::Duration kGhost = 200ms;
constexpr hal::Duration kReturn = 1s;
constexpr hal::Duration kFollow = 300ms;
constexpr hal::Duration kSettled = 1s;
constexpr double kNoticeablePart = 0.003;

/// Calls visit(place) for each pixel within the border.
template <class Visit>
void forEachInner(cv::Size size, Visit visit) {
  const cv::Rect inner = innerRect(size);
  for (int y = inner.y; y < inner.br().y; ++y) {
    for (int x = inner.x; x < inner.br().x; ++x) visit(cv::Point(x, y));
  }
}

double squaredDistance(const cv::Vec3b& a, const cv::Vec3b& b) {
  const cv::Vec3d apart = cv::Vec3d(a) - cv::Vec3d(b);
  return apart.dot(apart);
}

cv::Mat3b smoothed(const cv::Mat3b& picture) {
  cv::Mat3b smooth;
  cv::GaussianBlur(picture, smooth, {}, kSmooth);
  return smooth;
}

/// Sensor noise changes the mean of nine pixels by less than kStillLevels.
cv::Mat3b meanOfNine(const cv::Mat3b& picture) {
  cv::Mat3b mean;
  cv::blur(picture, mean, {3, 3});
  return mean;
}

}  // namespace

StillRegion::StillRegion(cv::Size size) : changedAt_(static_cast<std::size_t>(size.area())) {}

void StillRegion::add(const MoverFrame& frame) {
  const cv::Size size = frame.input.size();
  const cv::Mat3b mean = meanOfNine(frame.input);
  if (!far_.empty()) {
    cv::Mat1b isFar;
    cv::bitwise_or(frame.zones.far, far_, isFar);
    cv::Mat1b isLit(size, 0);
    forEachInner(size, [&](cv::Point at) {
      const bool changes = largestDifference(mean(at), mean_(at)) > kStillLevels;
      if (changes && isFar(at) == 0) isLit(at) = 255;
    });
    cv::morphologyEx(isLit, isLit, cv::MORPH_OPEN, cv::Mat1b::ones(3, 3));  // noise is no lamp
    isLit = grown(isLit, kFarPixels);
    forEachInner(size, [&](cv::Point at) {
      auto& changedAt = changedAt_[static_cast<std::size_t>(at.y * size.width + at.x)];
      if (isLit(at) != 0) changedAt = frame.time;
      if (isFar(at) != 0) return;
      const bool isChanged = largestDifference(frame.output(at), output_(at)) > kStillLevels;
      const bool isOwn = largestDifference(frame.input(at), input_(at)) > kStillLevels;
      const bool isSettled = !changedAt || frame.time - *changedAt >= kSettled;
      if (!isOwn && isSettled) changed_ += {isChanged ? 1.0 : 0.0, 1.0};
      inputChanged_ += {isOwn ? 1.0 : 0.0, 1.0};
    });
  }
  mean_ = mean;
  input_ = frame.input;
  output_ = frame.output;
  far_ = frame.zones.far;
}

std::optional<double> StillRegion::percent() const {
  return percentOf(changed_);
}

std::optional<double> StillRegion::inputPercent() const {
  return percentOf(inputChanged_);
}

SuddenChangeRegion::SuddenChangeRegion(cv::Size size)
    : changes_(static_cast<std::size_t>(size.area())) {}

void SuddenChangeRegion::add(const MoverFrame& frame) {
  const cv::Size size = frame.input.size();
  const cv::Mat3b mean = meanOfNine(frame.input);
  const cv::Mat3b output = smoothed(frame.output);
  if (!mean_.empty()) {
    forEachInner(size, [&](cv::Point at) {
      std::optional<Change>& change = changes_[static_cast<std::size_t>(at.y * size.width + at.x)];
      const int step = largestDifference(mean(at), mean_(at));
      const bool isFar = frame.zones.far(at) != 0 || far_(at) != 0;
      if (isFar || step > kStillLevels) change.reset();
      if (isFar) return;
      if (step > kContrastLevels) change = Change{frame.time, output_(at), std::nullopt};
      if (!change) return;
      const hal::Duration since = frame.time - change->at;
      if (!change->soonAfter && since >= kFollow) change->soonAfter = output(at);
      if (since < kSettled) return;
      apart_ += {meanDifference(*change->soonAfter, output(at)), 1.0};
      whole_ += {meanDifference(change->before, output(at)), 1.0};
      change.reset();
    });
  }
  mean_ = mean;
  output_ = output;
  far_ = frame.zones.far;
}

std::optional<double> SuddenChangeRegion::follow() const {
  if (whole_.weight < kNoticeablePart * static_cast<double>(changes_.size())) return std::nullopt;
  // A painting that has not changed within a second follows nothing.
  if (whole_.value().value_or(0) == 0) return 1.0;
  return ratio(apart_.value(), whole_.value());
}

Ground::Ground(cv::Size size)
    : input_(size, cv::Vec3b()), painted_(size, cv::Vec3b()), isKnown_(size, 0) {}

void Ground::take(cv::Point at, const MoverFrame& frame) {
  input_(at) = frame.input(at);
  painted_(at) = frame.output(at);
  isKnown_(at) = 255;
}

UncoveredRegion::UncoveredRegion(cv::Size size)
    : size_(size), visits_(static_cast<std::size_t>(size.area())) {}

void UncoveredRegion::add(const MoverFrame& frame, Ground& ground) {
  forEachInner(size_, [&](cv::Point at) {
    Visit& visit = visits_[static_cast<std::size_t>(at.y * size_.width + at.x)];
    if (frame.zones.close(at) != 0) {
      cover(visit, at, frame, ground);
      return;
    }
    const bool isAwaiting = awaitsReturn(visit, at, frame, ground);
    if (!isAwaiting && frame.zones.near(at) == 0) ground.take(at, frame);
  });
}

void UncoveredRegion::cover(Visit& visit, cv::Point at, const MoverFrame& frame,
                            const Ground& ground) {
  visit.isAway = false;
  if (frame.zones.mover(at) == 0 || !ground.isKnown(at)) return;
  visit.contrast += {meanDifference(frame.input(at), ground.input(at)), 1.0};
}

bool UncoveredRegion::awaitsReturn(Visit& visit, cv::Point at, const MoverFrame& frame,
                                   const Ground& ground) {
  if (visit.contrast.weight == 0) return false;
  if (!visit.isAway) {
    visit.isAway = true;
    visit.isGhostTaken = false;
    visit.leftAt = frame.time;
  }
  const hal::Duration since = frame.time - visit.leftAt;
  const bool isSame = largestDifference(frame.input(at), ground.input(at)) <= kReturnedLevels;
  const double difference = meanDifference(frame.output(at), ground.painted(at));
  if (!visit.isGhostTaken && since >= kGhost) {
    visit.isGhostTaken = true;
    if (isSame) {
      ghost_ += {difference, 1.0};
      contrast_ += {*visit.contrast.value(), 1.0};
    }
  }
  if (since < kReturn || frame.zones.near(at) != 0) return true;
  if (isSame) returned_ += {difference, 1.0};
  visit = {};
  return false;
}

void LostRegion::add(const MoverFrame& frame, const Ground& ground) {
  if (cv::countNonZero(frame.zones.within) == 0) return;
  const cv::Mat3b output = smoothed(frame.output);
  // A mover in a light palette is not lost because it is lighter than the camera saw it.
  const cv::Mat3b input = smoothed(inPaletteOf(frame.output, frame.input, frame.zones.far));
  const cv::Mat3b before = smoothed(ground.painting());
  forEachInner(frame.input.size(), [&](cv::Point at) {
    if (frame.zones.within(at) == 0 || !ground.isKnown(at)) return;
    if (largestDifference(frame.input(at), ground.input(at)) <= kContrastLevels) return;
    const bool isLost =
        squaredDistance(output(at), before(at)) < squaredDistance(output(at), input(at));
    lost_ += {isLost ? 1.0 : 0.0, 1.0};
  });
}

std::optional<double> LostRegion::percent() const {
  return percentOf(lost_);
}

void FirstPlaceRegion::add(const MoverFrame& frame) {
  const cv::Size size = frame.input.size();
  if (mover_.empty()) {
    input_ = frame.input.clone();
    painted_ = smoothed(frame.output);
    mover_ = frame.zones.within.clone();
    coveredAt_.assign(static_cast<std::size_t>(size.area()), frame.time);
  }
  if (cv::countNonZero(mover_) == 0) return;
  const cv::Mat3b output = smoothed(frame.output);
  const cv::Mat3b input = smoothed(frame.input);
  forEachInner(size, [&](cv::Point at) {
    if (mover_(at) == 0) return;
    hal::TimePoint& coveredAt = coveredAt_[static_cast<std::size_t>(at.y * size.width + at.x)];
    if (frame.zones.close(at) != 0) coveredAt = frame.time;
    if (frame.time - coveredAt < kReturn) return;
    if (largestDifference(frame.input(at), input_(at)) <= kContrastLevels) return;
    const bool remains =
        squaredDistance(output(at), painted_(at)) < squaredDistance(output(at), input(at));
    remains_ += {remains ? 1.0 : 0.0, 1.0};
  });
}

std::optional<double> FirstPlaceRegion::percent() const {
  return percentOf(remains_);
}

}  // namespace pleinair::measure
