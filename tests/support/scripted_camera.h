#pragma once

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "hal/camera.h"
#include "hal/camera_backend.h"
#include "hal/image.h"

namespace pleinair::support {

// Cameras that follow a script, timed by the clock.

struct ScriptedFrame {
  hal::Duration after = std::chrono::milliseconds(33);  ///< since the previous step
  std::uint64_t dropped = 0;
  std::uint64_t underruns = 0;
  hal::Duration timeError{};  ///< of its capture time
  bool isTooShort = false;    ///< its plane does not hold its format
  hal::FrameHealth health = hal::FrameHealth::kValid;
  std::optional<hal::FrameFormat> format;
};
/// No event. A camera at the end of its script stays silent.
struct ScriptedSilence {
  hal::Duration duration;
};
/// The clock jumps during a wait, as after a suspend.
struct ScriptedJump {
  hal::Duration by;
};
using ScriptedStep = std::variant<ScriptedFrame, ScriptedSilence, ScriptedJump, hal::FormatChanged,
                                  hal::EndOfStream, hal::CameraLost, hal::Error>;

inline hal::FrameFormat scriptedFormat(int width = 8, int height = 6) {
  return {.pixelFormat = hal::PixelFormat::kGrey8, .size = {width, height}};
}

/// The steps from one start() to its stop().
struct ScriptedSession {
  std::optional<hal::Error> startError;
  hal::Duration startTakes{};
  hal::StreamFormat format{.frame = scriptedFormat(), .framePeriod = std::chrono::milliseconds(33)};
  std::vector<ScriptedStep> steps;
};

/// A device with one session per start(); after the last session it is gone.
struct ScriptedDevice {
  hal::CameraDescription description;
  std::vector<ScriptedSession> sessions;
  bool repeatsLast = false;
  // Recorded calls.
  std::size_t starts = 0;
  std::vector<hal::TimePoint> startTimes;
  hal::Duration jumped{};  ///< time by which ScriptedJump and startTakes exceeded deadlines
  int alive = 0;           ///< cameras of this device that exist
  int streaming = 0;       ///< the started ones among them
};

inline hal::Error scriptedError(hal::ErrorKind kind, std::string problem) {
  return {.kind = kind, .subject = "scripted", .problem = std::move(problem)};
}

class ScriptedCamera final : public hal::Camera {
 public:
  ScriptedCamera(std::shared_ptr<ScriptedDevice> device, hal::SteppedClock& clock)
      : device_(std::move(device)), clock_(clock) {
    ++device_->alive;
  }
  ~ScriptedCamera() override {
    stop();
    --device_->alive;
  }

  hal::CameraIdentity identity() const override { return device_->description.identity; }

  hal::Result<hal::StreamFormat> start(const hal::StreamRequest&) override {
    assert(!session_);
    const std::size_t index = device_->starts++;
    device_->startTimes.push_back(clock_.now());
    const std::size_t count = device_->sessions.size();
    if (index >= count && !(device_->repeatsLast && count > 0)) {
      return tl::unexpected(scriptedError(hal::ErrorKind::kNotFound, "is not there"));
    }
    const ScriptedSession& session = device_->sessions[std::min(index, count - 1)];
    clock_.advance(session.startTakes);
    device_->jumped += session.startTakes;
    if (session.startError) return tl::unexpected(*session.startError);
    session_ = session;
    format_ = session.format.frame;
    step_ = 0;
    time_ = clock_.now();
    ++device_->streaming;
    return session_->format;
  }

  hal::NextFrame next(hal::TimePoint deadline) override {
    assert(session_);
    while (step_ < session_->steps.size()) {
      const ScriptedStep& step = session_->steps[step_];
      const hal::TimePoint due = time_ + durationOf(step);
      if (due > deadline) break;
      clock_.sleepUntil(due);
      if (const auto* jump = std::get_if<ScriptedJump>(&step)) {
        clock_.advance(jump->by);
        device_->jumped += jump->by;
        time_ = clock_.now();
        ++step_;
        continue;
      }
      time_ = due;
      if (endsSession(step)) return answerOf(step);  // repeated until stop()
      ++step_;
      if (!std::holds_alternative<ScriptedSilence>(step)) return answerOf(step);
    }
    clock_.sleepUntil(deadline);
    return hal::CameraTimeout{};
  }

  void stop() override {
    if (session_) --device_->streaming;
    session_.reset();
  }

 private:
  static hal::Duration durationOf(const ScriptedStep& step) {
    if (const auto* frame = std::get_if<ScriptedFrame>(&step)) return frame->after;
    if (const auto* silence = std::get_if<ScriptedSilence>(&step)) return silence->duration;
    return {};
  }
  static bool endsSession(const ScriptedStep& step) {
    return std::holds_alternative<hal::EndOfStream>(step) ||
           std::holds_alternative<hal::CameraLost>(step) ||
           std::holds_alternative<hal::Error>(step);
  }

  hal::NextFrame answerOf(const ScriptedStep& step) {
    if (const auto* frame = std::get_if<ScriptedFrame>(&step)) return frameOf(*frame);
    if (const auto* changed = std::get_if<hal::FormatChanged>(&step)) {
      format_ = changed->format.frame;
      return *changed;
    }
    if (const auto* end = std::get_if<hal::EndOfStream>(&step)) return *end;
    if (const auto* lost = std::get_if<hal::CameraLost>(&step)) return *lost;
    return std::get<hal::Error>(step);
  }

  hal::CapturedFrame frameOf(const ScriptedFrame& scripted) {
    const auto image = std::make_shared<hal::Image>(scripted.format.value_or(format_));
    hal::CapturedFrame frame{.image = image->view(),
                             .dmaBufs = {},
                             // wrong on purpose: the supervisor numbers frames itself
                             .sequence = 0,
                             .droppedBefore = scripted.dropped,
                             .underrunsBefore = scripted.underruns,
                             .captureTime = time_ + scripted.timeError,
                             .lease = image};
    frame.health = scripted.health;
    if (scripted.isTooShort) {
      hal::ImageView cut = image->view();
      cut.planes[0].bytes = cut.planes[0].bytes.first(cut.planes[0].bytes.size() - 1);
      frame.image = cut;
    }
    return frame;
  }

  std::shared_ptr<ScriptedDevice> device_;
  hal::SteppedClock& clock_;
  std::optional<ScriptedSession> session_;
  hal::FrameFormat format_;
  std::size_t step_ = 0;
  hal::TimePoint time_;
};

/// A back end with scripted devices.
class ScriptedBackend final : public hal::CameraBackend {
 public:
  ScriptedBackend(std::string name, hal::SteppedClock& clock)
      : name_(std::move(name)), clock_(clock) {}

  std::shared_ptr<ScriptedDevice> add(std::string id, std::vector<ScriptedSession> sessions,
                                      std::string node = {}, std::string serial = {}) {
    auto device = std::make_shared<ScriptedDevice>();
    device->description = {.identity = {.backend = name_, .id = std::move(id), .description = ""},
                           .serial = std::move(serial),
                           .node = std::move(node),
                           .modes = {},
                           .problem = {}};
    device->sessions = std::move(sessions);
    devices_.push_back(device);
    return device;
  }
  void failListing(hal::Error error) { listError_ = std::move(error); }
  int lists = 0;                     ///< calls of list()
  std::function<void()> whenListed;  ///< called at the end of each, if set

  std::string_view name() const override { return name_; }
  hal::Result<std::vector<hal::CameraDescription>> list() override {
    ++lists;
    if (listError_) return tl::unexpected(*listError_);
    std::vector<hal::CameraDescription> descriptions;
    for (const auto& device : devices_) descriptions.push_back(device->description);
    if (whenListed) whenListed();
    return descriptions;
  }
  std::unique_ptr<hal::Camera> make(const std::string& id, hal::Clock&) override {
    const auto found = std::ranges::find_if(
        devices_, [&](const auto& device) { return device->description.identity.id == id; });
    if (found == devices_.end()) return std::make_unique<ScriptedCamera>(absent_, clock_);
    return std::make_unique<ScriptedCamera>(*found, clock_);
  }

 private:
  std::string name_;
  hal::SteppedClock& clock_;
  std::vector<std::shared_ptr<ScriptedDevice>> devices_;
  std::shared_ptr<ScriptedDevice> absent_ = std::make_shared<ScriptedDevice>();
  std::optional<hal::Error> listError_;
};

/// A script of `count` frames, one period apart.
inline std::vector<ScriptedStep> scriptedFrames(
    int count, hal::Duration period = std::chrono::milliseconds(33)) {
  return std::vector<ScriptedStep>(static_cast<std::size_t>(count), ScriptedFrame{.after = period});
}

/// Concatenates the steps of several scripts.
template <class... Steps>
std::vector<ScriptedStep> scriptOf(Steps... steps) {
  std::vector<ScriptedStep> script;
  const auto append = [&]<class T>(T step) {
    if constexpr (std::is_same_v<T, std::vector<ScriptedStep>>) {
      script.insert(script.end(), step.begin(), step.end());
    } else {
      script.emplace_back(std::move(step));
    }
  };
  (append(std::move(steps)), ...);
  return script;
}

}  // namespace pleinair::support
