#include "firmware_app/offline/painting.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "firmware_app/cli/compile_notice.h"
#include "firmware_app/cli/exit_status.h"
#include "firmware_app/cli/interrupt.h"
#include "firmware_app/cli/path_collisions.h"
#include "firmware_app/cli/progress.h"
#include "firmware_app/cli/stale_parts.h"
#include "firmware_app/cli/standard_streams.h"
#include "firmware_app/offline/poses_file.h"
#include "firmware_app/scene/scene_observer.h"
#include "firmware_app/scene/scene_warnings.h"
#include "hal/media/png_file.h"
#include "hal/outputs/frames/frames_output.h"
#include "hal/outputs/registry.h"
#include "hal/overloaded.h"
#include "hal/pending_file.h"
#include "pipeline/engine/painter.h"
#include "pipeline/present/contact_sheet.h"
#include "pipeline/styles/registry.h"

namespace pleinair::app {
namespace {

using hal::Error;
using hal::orThrow;

std::optional<std::uint64_t> framesToPaint(const hal::StreamFormat& stream,
                                           const PaintingJob& job) {
  if (!stream.frameCount) return job.options.frames;
  return job.options.frames ? std::min(*job.options.frames, *stream.frameCount) : stream.frameCount;
}

void warn(const std::optional<std::string>& warning) {
  if (warning) spdlog::warn("{}", *warning);
}

/// How often a device that is silent is left, to look for a signal.
constexpr hal::Duration kSignalPollInterval = std::chrono::milliseconds(100);

template <class File>
std::optional<File> created(const std::optional<std::filesystem::path>& path) {
  if (!path) return std::nullopt;
  return orThrow(File::create(*path));
}

bool isStandardOutput(const std::filesystem::path& output) {
  return output == kStandardOutput;
}

std::unique_ptr<hal::MemoryOutput> openOutput(const PaintingOptions& options) {
  if (isStandardOutput(options.output)) return hal::openMovieStream();
  const bool isMovie = hal::isMovieName(options.output) && !isFrameSeries(options.output);
  if (isMovie) return hal::openMovieOutput(options.output, options.movie);
  std::unique_ptr<hal::MemoryOutput> pictures = orThrow(hal::openFileOutput(options.output));
  if (pictures->identity().backend != hal::framesKind().name) return pictures;
  return hal::openFramesOutput(options.output, options.pictures);
}

/// One run of a job: the camera, the painter and all outputs.
class Painting {
 public:
  /// Checks the job before it starts the output, which may create a folder.
  explicit Painting(const PaintingJob& job)
      : job_(job),
        stream_(orThrow(job.camera->start(job.request))),
        output_(openOutput(job.options)),
        painter_({.pictureSize = pictureSize(),
                  .scene = job.scene,
                  .style = job.options.style,
                  .tracksTags = !job.scene.tags.empty() || job.options.poses,
                  .isCameraMounted = job.options.isCameraMounted,
                  .shaderDirectory = job.options.shaderDirectory,
                  .expectedFormat = stream_.frame,
                  .overlay = job.overlay != nullptr,
                  .machine = job.machine,
                  .isCancelled = cancelledBySignal()}),
        parameters_(startParameters(job.options)),
        observer_(job.scene),
        poses_(created<PosesFile>(job.options.poses)),
        sheetFile_(created<hal::PendingFile>(job.options.contactSheet)),
        outputFormat_(
            orThrow(output_->start({.size = pictureSize(), .framePeriod = stream_.framePeriod}))),
        reader_(painter_.openReadback(outputFormat_.frame)) {
    if (!isStandardOutput(job.options.output)) {
      for (const std::string& notice : stalePartNotices(job.options.output)) {
        spdlog::warn("{}", notice);
      }
    }
    for (const std::string& notice : job.scene.notices) spdlog::warn("{}", notice);
    warn(assumedCameraWarning(job.scene, stream_.frame.size));
    warn(blackViewWarning(job.scene, job.options.view, isOneFrame()));
    if (const auto notice = evenSizeNotice(job.options.output, pictureSize())) {
      spdlog::info("{}", *notice);
    }
  }

  /// Paints until the end, a signal, or the loss of the camera; then completes the outputs with the
  /// frames so far. Gives the signal, or 0. Throws hal::Failure, that of the camera at the end.
  int run() {
    std::string summary;
    int signal = 0;
    {
      Progress progress(job_.progressVerb, framesToPaint(stream_, job_), realTime_);
      signal = paintAll(progress);
      frames_ = progress.frames();
      const bool isNothing = frames_ == 0 && (signal != 0 || lost_);
      if (!isNothing) finish();
      summary =
          fmt::format("{} {} {} in {:.1f} s ({:.1f} frames/s): {}\n", job_.summaryVerb, frames_,
                      frames_ == 1 ? "frame" : "frames", hal::toSeconds(progress.elapsed()),
                      progress.framesPerSecond(), job_.options.output.string());
      if (isNothing) summary.clear();
    }
    if (signal == 0 && !lost_) {
      for (const std::string& finding : observer_.findings()) spdlog::warn("{}", finding);
    }
    // Whether it arrived is checked at the end of the program.
    writeText(isStandardOutput(job_.options.output) ? stderr : stdout, summary);
    if (lost_) throw hal::Failure(*lost_);
    return signal;
  }

  /// The frames in the completed outputs.
  std::uint64_t frames() const { return frames_; }

 private:
  bool isOneFrame() const { return framesToPaint(stream_, job_) == 1; }

  hal::FrameSize pictureSize() const { return job_.options.size.value_or(stream_.frame.size); }

  /// Gives the signal that interrupted it, or 0.
  int paintAll(Progress& progress) {
    while (!job_.options.frames || progress.frames() < *job_.options.frames) {
      if (const int signal = Interrupt::received(); signal != 0) return signal;
      const std::optional<hal::CapturedFrame> frame = nextFrame(progress);
      if (!frame) return Interrupt::received();
      paint(*frame, progress.frames());
      progress.advance();
    }
    return 0;
  }

  /// Nothing at the end, which may be the camera's loss. A truncated recording gives its frames,
  /// with a warning.
  std::optional<hal::CapturedFrame> nextFrame(Progress& progress) {
    std::optional<hal::CapturedFrame> frame;
    constexpr bool kGoesOn = true;
    constexpr bool kDone = false;
    const hal::Overloaded receive{
        [&](hal::CapturedFrame& next) {
          frame = std::move(next);
          return kDone;
        },
        [](hal::CameraTimeout&) { return Interrupt::received() == 0 ? kGoesOn : kDone; },
        // Each frame carries its format, and the painter fits it into the output frame, whose size
        // stays.
        [](hal::FormatChanged&) { return kGoesOn; },
        [&](hal::EndOfStream& end) {
          // A signal ends the reading of a pipe, too.
          if (end.truncated && Interrupt::received() == 0) {
            progress.interrupt();
            spdlog::warn("{}", end.truncated->message());
          }
          return kDone;
        },
        [&](hal::CameraLost& lost) {
          lost_ = std::move(lost.cause);
          return kDone;
        },
        [&](Error& error) {
          lost_ = std::move(error);
          return kDone;
        },
    };
    for (bool goesOn = true; goesOn;) {
      hal::NextFrame next = job_.camera->next(
          job_.clock == nullptr ? hal::kNoDeadline : job_.clock->now() + kSignalPollInterval);
      goesOn = std::visit(receive, next);
    }
    return frame;
  }

  void paint(const hal::CapturedFrame& frame, std::uint64_t index) {
    if (!firstTime_) firstTime_ = frame.captureTime;
    const hal::Duration time = frame.captureTime - *firstTime_;
    if (job_.overlay) parameters_.overlay = job_.overlay(time, pictureSize());
    while (!painter_.hasRoom(reader_)) write(true);
    const Picture picture = orThrow(painter_.paint(frame, parameters_));
    observer_.take(frame.image.map().view(), picture.tracking);
    if (poses_) orThrow(poses_->write(index, time, picture.tracking));
    if (sheetFile_ && sheet_.wants(index)) {
      const hal::Image camera = orThrow(painter_.cameraSnapshot());
      const hal::Image painted = orThrow(painter_.snapshot());
      sheet_.add(camera.view(), painted.view(), time);
    }
    while (write(false)) {
    }
  }

  /// Passes one frame that has been read back to the output; false if there is none.
  bool write(bool wait) {
    if (!orThrow(wait ? painter_.wait(reader_, read_) : painter_.poll(reader_, read_)))
      return false;
    orThrow(output_->write(read_.image.view(), read_.captureTime - *firstTime_));
    return true;
  }

  /// Writes all outputs before the first one takes its name.
  void finish() {
    while (write(true)) {
    }
    const bool hasSheet = sheetFile_ && !sheet_.isEmpty();
    if (hasSheet) orThrow(sheetFile_->write(orThrow(hal::encodePng(sheet_.sheet().view()))));
    orThrow(output_->finish());
    if (poses_) orThrow(poses_->publish());
    if (hasSheet) orThrow(sheetFile_->publish());
  }

  const PaintingJob& job_;
  hal::SteadyClock realTime_;  // for the progress line
  hal::StreamFormat stream_;
  std::unique_ptr<hal::MemoryOutput> output_;
  Painter painter_;
  PaintParameters parameters_;
  SceneObserver observer_;
  std::optional<PosesFile> poses_;
  std::optional<hal::PendingFile> sheetFile_;
  hal::OutputFormat outputFormat_;
  int reader_;
  OutputFrame read_;
  std::optional<hal::TimePoint> firstTime_;
  std::optional<Error> lost_;  ///< why the camera gives no further frame
  std::uint64_t frames_ = 0;
  present::ContactSheet sheet_;
};

void reportInterruption(int signal, std::uint64_t frames, const PaintingJob& job) {
  const std::string output = job.options.output.string();
  std::string kept = "nothing was written";
  if (frames == 1) kept = fmt::format("the frame so far is kept in {}", output);
  if (frames > 1) kept = fmt::format("the {} frames so far are kept in {}", frames, output);
  printError(fmt::format("interrupted by {}; {}", signalName(signal), kept));
}

}  // namespace

std::optional<std::string> evenSizeNotice(const std::filesystem::path& output,
                                          hal::FrameSize size) {
  const bool isEven = size.width % 2 == 0 && size.height % 2 == 0;
  const std::string ending = output.extension().string();
  const bool isY4m = ending == ".y4m" || ending == ".Y4M";
  if (isEven || isY4m || isFrameSeries(output) || !hal::isMovieName(output)) return std::nullopt;
  return fmt::format(
      "{}: movies have even sides: {}x{} becomes {}x{}, with the last column or row twice",
      output.string(), size.width, size.height, size.width + size.width % 2,
      size.height + size.height % 2);
}

PaintParameters startParameters(const PaintingOptions& options) {
  hal::orThrow(checkDebugView(options.style, options.view));
  return {.style = options.parameters.value_or(styles::styleKind(options.style).defaults),
          .view = options.view};
}

int runPainting(const PaintingJob& job) {
  const Interrupt interrupt;
  int signal = 0;
  std::uint64_t frames = 0;
  try {
    Painting painting(job);
    signal = painting.run();
    frames = painting.frames();
  } catch (const hal::Failure& failure) {
    if (failure.error().kind != hal::ErrorKind::kCancelled) throw;
    signal = Interrupt::received();
  }
  if (signal == 0) return 0;
  reportInterruption(signal, frames, job);
  return kSignalExitBase + signal;
}

}  // namespace pleinair::app
