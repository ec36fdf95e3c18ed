#include "pipeline/measure/workbench_motion.h"

#include <fmt/format.h>

namespace pleinair::measure {
namespace {

/// From a pixel to the next, for each frame between the two: perspective alone stays below.
constexpr float kLeapPixelsPerFrame = 0.1F;
constexpr float kLeastLeapPixels = 0.5F;

class WorkbenchMotion final : public TrueMotion {
 public:
  explicit WorkbenchMotion(const hal::SyntheticOptions& options)
      : options_(options), camera_(options, clock_) {}

  MotionKind kind() const override { return MotionKind::kOther; }
  std::string description() const override {
    return fmt::format("flow from the geometry of shot \"{}\"", hal::toString(options_.shot));
  }

  hal::Result<MotionMap> between(std::uint64_t from, std::uint64_t to) override {
    const hal::FlowField field = camera_.flowField(from, to);
    const cv::Size size(field.size.width, field.size.height);
    cv::Mat2f displacement(size);
    cv::Mat1b seen(size);
    std::size_t i = 0;
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x, ++i) {
        displacement(y, x) = {field.px[i].x, field.px[i].y};
        seen(y, x) = field.visible[i] != 0 ? 255 : 0;
      }
    }
    const float leap =
        std::max(kLeastLeapPixels, kLeapPixelsPerFrame * static_cast<float>(to - from));
    return fieldMap(displacement, seen, leap);
  }

 private:
  hal::SyntheticOptions options_;
  hal::SteppedClock clock_;
  hal::SyntheticCamera camera_;
};

}  // namespace

std::unique_ptr<TrueMotion> workbenchMotion(const hal::SyntheticOptions& options) {
  return std::make_unique<WorkbenchMotion>(options);
}

}  // namespace pleinair::measure
