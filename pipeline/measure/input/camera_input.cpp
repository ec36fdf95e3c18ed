#include <utility>
#include <variant>

#include <fmt/format.h>

#include "hal/cameras/recording/recording.h"
#include "pipeline/measure/input/measured_input.h"
#include "pipeline/measure/input/motion_file.h"
#include "pipeline/measure/input/workbench_motion.h"

namespace pleinair::measure {
namespace {

/// A started camera that is stepped.
class CameraInput final : public MeasuredInput {
 public:
  CameraInput(std::string description, std::unique_ptr<hal::SteppedClock> clock,
              std::unique_ptr<hal::Camera> camera, hal::StreamFormat stream)
      : description_(std::move(description)),
        clock_(std::move(clock)),
        camera_(std::move(camera)),
        stream_(stream) {}

  /// Call before the first frame.
  void setMotion(std::unique_ptr<TrueMotion> motion) { motion_ = std::move(motion); }
  void setMovers(std::unique_ptr<TrueMovers> movers) { movers_ = std::move(movers); }
  /// Call before the first frame; the motion is unknown beyond `count` frames.
  void setMaxFrames(std::uint64_t count) { maxFrames_ = count; }
  void setEndless() { isEndless_ = true; }
  void addNotice(std::string notice) { notices_.push_back(std::move(notice)); }

  std::string description() const override { return description_; }
  hal::FrameFormat format() const override { return stream_.frame; }
  std::optional<std::uint64_t> frameCount() const override { return stream_.frameCount; }
  bool isEndless() const override { return isEndless_; }
  TrueMotion* motion() override { return motion_.get(); }
  TrueMovers* movers() override { return movers_.get(); }
  std::vector<std::string> notices() const override { return notices_; }

  hal::Result<std::optional<hal::CapturedFrame>> next() override {
    for (;;) {
      hal::NextFrame next = camera_->next(hal::kNoDeadline);
      if (auto* frame = std::get_if<hal::CapturedFrame>(&next)) return accepted(std::move(*frame));
      if (const auto* end = std::get_if<hal::EndOfStream>(&next)) {
        if (end->truncated) addNotice("the recording is truncated: " + end->truncated->message());
        return std::nullopt;
      }
      if (auto* lost = std::get_if<hal::CameraLost>(&next)) return tl::unexpected(lost->cause);
      if (auto* error = std::get_if<hal::Error>(&next)) return tl::unexpected(*error);
    }
  }

 private:
  hal::Result<std::optional<hal::CapturedFrame>> accepted(hal::CapturedFrame frame) {
    if (frame.image.format.size != stream_.frame.size) {
      return tl::unexpected(failure("its frames change their size", "cut it where they do"));
    }
    if (motion_ && frame.droppedBefore > 0) {
      return tl::unexpected(
          failure("frames of it are missing or broken, so that its motion file "
                  "does not fit",
                  "fix it, or leave out --motion"));
    }
    if (maxFrames_ && accepted_ == *maxFrames_) {
      return tl::unexpected(failure(
          fmt::format("goes on beyond the {} frames that its motion file is for", accepted_),
          "give a homography for each step, or fewer --frames"));
    }
    ++accepted_;
    return frame;
  }
  hal::Error failure(std::string problem, std::string remedy) const {
    return {.kind = hal::ErrorKind::kInvalidInput,
            .subject = description_,
            .problem = std::move(problem),
            .remedy = std::move(remedy)};
  }

  std::string description_;
  std::unique_ptr<hal::SteppedClock> clock_;
  std::unique_ptr<hal::Camera> camera_;
  hal::StreamFormat stream_;
  std::unique_ptr<TrueMotion> motion_;
  std::unique_ptr<TrueMovers> movers_;
  std::vector<std::string> notices_;
  bool isEndless_ = false;
  std::optional<std::uint64_t> maxFrames_;
  std::uint64_t accepted_ = 0;
};

}  // namespace

hal::Result<std::unique_ptr<MeasuredInput>> openPlainRecording(
    const std::filesystem::path& path, const std::optional<std::filesystem::path>& motionFile) {
  auto clock = std::make_unique<hal::SteppedClock>();
  std::unique_ptr<hal::Camera> camera = hal::openRecording(path, *clock);
  const hal::Result<hal::StreamFormat> stream = camera->start({});
  if (!stream) return tl::unexpected(stream.error());
  auto input =
      std::make_unique<CameraInput>(path.string(), std::move(clock), std::move(camera), *stream);
  if (motionFile) {
    const hal::Result<MotionFile> file = readMotion(*motionFile);
    if (!file) return tl::unexpected(file.error());
    const hal::FrameSize size = stream->frame.size;
    auto motion = motionOf(*file, {size.width, size.height}, stream->frameCount.value_or(1),
                           motionFile->string());
    if (!motion) return tl::unexpected(motion.error());
    input->setMotion(std::move(*motion));
    // The length that a movie reports, if any, may be wrong.
    if (!file->perFrame) input->setMaxFrames(file->nextFromFrame.size() + 1);
  }
  return input;
}

hal::Result<std::unique_ptr<MeasuredInput>> openWorkbench(const hal::SyntheticOptions& options) {
  auto clock = std::make_unique<hal::SteppedClock>();
  auto camera = std::make_unique<hal::SyntheticCamera>(options, *clock);
  const hal::Result<hal::StreamFormat> stream = camera->start({});
  if (!stream) return tl::unexpected(stream.error());
  auto input = std::make_unique<CameraInput>(
      fmt::format("the workbench, shot \"{}\"", hal::toString(options.shot)), std::move(clock),
      std::move(camera), *stream);
  input->setMotion(workbenchMotion(options));
  input->setMovers(workbenchMovers(options));
  input->setEndless();
  return input;
}

}  // namespace pleinair::measure
