#include <utility>

#include "hal/cameras/recording/frame_source.h"
#include "hal/libav/picture_decoder.h"

namespace pleinair::hal::recording {
namespace {

class PictureSource final : public FrameSource {
 public:
  PictureSource(std::vector<std::filesystem::path> paths, std::optional<Duration> period)
      : paths_(std::move(paths)), period_(period) {}

  std::optional<Duration> framePeriod() const override { return period_; }
  std::optional<std::uint64_t> frameCount() const override { return paths_.size(); }

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
    }
    return SourceEnd{.truncated = lastBroken};
  }

 private:
  std::vector<std::filesystem::path> paths_;
  std::optional<Duration> period_;
  std::size_t next_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> openPictures(std::vector<std::filesystem::path> paths,
                                          std::optional<Duration> period) {
  return std::make_unique<PictureSource>(std::move(paths), period);
}

}  // namespace pleinair::hal::recording
