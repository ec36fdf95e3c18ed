#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "hal/supervisor/camera_supervisor.h"
#include "tests/support/scripted_camera.h"

namespace pleinair::hal {

/// One answer of a supervisor, as text, with its time.
struct Happened {
  Duration at;
  std::string what;  ///< "opening", "format", "frame", "end" …
  std::string reason;
  SupervisedFrame frame;
};

/// A supervisor over one scripted back end, "usb", and a record of its answers.
class Supervised {
 public:
  explicit Supervised(std::string choice = "usb", SupervisorOptions options = {})
      : choice_(std::move(choice)), options_(options) {}

  support::ScriptedBackend& backend() { return *backend_; }
  std::shared_ptr<support::ScriptedDevice> add(std::vector<support::ScriptedSession> sessions,
                                               std::string id = "a") {
    return backend_->add(std::move(id), std::move(sessions));
  }

  CameraSupervisor& supervisor() {
    if (!supervisor_) {
      selector_ = std::make_unique<CameraSelector>(
          std::vector<SelectableBackend>{{.backend = backend_, .isDevice = isDevice}}, choice_,
          clock);
      supervisor_ = std::make_unique<CameraSupervisor>(*selector_, clock, options_);
    }
    return *supervisor_;
  }

  /// Collects all answers within `duration`.
  std::vector<Happened> run(Duration duration) {
    const TimePoint until = clock.now() + duration;
    std::vector<Happened> all;
    for (;;) {
      SupervisedNext next = supervisor().next(until);
      if (std::holds_alternative<CameraTimeout>(next) && clock.now() >= until) return all;
      const bool isEnd = std::holds_alternative<EndOfStream>(next);
      all.push_back(told(std::move(next)));
      if (isEnd) return all;
    }
  }
  void destroy() { supervisor_.reset(); }

  SteppedClock clock;
  bool isDevice = true;

 private:
  Happened told(SupervisedNext next) const {
    Happened happened{.at = clock.now().time_since_epoch(), .what = {}, .reason = {}, .frame = {}};
    if (auto* frame = std::get_if<SupervisedFrame>(&next)) {
      happened.what = "frame";
      happened.frame = std::move(*frame);
    } else if (auto* changed = std::get_if<CameraStateChanged>(&next)) {
      happened.what = toString(changed->state);
      happened.reason = changed->reason;
    } else if (std::holds_alternative<FormatChanged>(next)) {
      happened.what = "format";
    } else {
      happened.what = std::holds_alternative<EndOfStream>(next) ? "end" : "timeout";
    }
    return happened;
  }

  std::string choice_;
  SupervisorOptions options_;
  std::shared_ptr<support::ScriptedBackend> backend_ =
      std::make_shared<support::ScriptedBackend>("usb", clock);
  std::unique_ptr<CameraSelector> selector_;
  std::unique_ptr<CameraSupervisor> supervisor_;
};

/// The names of the answers, with runs of frames as "frames×12".
inline std::vector<std::string> story(const std::vector<Happened>& all) {
  std::vector<std::string> lines;
  int frames = 0;
  const auto flush = [&] {
    if (frames > 0) lines.push_back("frames×" + std::to_string(frames));
    frames = 0;
  };
  for (const Happened& each : all) {
    if (each.what == "frame") {
      ++frames;
      continue;
    }
    flush();
    lines.push_back(each.what);
  }
  flush();
  return lines;
}

inline std::vector<SupervisedFrame> framesOf(const std::vector<Happened>& all) {
  std::vector<SupervisedFrame> frames;
  for (const Happened& each : all) {
    if (each.what == "frame") frames.push_back(each.frame);
  }
  return frames;
}

/// The first answer of that name.
inline Happened firstOf(const std::vector<Happened>& all, const std::string& what) {
  for (const Happened& each : all) {
    if (each.what == what) return each;
  }
  ADD_FAILURE() << what << " did not happen";
  return {};
}

/// Checks the invariants of the frames from one supervisor, in sequence.
inline void expectLedgerOf(const std::vector<SupervisedFrame>& frames) {
  std::uint64_t expected = 0;
  std::optional<TimePoint> last;
  for (const SupervisedFrame& each : frames) {
    expected +=
        each.frame.droppedBefore + each.corruptBefore + each.incompleteBefore + each.misTimedBefore;
    EXPECT_EQ(each.frame.sequence, expected);
    EXPECT_LE(each.lostInStall + each.frame.underrunsBefore, each.frame.droppedBefore);
    EXPECT_TRUE(each.frame.image.isComplete());
    if (last) {
      EXPECT_GT(each.frame.captureTime, *last);
    }
    last = each.frame.captureTime;
    ++expected;
  }
}

}  // namespace pleinair::hal
