#include "firmware_app/live/camera_thread.h"

#include <chrono>
#include <utility>
#include <variant>

#include "firmware_app/overloaded.h"

namespace pleinair::app {
namespace {

/// How long a camera without frames may keep stop() waiting.
constexpr hal::Duration kLongestWait = std::chrono::milliseconds(100);

}  // namespace

CameraThread::CameraThread(hal::Camera& camera, hal::Clock& clock, hal::StreamRequest request)
    : camera_(camera),
      clock_(clock),
      thread_([this, request](const std::stop_token& stopped) { run(stopped, request); }) {}

CameraThread::~CameraThread() {
  stop();
}

void CameraThread::stop() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

hal::StreamFormat CameraThread::format() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return format_.has_value(); });
  return hal::orThrow(*format_);
}

void CameraThread::begin() {
  const std::scoped_lock lock(mutex_);
  mayBegin_ = true;
  changed_.notify_all();
}

CameraThread::Taken CameraThread::take(hal::Duration patience) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, patience, [this] { return waiting_.frame || waiting_.hasEnded; });
  Taken taken = std::move(waiting_);
  waiting_ = {.hasEnded = taken.hasEnded, .failure = taken.failure};
  return taken;
}

void CameraThread::run(const std::stop_token& stopped, const hal::StreamRequest& request) {
  hal::Result<hal::StreamFormat> format = camera_.start(request);
  const bool isSound = format.has_value();
  answer(std::move(format));
  if (isSound && waitForBegin(stopped)) {
    camera_.stop();
    if (auto again = camera_.start(request); again) {
      stream(stopped);
    } else {
      end(std::move(again.error()));
    }
  }
  camera_.stop();
}

void CameraThread::stream(const std::stop_token& stopped) {
  constexpr bool kGoesOn = true;
  constexpr bool kDone = false;
  const Overloaded receive{
      [&](hal::CapturedFrame& frame) {
        hand(std::move(frame));
        return kGoesOn;
      },
      [](hal::CameraTimeout&) { return kGoesOn; },
      // Every frame says its format, and the painter fits it into the picture, whose size stays.
      [](hal::FormatChanged&) { return kGoesOn; },
      [&](hal::EndOfStream& ending) {
        end(std::move(ending.truncated));
        return kDone;
      },
      [&](hal::CameraLost& lost) {
        end(std::move(lost.cause));
        return kDone;
      },
      [&](hal::Error& error) {
        end(std::move(error));
        return kDone;
      },
  };
  for (bool goesOn = true; goesOn && !stopped.stop_requested();) {
    hal::NextFrame next = camera_.next(clock_.now() + kLongestWait);
    goesOn = std::visit(receive, next);
  }
}

void CameraThread::answer(hal::Result<hal::StreamFormat> format) {
  const std::scoped_lock lock(mutex_);
  format_ = std::move(format);
  changed_.notify_all();
}

bool CameraThread::waitForBegin(const std::stop_token& stopped) {
  std::unique_lock lock(mutex_);
  return changed_.wait(lock, stopped, [this] { return mayBegin_; });
}

void CameraThread::hand(hal::CapturedFrame frame) {
  const std::scoped_lock lock(mutex_);
  waiting_.leftOut += frame.droppedBefore;
  if (waiting_.frame) ++waiting_.replaced;
  waiting_.frame = std::move(frame);
  changed_.notify_all();
}

void CameraThread::end(std::optional<hal::Error> failure) {
  const std::scoped_lock lock(mutex_);
  waiting_.hasEnded = true;
  waiting_.failure = std::move(failure);
  changed_.notify_all();
}

}  // namespace pleinair::app
