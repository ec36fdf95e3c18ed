#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <stop_token>
#include <thread>

#include "hal/camera.h"
#include "hal/supervisor/camera_selector.h"

namespace pleinair::hal {

/// Limits for devices whose drivers block.
struct WorkerLimits {
  Duration start = std::chrono::seconds(10);
  Duration stop = std::chrono::seconds(1);
  /// Driver threads that may hang at a time; while there are so many, no camera is opened.
  int maxHanging = 4;
};

/// Runs a camera whose driver may block on its own thread, the driver thread. It passes on each
/// answer of the camera in order and drops none: a camera whose frames are not taken runs out of
/// buffers and counts that itself; only runtime::Mailbox picks the newest frame. A call that
/// exceeds its limit returns to the caller. Its driver thread is abandoned and destroys the camera
/// when the driver returns; until then start() answers kBusy.
///
/// Real time only: deadlines are the SteadyClock's. The contract is Camera's; start() also answers
/// kTimeout and kBusy. stop() and the destructor together wait at most once for WorkerLimits::stop.
class WorkerCamera final : public Camera {
 public:
  /// `hanging`: counts the abandoned threads of all cameras that share it; null: of this one.
  /// `interrupted`: once it is requested, start() does not wait.
  explicit WorkerCamera(CameraFactory make, WorkerLimits limits = {},
                        std::shared_ptr<std::atomic<int>> hanging = nullptr,
                        std::stop_token interrupted = {});
  ~WorkerCamera() override;
  WorkerCamera(const WorkerCamera&) = delete;
  WorkerCamera& operator=(const WorkerCamera&) = delete;

  CameraIdentity identity() const override;
  Result<StreamFormat> start(const StreamRequest& request) override;
  NextFrame next(TimePoint deadline) override;
  void stop() override;

 private:
  class Worker;
  WorkerLimits limits_;
  std::shared_ptr<std::atomic<int>> hanging_;
  std::stop_token interrupted_;
  std::shared_ptr<Worker> worker_;  // shared with the thread, which may outlive this
  bool isHanging_ = false;
  std::thread thread_;
};

/// Wraps each camera in a WorkerCamera. All share one count of hanging threads.
CameraWrapper onDriverThreads(WorkerLimits limits = {});

}  // namespace pleinair::hal
