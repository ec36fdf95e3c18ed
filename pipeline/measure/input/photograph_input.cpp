#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "hal/media/picture_file.h"
#include "pipeline/measure/input/measured_input.h"
#include "pipeline/measure/input/picture.h"

namespace pleinair::measure {
namespace {

/// Larger photographs take longer and give no better measures.
constexpr double kMaxPhotographPixels = 640.0 * 480.0;

hal::FrameSize defaultSize(hal::FrameSize photograph) {
  const double pixels = static_cast<double>(photograph.width) * photograph.height;
  const double scale = std::min(1.0, std::sqrt(kMaxPhotographPixels / pixels));
  const auto scaled = [scale](int side) {
    return std::max(1, static_cast<int>(std::lround(side * scale)));
  };
  return {scaled(photograph.width), scaled(photograph.height)};
}

class PhotographInput final : public MeasuredInput {
 public:
  PhotographInput(const std::filesystem::path& path, const hal::Image& photograph,
                  const PhotographOptions& options)
      : description_(path.string()),
        options_(options),
        own_(photograph.size()),
        size_(options.size.value_or(defaultSize(own_))),
        moved_(photograph, size_, options.motion, options.frames),
        motion_(moved_.motion()) {}

  std::string description() const override { return description_; }
  hal::FrameFormat format() const override {
    return {.pixelFormat = hal::PixelFormat::kRgb8, .size = size_, .encoding = {}};
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
    const bool isSmaller = own_.width < size_.width || own_.height < size_.height;
    return {fmt::format("{}, where it goes on mirrored",
                        isSmaller
                            ? fmt::format("frames of {}x{} reach beyond the photograph of {}x{}",
                                          size_.width, size_.height, own_.width, own_.height)
                            : "the frames' way leads beyond the photograph's edges")};
  }

 private:
  std::string description_;
  PhotographOptions options_;
  hal::FrameSize own_, size_;
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
