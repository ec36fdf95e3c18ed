#include "pipeline/measure/input/kitti_flow.h"

#include <cassert>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "hal/media/picture_file.h"

namespace pleinair::measure {
namespace {

/// Difference of flow between neighbouring pixels above which one object occludes another.
constexpr float kBoundaryStepPixels = 0.5F;
constexpr std::size_t kKeptFields = 12;

hal::Error wrongSize(const std::filesystem::path& path, hal::FrameSize found, cv::Size expected) {
  return {.kind = hal::ErrorKind::kInvalidInput,
          .subject = path.string(),
          .problem = fmt::format("has {}x{} px, its frames {}x{}", found.width, found.height,
                                 expected.width, expected.height),
          .remedy = "give flow and masks of the frames' own size"};
}

/// `first` followed by `second`.
MotionMap composed(const MotionMap& first, const MotionMap& second) {
  const cv::Size size = first.valid.size();
  MotionMap map{
      .shift = {}, .displacement = cv::Mat2f(size, cv::Vec2f()), .valid = cv::Mat1b(size, 0)};
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (first.valid(y, x) == 0) continue;
      const cv::Vec2f& by = first.displacement(y, x);
      const auto further =
          displacementAt(second, {static_cast<float>(x) + by[0], static_cast<float>(y) + by[1]});
      if (!further) continue;
      map.displacement(y, x) = by + cv::Vec2f(further->x, further->y);
      map.valid(y, x) = 255;
    }
  }
  return map;
}

class FlowSequence final : public TrueMotion {
 public:
  FlowSequence(cv::Size frame, std::vector<std::filesystem::path> flows,
               std::vector<std::filesystem::path> occlusions)
      : frame_(frame), flows_(std::move(flows)), occlusions_(std::move(occlusions)) {
    assert(occlusions_.empty() || occlusions_.size() == flows_.size());
  }

  MotionKind kind() const override { return MotionKind::kOther; }
  std::string description() const override {
    return fmt::format("flow of {} files{}", flows_.size(),
                       occlusions_.empty() ? "" : ", with masks of what is hidden");
  }

  hal::Result<MotionMap> between(std::uint64_t from, std::uint64_t to) override {
    std::optional<MotionMap> map;
    for (std::uint64_t frame = from; frame < to; ++frame) {
      const hal::Result<const MotionMap*> step = stepFrom(frame);
      if (!step) return tl::unexpected(step.error());
      map = map ? composed(*map, **step) : **step;
    }
    return std::move(*map);
  }

 private:
  hal::Result<const MotionMap*> stepFrom(std::uint64_t frame) {
    if (const auto kept = steps_.find(frame); kept != steps_.end()) return &kept->second;
    hal::Result<KittiFlowField> field = readKittiFlow(flows_.at(frame), frame_);
    if (!field) return tl::unexpected(field.error());
    if (!occlusions_.empty()) {
      if (auto masked = maskOut(*field, occlusions_.at(frame)); !masked) {
        return tl::unexpected(masked.error());
      }
    }
    if (steps_.size() >= kKeptFields) steps_.erase(steps_.begin());
    return &steps_.emplace(frame, fieldMap(field->px, field->seen, kBoundaryStepPixels))
                .first->second;
  }

  cv::Size frame_;
  std::vector<std::filesystem::path> flows_, occlusions_;
  std::map<std::uint64_t, MotionMap> steps_;  ///< the latest, by their first frame
};

}  // namespace

hal::Result<KittiFlowField> readKittiFlow(const std::filesystem::path& path, cv::Size size) {
  const hal::Result<hal::Rgb16Image> picture = hal::readRgb16(path);
  if (!picture) return tl::unexpected(picture.error());
  if (picture->size != hal::FrameSize{size.width, size.height}) {
    return tl::unexpected(wrongSize(path, picture->size, size));
  }
  constexpr float kZero = 32768.0F;
  constexpr float kStepsPerPixel = 64.0F;
  KittiFlowField field{.px = cv::Mat2f(size, cv::Vec2f()), .seen = cv::Mat1b(size, 0)};
  std::span<const std::uint16_t> samples = picture->rgb;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x, samples = samples.subspan(3)) {
      if (samples[2] == 0) continue;
      field.px(y, x) = {(static_cast<float>(samples[0]) - kZero) / kStepsPerPixel,
                        (static_cast<float>(samples[1]) - kZero) / kStepsPerPixel};
      field.seen(y, x) = 255;
    }
  }
  if (cv::countNonZero(field.seen) == 0) {
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kInvalidInput,
                                     .subject = path.string(),
                                     .problem = "holds no valid flow: its blue channel is all 0",
                                     .remedy = "give flow as KITTI stores it"});
  }
  return field;
}

hal::Result<void> maskOut(KittiFlowField& field, const std::filesystem::path& occlusions) {
  const hal::Result<hal::Image> mask = hal::readPictureRgb(occlusions);
  if (!mask) return tl::unexpected(mask.error());
  const cv::Size size = field.seen.size();
  if (mask->size() != hal::FrameSize{size.width, size.height}) {
    return tl::unexpected(wrongSize(occlusions, mask->size(), size));
  }
  const hal::ImageView view = mask->view();
  for (int y = 0; y < size.height; ++y) {
    const std::span<const std::uint8_t> row = view.row(0, y);
    for (int x = 0; x < size.width; ++x) {
      if (row[3 * static_cast<std::size_t>(x)] != 0) field.seen(y, x) = 0;
    }
  }
  return {};
}

std::unique_ptr<TrueMotion> flowSequence(cv::Size frame, std::vector<std::filesystem::path> flows,
                                         std::vector<std::filesystem::path> occlusions) {
  return std::make_unique<FlowSequence>(frame, std::move(flows), std::move(occlusions));
}

}  // namespace pleinair::measure
