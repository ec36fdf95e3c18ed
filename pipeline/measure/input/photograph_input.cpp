#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "hal/media/picture_file.h"
#include "pipeline/measure/input/measured_input.h"
#include "pipeline/measure/input/picture.h"
#include "pipeline/measure/input/walking_cutout.h"

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

  /// Call before the first frame. `cutout`: as WalkingCutout's.
  void setWalker(const hal::Image& cutout) {
    const cv::Size frame(size_.width, size_.height);
    walker_.emplace(cutout, size_, options_.walker->pixelsPerSecond);
    motion_ = walkerMotion(*walker_, frame, options_.period);
    movers_ = walkerMovers(*walker_, options_.period);
    ground_ = moved_.frame(0);
    options_.frames = static_cast<std::uint64_t>(walker_->duration() / options_.period) + 1;
    description_ += fmt::format(", past which {} walks", options_.walker->cutout.string());
  }

  std::string description() const override { return description_; }
  hal::FrameFormat format() const override {
    return {.pixelFormat = hal::PixelFormat::kRgb8, .size = size_, .encoding = {}};
  }
  std::optional<std::uint64_t> frameCount() const override { return options_.frames; }
  bool isEndless() const override { return !walker_; }
  TrueMotion* motion() override { return motion_.get(); }
  TrueMovers* movers() override { return movers_.get(); }

  hal::Result<std::optional<hal::CapturedFrame>> next() override {
    if (next_ == options_.frames) return std::nullopt;
    const hal::TimePoint time{options_.period * static_cast<std::int64_t>(next_)};
    const auto image = std::make_shared<const hal::Image>(
        withSensorNoise(seenAt(time.time_since_epoch()), options_.noiseLevels, next_));
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
  cv::Mat3f seenAt(hal::Duration time) const {
    if (!walker_) return moved_.frame(next_);
    cv::Mat3f picture = ground_.clone();
    walker_->drawInto(picture, time);
    return picture;
  }

  std::string description_;
  PhotographOptions options_;
  hal::FrameSize own_, size_;
  MovedPhotograph moved_;
  std::optional<WalkingCutout> walker_;
  cv::Mat3f ground_;  ///< behind the walker
  std::unique_ptr<TrueMotion> motion_;
  std::unique_ptr<TrueMovers> movers_;
  std::uint64_t next_ = 0;
};

}  // namespace

hal::Result<std::unique_ptr<MeasuredInput>> openPhotograph(const std::filesystem::path& path,
                                                           const PhotographOptions& options) {
  const hal::Result<hal::Image> photograph = hal::readPictureRgb(path);
  if (!photograph) return tl::unexpected(photograph.error());
  auto input = std::make_unique<PhotographInput>(path, *photograph, options);
  if (!options.walker) return input;
  const std::filesystem::path& cutout = options.walker->cutout;
  const hal::Result<hal::Image> walker = hal::readPictureRgba(cutout);
  if (!walker) return tl::unexpected(walker.error());
  if (!WalkingCutout::isSeen(*walker)) {
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kInvalidInput,
                                     .subject = cutout.string(),
                                     .problem = "is transparent all over",
                                     .remedy = "give a picture of which something is opaque"});
  }
  input->setWalker(*walker);
  return input;
}

}  // namespace pleinair::measure
