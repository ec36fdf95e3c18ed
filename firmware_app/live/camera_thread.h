#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/error.h"

namespace pleinair::app {

/// Runs a camera on a thread of its own and hands its newest frame over: one waits at the most and
/// a newer one takes its place, so that whoever paints slowly is late by a frame and never by more.
/// All calls from one thread. The camera, stopped, and its clock outlive this.
class CameraThread {
 public:
  CameraThread(hal::Camera& camera, hal::Clock& clock, hal::StreamRequest request = {});
  ~CameraThread();
  CameraThread(const CameraThread&) = delete;
  CameraThread& operator=(const CameraThread&) = delete;

  /// What the camera delivers; waits until it has answered. Throws hal::StartupError.
  hal::StreamFormat format();
  /// Lets frames flow. The camera starts anew: those of before would be old by now.
  void begin();

  struct Taken {
    std::optional<hal::CapturedFrame> frame;
    // Since the last call:
    std::uint64_t leftOut = 0;   ///< by the camera
    std::uint64_t replaced = 0;  ///< by newer ones
    /// No frame comes any more; `failure` where that is not the end of a recording.
    bool hasEnded = false;
    std::optional<hal::Error> failure;
  };
  /// The newest frame, or none if none came within `patience`.
  Taken take(hal::Duration patience);

  /// Ends the thread and stops the camera: within 0.1 s, or the time that a frame takes it. What
  /// was not taken still can be. Idempotent.
  void stop();

 private:
  void run(const std::stop_token& stopped, const hal::StreamRequest& request);
  void stream(const std::stop_token& stopped);
  void answer(hal::Result<hal::StreamFormat> format);
  bool waitForBegin(const std::stop_token& stopped);
  void hand(hal::CapturedFrame frame);
  void end(std::optional<hal::Error> failure);

  hal::Camera& camera_;
  hal::Clock& clock_;

  std::mutex mutex_;  // of what follows
  std::condition_variable_any changed_;
  std::optional<hal::Result<hal::StreamFormat>> format_;
  bool mayBegin_ = false;
  Taken waiting_;

  std::jthread thread_;  // last: it uses the rest
};

}  // namespace pleinair::app
