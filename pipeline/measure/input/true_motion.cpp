#include "pipeline/measure/input/true_motion.h"

#include <utility>

#include <fmt/format.h>

namespace pleinair::measure {
namespace {

class ConstantMotion final : public TrueMotion {
 public:
  ConstantMotion(cv::Size frame, cv::Point2d perFrame) : frame_(frame), perFrame_(perFrame) {}

  MotionKind kind() const override {
    return perFrame_ == cv::Point2d() ? MotionKind::kStill : MotionKind::kPan;
  }
  std::string description() const override {
    if (kind() == MotionKind::kStill) return "nothing moves";
    return fmt::format("pan by ({:g}, {:g}) px a frame", perFrame_.x, perFrame_.y);
  }
  hal::Result<MotionMap> between(std::uint64_t from, std::uint64_t to) override {
    return constantMap(frame_, perFrame_ * static_cast<double>(to - from));
  }

 private:
  cv::Size frame_;
  cv::Point2d perFrame_;
};

class HomographyMotion final : public TrueMotion {
 public:
  HomographyMotion(cv::Size frame, std::string description,
                   std::function<cv::Matx33d(std::uint64_t)> frameFromFirst)
      : frame_(frame),
        description_(std::move(description)),
        frameFromFirst_(std::move(frameFromFirst)) {}

  MotionKind kind() const override { return MotionKind::kOther; }
  std::string description() const override { return description_; }

  hal::Result<MotionMap> between(std::uint64_t from, std::uint64_t to) override {
    const cv::Matx33d later = frameFromFirst_(to) * frameFromFirst_(from).inv();
    MotionMap map{.shift = {}, .displacement = cv::Mat2f(frame_), .valid = cv::Mat1b(frame_, 255)};
    for (int y = 0; y < frame_.height; ++y) {
      for (int x = 0; x < frame_.width; ++x) {
        const cv::Vec3d at = later * cv::Vec3d(x, y, 1);
        if (!(at[2] > 0)) {
          map.valid(y, x) = 0;
          continue;
        }
        map.displacement(y, x) = {static_cast<float>(at[0] / at[2] - x),
                                  static_cast<float>(at[1] / at[2] - y)};
      }
    }
    return map;
  }

 private:
  cv::Size frame_;
  std::string description_;
  std::function<cv::Matx33d(std::uint64_t)> frameFromFirst_;
};

}  // namespace

std::unique_ptr<TrueMotion> constantMotion(cv::Size frame, cv::Point2d perFrame) {
  return std::make_unique<ConstantMotion>(frame, perFrame);
}

std::unique_ptr<TrueMotion> homographyMotion(
    cv::Size frame, std::string description,
    std::function<cv::Matx33d(std::uint64_t)> frameFromFirst) {
  return std::make_unique<HomographyMotion>(frame, std::move(description),
                                            std::move(frameFromFirst));
}

}  // namespace pleinair::measure
