#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "hal/cameras/recording/frame_source.h"
#include "hal/cameras/recording/recording.h"
#include "hal/cameras/recording/timeline.h"
#include "hal/captures/stored_pixels.h"
#include "hal/image.h"
#include "hal/media/frame_pixels.h"
#include "hal/paced_frame.h"

namespace pleinair::hal {
namespace {

using recording::FrameSource;
using recording::SourceEnd;
using recording::SourceFrame;
using recording::SourceItem;
using recording::Timeline;

/// More frames than a camera makes in a year are no loss, but a damaged recording.
constexpr std::uint64_t kMostDropped = 10'000'000'000;

class RecordingCamera final : public Camera {
 public:
  RecordingCamera(std::filesystem::path path, Clock& clock, RecordingOptions options)
      : path_(std::move(path)),
        clock_(clock),
        options_(std::move(options)),
        timeline_(Duration{}) {}

  CameraIdentity identity() const override {
    const std::string what = capturedFrom_.empty() ? "" : " of " + capturedFrom_;
    return {.backend = "recording",
            .id = path_.string(),
            .description = "recording " + path_.string() + what};
  }

  Result<StreamFormat> start(const StreamRequest& request) override;
  NextFrame next(TimePoint deadline) override;
  void stop() override;

 private:
  Result<void> open();
  /// Fills pending_, or ending_ if there is no further frame.
  void fetch();
  void endWith(NextFrame ending) { ending_ = std::move(ending); }
  void handleEnd(const SourceEnd& end);
  Result<libav::LentPicture> pictureOf(const SourceFrame& item) const;
  void accept(const SourceFrame& item);
  Error named(Error error) const;

  std::filesystem::path path_;
  Clock& clock_;
  RecordingOptions options_;

  std::unique_ptr<FrameSource> source_;
  std::string capturedFrom_;  ///< the camera, in a captured stream
  StreamFormat format_;
  Timeline timeline_;
  TimePoint startTime_;
  std::optional<CapturedFrame> pending_;
  std::optional<NextFrame> ending_;
  std::uint64_t nextSequence_ = 0;
  bool anyFrameInThisPass_ = false;
};

Error RecordingCamera::named(Error error) const {
  if (error.subject.empty()) error.subject = path_.string();
  return error;
}

Result<void> RecordingCamera::open() {
  auto source = recording::openSource(path_, options_);
  if (!source) return tl::unexpected(source.error());
  source_ = *std::move(source);
  capturedFrom_ = source_->capturedFrom();
  anyFrameInThisPass_ = false;
  return {};
}

Result<StreamFormat> RecordingCamera::start(const StreamRequest&) {
  stop();
  if (Result<void> opened = open(); !opened) return tl::unexpected(opened.error());
  timeline_ = Timeline(source_->framePeriod().value_or(options_.picturePeriod));
  startTime_ = clock_.now();
  nextSequence_ = 0;
  fetch();
  if (!pending_) {
    Error error{.kind = ErrorKind::kInvalidInput,
                .problem = "has no valid frame",
                .remedy = "give another recording"};
    if (options_.from > Duration::zero() || options_.to) {
      error.problem = "has no valid frame in the part that was asked for";
      error.remedy = "give another --from and --to: its time begins at 0";
      if (const auto length = source_->length()) {
        error.remedy += fmt::format(" and ends at {:.6g} s", toSeconds(*length));
      }
    }
    if (const auto* end = std::get_if<EndOfStream>(&*ending_); end && end->truncated) {
      error = *end->truncated;
    } else if (const auto* failure = std::get_if<Error>(&*ending_)) {
      error = *failure;
    }
    stop();
    return tl::unexpected(named(std::move(error)));
  }
  format_ = {.frame = pending_->image.format,
             .framePeriod = source_->framePeriod(),
             .frameCount = options_.loop ? std::nullopt : source_->frameCount()};
  return format_;
}

void RecordingCamera::stop() {
  pending_.reset();
  ending_.reset();
  source_.reset();
}

Result<libav::LentPicture> RecordingCamera::pictureOf(const SourceFrame& item) const {
  if (const auto layout = source_->capturedLayout()) {
    if (std::optional<Image> image = captures::restored(*item.frame, *layout)) {
      const auto shared = std::make_shared<const Image>(*std::move(image));
      return libav::LentPicture{.view = shared->view(), .lease = shared};
    }
  }
  return libav::lendPicture(item.frame);
}

void RecordingCamera::accept(const SourceFrame& item) {
  Result<libav::LentPicture> picture = pictureOf(item);
  if (!picture) return endWith(named(picture.error()));
  const captures::FrameFacts facts = item.facts.value_or(captures::FrameFacts{});
  // What the camera lost, and what the recording has lost since.
  const std::uint64_t dropped = std::min(facts.droppedBefore, kMostDropped) + item.droppedBefore;
  nextSequence_ += dropped;
  pending_ =
      CapturedFrame{.image = picture->view,
                    .dmaBufs = {},
                    .sequence = nextSequence_++,
                    .droppedBefore = dropped,
                    .underrunsBefore = std::min(facts.underrunsBefore, dropped),
                    .linkBefore = facts.linkBefore,
                    .captureTime = startTime_ + timeline_.place(item.time, item.droppedBefore),
                    .timestampSource = TimestampSource::kRecording,
                    .deviceTime = facts.deviceTime,
                    .health = facts.health,
                    .lease = std::move(picture->lease)};
  anyFrameInThisPass_ = true;
}

void RecordingCamera::handleEnd(const SourceEnd& end) {
  if (!options_.loop || !anyFrameInThisPass_) {
    std::optional<Error> truncated = end.truncated;
    if (truncated) truncated = named(*std::move(truncated));
    return endWith(EndOfStream{.truncated = std::move(truncated)});
  }
  timeline_.startOver();
  if (Result<void> opened = open(); !opened) endWith(named(opened.error()));
}

void RecordingCamera::fetch() {
  while (!pending_ && !ending_) {
    SourceItem item = source_->next();
    if (const auto* frame = std::get_if<SourceFrame>(&item)) {
      accept(*frame);
    } else if (const auto* end = std::get_if<SourceEnd>(&item)) {
      handleEnd(*end);
    } else {
      endWith(named(std::get<Error>(std::move(item))));
    }
  }
}

NextFrame RecordingCamera::next(TimePoint deadline) {
  if (!pending_) fetch();
  if (!pending_) return *ending_;
  if (pending_->image.format != format_.frame) {
    format_.frame = pending_->image.format;
    return FormatChanged{.format = format_};
  }
  return takePaced(pending_, options_.pacing, clock_, deadline);
}

}  // namespace

std::unique_ptr<Camera> openRecording(std::filesystem::path path, Clock& clock,
                                      RecordingOptions options) {
  return std::make_unique<RecordingCamera>(std::move(path), clock, std::move(options));
}

}  // namespace pleinair::hal
