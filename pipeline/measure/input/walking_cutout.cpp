#include "pipeline/measure/input/walking_cutout.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include <opencv2/imgproc.hpp>

namespace pleinair::measure {
namespace {

constexpr double kShareOfHeight = 0.8;
constexpr double kShareBelow = 0.05;  // of its height, beneath the frame's edge
constexpr double kSwayDegrees = 2.5;
constexpr double kBobShare = 0.01;     // of its height
constexpr double kStepsPerSecond = 2;  // two make a sway
constexpr double kSamples = 2;         // of the cutout, per px of a frame along a side
constexpr hal::Duration kBefore = std::chrono::seconds(1);
constexpr hal::Duration kAfter = std::chrono::milliseconds(1200);
constexpr float kOpaque = 0.5F;
/// Between neighbouring pixels of the motion from one frame to another: its sway stays below.
constexpr float kBoundaryStepPixels = 1.0F;

cv::Mat4b levelsOf(const hal::Image& rgba8) {
  assert(rgba8.view().format.pixelFormat == hal::PixelFormat::kRgba8);
  const hal::FrameSize size = rgba8.size();
  cv::Mat4b levels(size.height, size.width);
  for (int y = 0; y < size.height; ++y) {
    const auto row = rgba8.view().row(0, y);
    std::copy_n(row.data(), 4 * static_cast<std::size_t>(size.width), levels.ptr(y));
  }
  return levels;
}

cv::Rect seenPart(const cv::Mat4b& levels) {
  cv::Mat1b alpha;
  cv::extractChannel(levels, alpha, 3);
  return cv::boundingRect(alpha > 255 * kOpaque);
}

cv::Mat4f premultiplied(const cv::Mat4b& levels) {
  cv::Mat4f result;
  levels.convertTo(result, CV_32F, 1.0 / 255.0);
  for (cv::Vec4f& pixel : result) {
    for (int c = 0; c < 3; ++c) pixel[c] *= pixel[3];
  }
  return result;
}

class WalkerMotion final : public TrueMotion {
 public:
  WalkerMotion(const WalkingCutout& walker, cv::Size frame, hal::Duration period)
      : walker_(walker), frame_(frame), period_(period) {}

  MotionKind kind() const override { return MotionKind::kOther; }
  std::string description() const override { return "the walker's own; all else stands"; }

  hal::Result<MotionMap> between(std::uint64_t from, std::uint64_t to) override {
    const hal::Duration earlier = period_ * static_cast<std::int64_t>(from);
    const hal::Duration later = period_ * static_cast<std::int64_t>(to);
    const cv::Mat1b before = walker_.mask(earlier);
    const cv::Mat1b after = walker_.mask(later);
    const cv::Matx33d moved = walker_.displacement(earlier, later);
    cv::Mat2f displacement(frame_, cv::Vec2f(0.0F, 0.0F));
    cv::Mat1b seen(frame_, 255);
    for (int y = 0; y < frame_.height; ++y) {
      for (int x = 0; x < frame_.width; ++x) {
        if (before(y, x) == 0) {
          seen(y, x) = after(y, x) == 0 ? 255 : 0;
          continue;
        }
        const cv::Vec3d at = moved * cv::Vec3d(x, y, 1);
        displacement(y, x) = {static_cast<float>(at[0] - x), static_cast<float>(at[1] - y)};
      }
    }
    return fieldMap(std::move(displacement), seen, kBoundaryStepPixels);
  }

 private:
  const WalkingCutout& walker_;
  cv::Size frame_;
  hal::Duration period_;
};

class WalkerMovers final : public TrueMovers {
 public:
  WalkerMovers(const WalkingCutout& walker, hal::Duration period)
      : walker_(walker), period_(period) {}

  cv::Mat1b mask(std::uint64_t frame) override {
    return walker_.mask(period_ * static_cast<std::int64_t>(frame));
  }

 private:
  const WalkingCutout& walker_;
  hal::Duration period_;
};

}  // namespace

bool WalkingCutout::isSeen(const hal::Image& rgba8) {
  return !seenPart(levelsOf(rgba8)).empty();
}

WalkingCutout::WalkingCutout(const hal::Image& rgba8, hal::FrameSize frame, double pixelsPerSecond)
    : frame_(frame.width, frame.height), pixelsPerSecond_(pixelsPerSecond) {
  const cv::Mat4b levels = levelsOf(rgba8);
  const cv::Rect seen = seenPart(levels);
  assert(!seen.empty() && pixelsPerSecond > 0);
  cutout_ = premultiplied(levels(seen));
  const double height = kShareOfHeight * frame.height / (1 - kShareBelow);
  const double shrink = kSamples * height / cutout_.rows;
  if (shrink < 1) cv::resize(cutout_.clone(), cutout_, {}, shrink, shrink, cv::INTER_AREA);
  scale_ = height / cutout_.rows;
}

cv::Matx33d WalkingCutout::frameFromCutout(hal::Duration at) const {
  const double seconds = hal::toSeconds(at);
  const double width = scale_ * cutout_.cols;
  const double height = scale_ * cutout_.rows;
  const double x = pixelsPerSecond_ * (seconds - hal::toSeconds(kBefore)) - width / 2;
  const double phase = std::numbers::pi * kStepsPerSecond * seconds;
  const double bob = kBobShare * height * std::pow(std::sin(phase), 2);
  const double angle = kSwayDegrees / 180 * std::numbers::pi * std::sin(phase);
  const double c = scale_ * std::cos(angle);
  const double s = scale_ * std::sin(angle);
  const double footX = (cutout_.cols - 1) / 2.0;
  const double footY = cutout_.rows - 1;
  const double y = frame_.height + kShareBelow * height + bob;
  return {c, -s, x - c * footX + s * footY, s, c, y - s * footX - c * footY, 0, 0, 1};
}

cv::Mat4f WalkingCutout::drawn(hal::Duration at) const {
  // Drawn at twice the size, of which each pixel is the mean of four.
  constexpr int kFiner = 2;
  const cv::Matx33d finer(kFiner, 0, 0.5, 0, kFiner, 0.5, 0, 0, 1);
  const cv::Matx33d to = finer * frameFromCutout(at);
  cv::Mat4f large(frame_ * kFiner, cv::Vec4f());
  cv::warpAffine(cutout_, large, to.get_minor<2, 3>(0, 0), large.size(), cv::INTER_CUBIC,
                 cv::BORDER_CONSTANT);
  cv::Mat4f small;
  cv::resize(large, small, frame_, 0, 0, cv::INTER_AREA);
  return small;
}

void WalkingCutout::drawInto(cv::Mat3f& picture, hal::Duration at) const {
  const cv::Mat4f walker = drawn(at);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const cv::Vec4f& over = walker(y, x);
      const float alpha = std::clamp(over[3], 0.0F, 1.0F);
      cv::Vec3f& pixel = picture(y, x);
      pixel = pixel * (1 - alpha) + cv::Vec3f(over[0], over[1], over[2]);
    }
  }
}

cv::Mat1b WalkingCutout::mask(hal::Duration at) const {
  cv::Mat1f alpha;
  cv::extractChannel(drawn(at), alpha, 3);
  return cv::Mat1b(alpha > kOpaque);
}

cv::Matx33d WalkingCutout::displacement(hal::Duration from, hal::Duration to) const {
  return frameFromCutout(to) * frameFromCutout(from).inv();
}

hal::Duration WalkingCutout::duration() const {
  // Swaying, it reaches a little farther than half of its width.
  const double reach = scale_ * std::hypot(cutout_.cols, cutout_.rows / 10.0);
  return kBefore + kAfter + hal::fromSeconds((frame_.width + reach) / pixelsPerSecond_);
}

std::unique_ptr<TrueMotion> walkerMotion(const WalkingCutout& walker, cv::Size frame,
                                         hal::Duration period) {
  return std::make_unique<WalkerMotion>(walker, frame, period);
}

std::unique_ptr<TrueMovers> walkerMovers(const WalkingCutout& walker, hal::Duration period) {
  return std::make_unique<WalkerMovers>(walker, period);
}

}  // namespace pleinair::measure
