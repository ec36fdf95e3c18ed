#include <utility>

#include <fmt/format.h>

#include "hal/libav/picture_file.h"
#include "pipeline/measure/measured_input.h"
#include "pipeline/measure/sensor_noise.h"

namespace pleinair::measure {
namespace {

constexpr hal::Duration kFramePeriod{33'333'333};

class PhotographInput final : public MeasuredInput {
 public:
  PhotographInput(const std::filesystem::path& path, const hal::Image& photograph,
                  const PhotographOptions& options)
      : description_(path.string()),
        options_(options),
        moved_(photograph, options.size, options.motion, options.frames),
        motion_(moved_.motion()) {}

  std::string description() const override { return description_; }
  hal::FrameFormat format() const override {
    return {.pixelFormat = hal::PixelFormat::kRgb8, .size = options_.size, .encoding = {}};
  }
  std::optional<std::uint64_t> frameCount() const override { return options_.frames; }
  bool isEndless() const override { return true; }
  TrueMotion* motion() override { return motion_.get(); }

  hal::Result<std::optional<hal::CapturedFrame>> next() override {
    if (next_ == options_.frames) return std::nullopt;
    const auto image = std::make_shared<const hal::Image>(
        withSensorNoise(moved_.frame(next_), options_.noiseLevels, next_));
    const hal::TimePoint time{kFramePeriod * static_cast<std::int64_t>(next_)};
    return hal::CapturedFrame{.image = image->view(),
                              .sequence = next_++,
                              .captureTime = time,
                              .timestampSource = hal::TimestampSource::kSimulated,
                              .lease = image};
  }

  std::vector<std::string> notices() const override {
    if (!moved_.isMirrored()) return {};
    return {
        "the photograph is smaller than the way of the frames over it: it goes on mirrored "
        "beyond its edges"};
  }

 private:
  std::string description_;
  PhotographOptions options_;
  MovedPhotograph moved_;
  std::unique_ptr<TrueMotion> motion_;
  std::uint64_t next_ = 0;
};

}  // namespace

hal::Result<std::unique_ptr<MeasuredInput>> openPhotograph(const std::filesystem::path& path,
                                                           const PhotographOptions& options) {
  const hal::Result<hal::Image> photograph = hal::readPictureRgb(path);
  if (!photograph) return tl::unexpected(photograph.error());
  return std::make_unique<PhotographInput>(path, *photograph, options);
}

}  // namespace pleinair::measure
