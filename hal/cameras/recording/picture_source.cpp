#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "hal/cameras/recording/frame_source.h"
#include "hal/media/picture_decoder.h"

namespace pleinair::hal::recording {
namespace {

class PictureSource final : public FrameSource {
 public:
  PictureSource(std::vector<std::filesystem::path> paths, std::optional<Duration> period,
                const RecordingOptions& options)
      : paths_(std::move(paths)), period_(period), onSkipped_(options.onSkipped) {
    if (!period_) return;
    length_ = *period_ * static_cast<std::int64_t>(paths_.size());
    // The pictures whose times are in the part, counted in whole periods.
    const auto countBefore = [&](Duration time) {
      const auto count = std::max<std::int64_t>((time + *period_ - Duration(1)) / *period_, 0);
      return std::min(static_cast<std::size_t>(count), paths_.size());
    };
    if (options.to) paths_.resize(countBefore(*options.to));
    next_ = countBefore(options.from);
    first_ = next_;
  }

  std::optional<Duration> framePeriod() const override { return period_; }
  std::optional<std::uint64_t> frameCount() const override { return paths_.size() - first_; }
  std::optional<Duration> length() const override { return length_; }

  SourceItem next() override {
    std::optional<Error> lastBroken;
    for (std::uint64_t dropped = 0; next_ < paths_.size(); ++dropped) {
      const std::size_t index = next_++;
      auto frame = libav::decodePicture(paths_[index]);
      if (frame) {
        return SourceFrame{.frame = *std::move(frame),
                           .time = period_.value_or(Duration{}) * index,
                           .droppedBefore = dropped};
      }
      if (frame.error().kind != ErrorKind::kInvalidInput) return frame.error();
      lastBroken = frame.error();
      if (period_ && onSkipped_) onSkipped_(*lastBroken);
    }
    return SourceEnd{.truncated = lastBroken};
  }

 private:
  std::vector<std::filesystem::path> paths_;
  std::optional<Duration> period_;
  std::optional<Duration> length_;
  std::function<void(const Error&)> onSkipped_;
  std::size_t next_ = 0;
  std::size_t first_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> openPictures(std::vector<std::filesystem::path> paths,
                                          std::optional<Duration> period,
                                          const RecordingOptions& options) {
  return std::make_unique<PictureSource>(std::move(paths), period, options);
}

}  // namespace pleinair::hal::recording
