#include "pipeline/measure/input/workbench_motion.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace pleinair::measure {
namespace {

/// Between neighbouring pixels, for each frame between the two; perspective alone stays below it.
constexpr float kBoundaryStepPixelsPerFrame = 0.05F;
constexpr float kMinBoundaryPixels = 0.15F;

/// Rays are followed from every other pixel. Between them flow is linear, or discontinuous and then
/// invalid.
constexpr int kEveryNth = 2;

/// The nodes of a field around a pixel.
class Nodes {
 public:
  Nodes(hal::FrameSize field, int x, int y) {
    const int left = x / kEveryNth;
    const int top = y / kEveryNth;
    const int right = std::min(left + x % kEveryNth, field.width - 1);
    const int bottom = std::min(top + y % kEveryNth, field.height - 1);
    isWithin_ = left + x % kEveryNth == right && top + y % kEveryNth == bottom;
    const auto index = [&field](int column, int row) {
      return static_cast<std::size_t>(row * field.width + column);
    };
    nodes_ = {index(left, top), index(right, top), index(left, bottom), index(right, bottom)};
  }
  cv::Vec2f meanOf(const std::vector<glm::vec2>& px) const {
    glm::vec2 sum(0.0F);
    for (const std::size_t node : nodes_) sum += px[node];
    return {0.25F * sum.x, 0.25F * sum.y};
  }
  bool areAllIn(const std::vector<std::uint8_t>& visible) const {
    return isWithin_ &&
           std::ranges::all_of(nodes_, [&](std::size_t node) { return visible[node] != 0; });
  }

 private:
  std::array<std::size_t, 4> nodes_{};
  bool isWithin_ = false;  ///< the last column and row lie beyond the nodes
};

class WorkbenchMotion final : public TrueMotion {
 public:
  explicit WorkbenchMotion(const hal::SyntheticOptions& options)
      : options_(options), camera_(options, clock_) {}

  MotionKind kind() const override { return MotionKind::kOther; }
  std::string description() const override {
    return fmt::format("flow from the geometry of shot \"{}\"", hal::toString(options_.shot));
  }

  hal::Result<MotionMap> between(std::uint64_t from, std::uint64_t to) override {
    const hal::FlowField field = camera_.flowField(from, to, kEveryNth);
    const cv::Size size(options_.size.width, options_.size.height);
    cv::Mat2f displacement(size);
    cv::Mat1b seen(size);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const Nodes nodes(field.size, x, y);
        displacement(y, x) = nodes.meanOf(field.px);
        seen(y, x) = nodes.areAllIn(field.visible) ? 255 : 0;
      }
    }
    const float leap =
        std::max(kMinBoundaryPixels, kBoundaryStepPixelsPerFrame * static_cast<float>(to - from));
    return fieldMap(std::move(displacement), seen, leap);
  }

 private:
  hal::SyntheticOptions options_;
  hal::SteppedClock clock_;
  hal::SyntheticCamera camera_;
};

class WorkbenchMovers final : public TrueMovers {
 public:
  explicit WorkbenchMovers(const hal::SyntheticOptions& options) : camera_(options, clock_) {}

  cv::Mat1b mask(std::uint64_t frame) override {
    hal::MovingMask mask = camera_.movingMask(frame);
    return cv::Mat1b(mask.size.height, mask.size.width, mask.bytes.data()).clone();
  }

 private:
  hal::SteppedClock clock_;
  hal::SyntheticCamera camera_;
};

}  // namespace

std::unique_ptr<TrueMotion> workbenchMotion(const hal::SyntheticOptions& options) {
  return std::make_unique<WorkbenchMotion>(options);
}

std::unique_ptr<TrueMovers> workbenchMovers(const hal::SyntheticOptions& options) {
  return std::make_unique<WorkbenchMovers>(options);
}

}  // namespace pleinair::measure
