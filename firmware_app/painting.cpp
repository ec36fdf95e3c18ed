#include "firmware_app/painting.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "firmware_app/interrupt.h"
#include "firmware_app/poses_file.h"
#include "firmware_app/progress.h"
#include "hal/libav/picture_file.h"
#include "hal/outputs/open_output.h"
#include "pipeline/painter.h"
#include "pipeline/present/contact_sheet.h"

namespace pleinair::app {
namespace {

using hal::Error;
using hal::ErrorKind;
using hal::orThrow;

constexpr int kSignalExitBase = 128;

/// Applies "name=value" settings to the style's parameters.
config::ParameterValues withSettings(config::ParameterValues values,
                                     const std::vector<std::string>& settings) {
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos) {
      throw hal::StartupError(Error{.kind = ErrorKind::kInvalidArgument,
                                    .subject = "--set",
                                    .problem = fmt::format("found \"{}\"", setting),
                                    .remedy = "write name=value"});
    }
    values = values.with(setting.substr(0, equals), setting.substr(equals + 1), "--set");
  }
  return values;
}

std::optional<std::uint64_t> framesToPaint(const hal::StreamFormat& stream,
                                           const PaintingJob& job) {
  if (!stream.frameCount) return job.frames;
  return job.frames ? std::min(*job.frames, *stream.frameCount) : stream.frameCount;
}

/// One run of a job: the camera, the painter and everything that is written.
class Painting {
 public:
  explicit Painting(const PaintingJob& job)
      : job_(job),
        stream_(orThrow(job.camera->start({}))),
        output_(orThrow(hal::openFileOutput(job.output))),
        outputFormat_(
            orThrow(output_->start({.size = pictureSize(), .framePeriod = stream_.framePeriod}))),
        painter_({.pictureSize = pictureSize(),
                  .scene = job.scene,
                  .style = job.style,
                  .tracksTags = !job.scene.tags.empty() || job.poses,
                  .shaderDirectory = job.shaderDirectory,
                  .expectedFormat = stream_.frame}),
        parameters_(painter_.defaultParameters()),
        reader_(painter_.openReader(outputFormat_.frame)) {
    parameters_.view = job.view;
    parameters_.style = withSettings(parameters_.style, job.set);
    if (job.poses) poses_.emplace(orThrow(PosesFile::create(*job.poses)));
  }

  /// 0, or the signal that broke it off.
  int run() {
    Progress progress(job_.doing, framesToPaint(stream_, job_), realTime_);
    while (!job_.frames || progress.frames() < *job_.frames) {
      if (Interrupt::received() != 0) return Interrupt::received();
      const std::optional<hal::CapturedFrame> frame = nextFrame();
      if (!frame) break;
      paint(*frame, progress.frames());
      progress.advance();
    }
    finish();
    fmt::print("{} {} frames in {:.1f} s ({:.1f} frames/s): {}\n", job_.done, progress.frames(),
               std::chrono::duration<double>(progress.elapsed()).count(),
               progress.framesPerSecond(), job_.output.string());
    return 0;
  }

 private:
  hal::FrameSize pictureSize() const { return job_.size.value_or(stream_.frame.size); }

  /// Nothing at the end. A recording that broke off gives what it had, with a warning.
  std::optional<hal::CapturedFrame> nextFrame() {
    for (;;) {
      hal::NextFrame next = job_.camera->next(hal::kNoDeadline);
      if (auto* frame = std::get_if<hal::CapturedFrame>(&next)) return std::move(*frame);
      if (const auto* end = std::get_if<hal::EndOfStream>(&next)) {
        if (end->truncated) spdlog::warn("{}", end->truncated->message());
        return std::nullopt;
      }
      if (auto* lost = std::get_if<hal::CameraLost>(&next)) {
        throw hal::StartupError(std::move(lost->cause));
      }
      if (auto* error = std::get_if<Error>(&next)) throw hal::StartupError(std::move(*error));
    }
  }

  void paint(const hal::CapturedFrame& frame, std::uint64_t index) {
    if (!firstTime_) firstTime_ = frame.captureTime;
    const hal::Duration time = frame.captureTime - *firstTime_;
    while (!painter_.hasRoom(reader_)) write(true);
    const Picture picture = orThrow(painter_.paint(frame, parameters_));
    if (poses_) orThrow(poses_->write(index, time, picture.tracking));
    if (job_.contactSheet && sheet_.wants(index)) {
      sheet_.add(painter_.cameraStill().view(), painter_.still().view(), time);
    }
    while (write(false)) {
    }
  }

  /// Takes one picture that has been read to the output; false if there is none.
  bool write(bool wait) {
    if (!painter_.take(reader_, read_, wait)) return false;
    orThrow(output_->write(read_.image.view(), read_.captureTime - *firstTime_));
    return true;
  }

  void finish() {
    while (write(true)) {
    }
    orThrow(output_->finish());
    if (poses_) orThrow(poses_->publish());
    if (job_.contactSheet && !sheet_.isEmpty()) {
      orThrow(hal::writePng(*job_.contactSheet, sheet_.sheet().view()));
    }
  }

  const PaintingJob& job_;
  hal::SteadyClock realTime_;  // for the progress
  hal::StreamFormat stream_;
  std::unique_ptr<hal::MemoryOutput> output_;
  hal::OutputFormat outputFormat_;
  Painter painter_;
  PaintParameters parameters_;
  int reader_;
  ReadPicture read_;
  std::optional<hal::TimePoint> firstTime_;
  std::optional<PosesFile> poses_;
  present::ContactSheet sheet_;
};

}  // namespace

int runPainting(const PaintingJob& job) {
  const Interrupt interrupt;
  Painting painting(job);
  const int signal = painting.run();
  return signal == 0 ? 0 : kSignalExitBase + signal;
}

}  // namespace pleinair::app
