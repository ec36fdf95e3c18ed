#include "firmware_app/offline/capturing.h"

#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "firmware_app/cli/interrupt.h"
#include "firmware_app/cli/progress.h"
#include "firmware_app/cli/standard_streams.h"
#include "hal/captures/capture_writer.h"
#include "hal/overloaded.h"

namespace pleinair::app {
namespace {

using hal::orThrow;

/// How often a camera that is silent is left, to look for a signal.
constexpr hal::Duration kSignalInterval = std::chrono::milliseconds(100);

/// One run of a job.
class Capture {
 public:
  explicit Capture(const CaptureJob& job)
      : job_(job),
        start_(job.clock->now()),
        stream_(orThrow(job.camera->start(job.request))),
        writer_(orThrow(hal::captures::CaptureWriter::open(
            job.output,
            {.camera = job.camera->identity(), .format = stream_, .request = job.requestText},
            start_))) {
    if (!stream_.warning.empty()) spdlog::warn("{}", stream_.warning);
  }

  /// Gives the signal that ended it, or 0.
  int run() {
    int signal = 0;
    {
      Progress progress("recording", job_.frames, realTime_);
      while (!hasEnded_ && signal == 0 && frames_ < job_.frames) {
        step(progress);
        signal = Interrupt::received();
      }
    }
    job_.camera->stop();
    if (frames_ > 0) {
      orThrow(writer_->finish());
      writeText(stdout,
                fmt::format("recorded {} {}, {} lost before them: {}\n", frames_,
                            frames_ == 1 ? "frame" : "frames", lost_, job_.output.string()));
    }
    if (failure_) throw hal::Failure(*failure_);
    return signal;
  }

 private:
  void step(Progress& progress) {
    hal::NextFrame next = job_.camera->next(job_.clock->now() + kSignalInterval);
    std::visit(hal::Overloaded{
                   [&](const hal::CapturedFrame& frame) { keep(frame, progress); },
                   [](const hal::CameraTimeout&) {},
                   [&](const hal::FormatChanged& changed) { follow(changed); },
                   [&](const hal::EndOfStream& end) {
                     hasEnded_ = true;
                     if (end.truncated) spdlog::warn("{}", end.truncated->message());
                   },
                   [&](const hal::CameraLost& lost) { fail(lost.cause); },
                   [&](const hal::Error& error) { fail(error); },
               },
               next);
  }
  void keep(const hal::CapturedFrame& frame, Progress& progress) {
    orThrow(writer_->write(frame));
    ++frames_;
    lost_ += frame.droppedBefore;
    progress.advance();
  }
  void follow(const hal::FormatChanged& changed) {
    if (changed.format.frame == stream_.frame) return;
    hasEnded_ = true;
    spdlog::warn("the camera changed its format: the recording ends before that");
  }
  void fail(const hal::Error& error) {
    hasEnded_ = true;
    failure_ = error;
  }

  const CaptureJob& job_;
  hal::SteadyClock realTime_;
  hal::TimePoint start_;
  hal::StreamFormat stream_;
  std::unique_ptr<hal::captures::CaptureWriter> writer_;
  std::uint64_t frames_ = 0;
  std::uint64_t lost_ = 0;
  bool hasEnded_ = false;
  std::optional<hal::Error> failure_;
};

}  // namespace

int runCapture(const CaptureJob& job) {
  const Interrupt interrupt;
  const int signal = Capture(job).run();
  return signal == 0 ? 0 : kSignalExitBase + signal;
}

}  // namespace pleinair::app
