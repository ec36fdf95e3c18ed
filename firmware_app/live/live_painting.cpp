#include "firmware_app/live/live_painting.h"

#include <chrono>
#include <cstdio>
#include <ctime>
#include <deque>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "firmware_app/interrupt.h"
#include "firmware_app/live/camera_thread.h"
#include "firmware_app/live/frame_counts.h"
#include "firmware_app/live/frame_rate.h"
#include "firmware_app/live/live_tuning.h"
#include "firmware_app/live/live_window.h"
#include "firmware_app/live/still_file.h"
#include "firmware_app/progress.h"
#include "firmware_app/scene_warnings.h"
#include "hal/outputs/open_output.h"
#include "hal/outputs/window/window.h"
#include "pipeline/painter.h"

namespace pleinair::app {
namespace {

using hal::orThrow;
using namespace std::chrono_literals;

/// How long the loop waits for a frame: while the GPU works, not past the picture that it brings.
constexpr hal::Duration kBusyPatience = 2ms;
constexpr hal::Duration kIdlePatience = 20ms;
/// One on the GPU while the next is tracked; more would only wait there and grow old.
constexpr std::size_t kMostUnderWay = 2;

LiveTuning tuningOf(const Painter& painter, const PaintingOptions& options) {
  std::vector<LiveLook> looks;
  for (const PainterLook& look : painter.looks()) {
    looks.push_back({look.name, painter.lookParameters(look.name)});
  }
  return {options.style, parametersOf(painter, options), painter.views(), std::move(looks)};
}

/// The live loop, all on one thread but for the camera.
class LivePainting {
 public:
  explicit LivePainting(const LiveJob& job)
      : job_(job),
        output_(orThrow(hal::openOutput(job.options.output.string()))),
        camera_(*job.camera, *job.clock, {.size = job.options.size}),
        stream_(camera_.format()),
        painter_({.pictureSize = pictureSize(),
                  .scene = job.scene,
                  .style = job.options.style,
                  .tracksTags = !job.scene.tags.empty(),
                  .shaderDirectory = job.options.shaderDirectory,
                  .expectedFormat = stream_.frame}),
        tuning_(tuningOf(painter_, job.options)),
        reader_(painter_.openReader(
            orThrow(output_->start({.size = pictureSize(), .framePeriod = stream_.framePeriod}))
                .frame)) {
    if (auto* window = dynamic_cast<hal::Window*>(output_.get()); window != nullptr) {
      window_.emplace(*window, tuning_, *job.clock);
    }
    for (const std::string& notice : job.scene.notices) spdlog::warn("{}", notice);
    if (const auto warning = assumedCameraWarning(job.scene, stream_.frame.size)) {
      spdlog::warn("{}", *warning);
    }
  }

  void run() {
    const hal::TimePoint began = job_.clock->now();
    {
      Progress progress("showing", job_.options.frames, *job_.clock);
      progress_ = &progress;
      camera_.begin();
      while (!isOver()) {
        if (isPaintingFull()) show(true);
        paintNewest();
        while (show(false)) {
        }
        attendWindow();
      }
      finish();
      progress_ = nullptr;
    }
    if (hasResult()) {
      fmt::print("{}: {}\n", counts_.summary(job_.clock->now() - began),
                 job_.options.output.string());
    }
    if (failure_) throw hal::StartupError(*std::move(failure_));
  }

 private:
  hal::FrameSize pictureSize() const { return job_.options.size.value_or(stream_.frame.size); }
  bool isPaintingFull() const { return underWay_.size() >= kMostUnderWay; }

  bool isOver() const {
    const bool isEnough = job_.options.frames && painted_ >= *job_.options.frames;
    return isEnough || hasEnded_ || wantsToQuit_ || Interrupt::received() != 0;
  }

  void paintNewest() {
    CameraThread::Taken taken = takeFrame(underWay_.empty() ? kIdlePatience : kBusyPatience);
    if (taken.frame) {
      paint(*taken.frame);
    } else if (taken.hasEnded) {
      hasEnded_ = true;
      failure_ = std::move(taken.failure);
    }
  }

  CameraThread::Taken takeFrame(hal::Duration patience) {
    CameraThread::Taken taken = camera_.take(patience);
    counts_.drop(DropReason::kCamera, taken.leftOut);
    counts_.drop(DropReason::kReplaced, taken.replaced);
    return taken;
  }

  void paint(const hal::CapturedFrame& frame) {
    if (!firstTime_) firstTime_ = frame.captureTime;
    const bool isRepeat = tuning_.isPaused() && held_;
    PaintParameters parameters = tuning_.parameters();
    if (wantsStill_) parameters.view.clear();
    orThrow(painter_.paint(isRepeat ? heldAt(frame) : frame, parameters));
    underWay_.push_back(isRepeat);
    if (isRepeat) {
      counts_.drop(DropReason::kPaused);
    } else {
      ++painted_;
      hold(frame);
    }
    if (std::exchange(wantsStill_, false)) saveStill();
  }

  /// During a pause the first frame is painted again and again, so that tuning shows on it.
  void hold(const hal::CapturedFrame& frame) {
    held_.reset();
    if (tuning_.isPaused()) held_.emplace(frame.image);
  }

  hal::CapturedFrame heldAt(const hal::CapturedFrame& frame) const {
    return {.image = held_->view(),
            .sequence = frame.sequence,
            .captureTime = frame.captureTime,
            .timestampSource = frame.timestampSource};
  }

  /// Takes one picture that has been read to the output; false if there is none.
  bool show(bool wait) {
    if (!orThrow(painter_.take(reader_, read_, wait))) return false;
    const bool isRepeat = underWay_.front();
    underWay_.pop_front();
    rate_.count(job_.clock->now());
    if (window_) window_->update(rate_.perSecond(), true);
    orThrow(output_->write(read_.image.view(), read_.captureTime - *firstTime_));
    if (isRepeat) return true;
    counts_.show();
    progress_->advance();
    return true;
  }

  void attendWindow() {
    if (!window_) return;
    const LiveWindow::Wishes wishes = window_->takeWishes();
    wantsToQuit_ = wantsToQuit_ || wishes.quit;
    wantsStill_ = wantsStill_ || wishes.still;
    window_->update(rate_.perSecond(), false);
  }

  void saveStill() {
    const hal::Image still = orThrow(painter_.still());
    const auto saved = app::saveStill(job_.stills, still.view(), std::time(nullptr));
    const std::string text = saved ? "saved " + saved->string() : saved.error().message();
    window_->notify(text);
    progress_->interrupt();
    if (saved) {
      spdlog::info("{}", text);
    } else {
      spdlog::warn("{}", text);
    }
  }

  /// Also after the camera is lost what was painted is kept; of nothing there is no file.
  bool hasResult() const { return !failure_ || painted_ > 0; }

  void finish() {
    camera_.stop();
    if (takeFrame(0ms).frame) counts_.drop(DropReason::kStopped);
    while (show(true)) {
    }
    if (hasResult()) orThrow(output_->finish());
  }

  const LiveJob& job_;
  std::unique_ptr<hal::MemoryOutput> output_;
  CameraThread camera_;
  hal::StreamFormat stream_;
  Painter painter_;
  LiveTuning tuning_;
  int reader_;
  std::optional<LiveWindow> window_;  ///< where the output is one

  std::deque<bool> underWay_;       ///< pictures to be read, and whether each is a repeat
  std::optional<hal::Image> held_;  ///< of a pause
  std::optional<hal::TimePoint> firstTime_;
  ReadPicture read_;
  FrameCounts counts_;
  FrameRate rate_;
  Progress* progress_ = nullptr;  ///< while it runs
  std::uint64_t painted_ = 0;
  bool hasEnded_ = false;
  std::optional<hal::Error> failure_;  ///< why it ended, where that is not its proper end
  bool wantsToQuit_ = false;
  bool wantsStill_ = false;
};

}  // namespace

int runLive(const LiveJob& job) {
  const Interrupt interrupt;
  LivePainting(job).run();
  return 0;
}

}  // namespace pleinair::app
