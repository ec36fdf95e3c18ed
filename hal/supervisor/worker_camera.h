#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <stop_token>
#include <thread>

#include "hal/camera.h"
#include "hal/supervisor/camera_selector.h"

namespace pleinair::hal {

/// How long a device may keep its caller waiting.
struct WorkerLimits {
  Duration start = std::chrono::seconds(10);
  Duration stop = std::chrono::seconds(1);
  /// Threads that hang in a driver at once; beyond it nothing more is opened.
  int mostHanging = 4;
};

/// A camera on a thread of its own, the driver thread, for devices whose drivers may block. It
/// hands over what the camera gives one by one, in order, and drops nothing: a camera whose frames
/// are not taken runs out of buffers, which it counts itself. The newest frame is chosen further
/// on, in one place (runtime::Mailbox). A call over its limit returns to
/// the caller; the driver thread is abandoned, and destroys its camera when the driver returns.
/// Until then start() answers kBusy.
///
/// Real time only: deadlines are the SteadyClock's. Contract as of Camera; start() also answers
/// kTimeout and kBusy. stop() and the destructor together wait once for the limit of a stop.
class WorkerCamera final : public Camera {
 public:
  /// `hanging` counts the abandoned threads of all cameras that share it.
  /// Once `interrupted`, start() does not wait.
  explicit WorkerCamera(CameraFactory make, WorkerLimits limits = {},
                        std::shared_ptr<std::atomic<int>> hanging = nullptr,
                        std::stop_token interrupted = {});
  ~WorkerCamera() override;

  CameraIdentity identity() const override;
  Result<StreamFormat> start(const StreamRequest& request) override;
  NextFrame next(TimePoint deadline) override;
  void stop() override;

 private:
  class Worker;
  WorkerLimits limits_;
  std::shared_ptr<std::atomic<int>> hanging_;
  std::stop_token interrupted_;
  std::shared_ptr<Worker> worker_;  // with the thread, which may outlive this
  bool isHanging_ = false;
  std::thread thread_;
};

/// Puts each camera onto a WorkerCamera.
CameraWrapper onThreadsOfTheirOwn(WorkerLimits limits = {});

}  // namespace pleinair::hal
