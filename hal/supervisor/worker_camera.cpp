#include "hal/supervisor/worker_camera.h"

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include <pthread.h>

#include "hal/clock.h"

namespace pleinair::hal {
namespace {

/// Longest wait for a frame at a time: the thread may notice a stop so much later.
constexpr Duration kPollInterval = std::chrono::milliseconds(50);

/// Waits for `condition` for at most `limit` of real time; returns whether it holds.
template <class Condition>
bool holdsWithin(std::condition_variable& changed, std::unique_lock<std::mutex>& lock,
                 Duration limit, Condition condition) {
  return changed.wait_until(lock, std::chrono::steady_clock::now() + limit, condition);
}

/// Whether the stream goes on after this answer.
bool goesOn(const NextFrame& next) {
  return std::holds_alternative<CapturedFrame>(next) || std::holds_alternative<FormatChanged>(next);
}

}  // namespace

/// The state that the thread and its owner share. The last of them frees it.
class WorkerCamera::Worker {
 public:
  Worker(CameraFactory make, std::shared_ptr<std::atomic<int>> hanging)
      : make_(std::move(make)), hanging_(std::move(hanging)), camera_(make_(clock_)) {
    identity_ = camera_->identity();
  }

  CameraIdentity identity() {
    const std::scoped_lock lock(mutex_);
    return identity_;
  }
  Result<StreamFormat> start(const StreamRequest& request, Duration limit,
                             const std::stop_token& interrupted);
  NextFrame next(TimePoint deadline);
  /// Each returns whether the thread obeyed within the limit.
  bool stop(Duration limit);
  bool quit(Duration limit);

  /// The driver thread.
  void run();

 private:
  void stream();
  /// Hands `next` over once the previous answer has been taken. Returns false after stop().
  bool handOver(NextFrame next);
  bool isStreamRequested() {
    const std::scoped_lock lock(mutex_);
    return isStreamRequested_;
  }

  SteadyClock clock_;   // the camera's clock
  CameraFactory make_;  // kept because it may own objects that the camera uses
  std::shared_ptr<std::atomic<int>> hanging_;

  std::mutex mutex_;  // guards the members below except the camera
  std::condition_variable changed_;
  CameraIdentity identity_;
  StreamRequest request_;
  bool isStreamRequested_ = false;
  bool isQuitRequested_ = false;
  bool isIdle_ = true;
  bool hasQuit_ = false;
  bool isAbandoned_ = false;
  std::optional<Result<StreamFormat>> started_;
  std::optional<NextFrame> handedOver_;  // not taken yet; the end of a stream is never taken

  std::unique_ptr<Camera> camera_;  // used by the driver thread only
};

Result<StreamFormat> WorkerCamera::Worker::start(const StreamRequest& request, Duration limit,
                                                 const std::stop_token& interrupted) {
  const std::stop_callback wake(interrupted, [this] {
    const std::scoped_lock lock(mutex_);
    changed_.notify_all();
  });
  std::unique_lock lock(mutex_);
  if (!isIdle_) {
    return tl::unexpected(Error{.kind = ErrorKind::kBusy,
                                .subject = identity_.backend + ":" + identity_.id,
                                .problem = "its driver still hangs in an earlier call",
                                .remedy = "unplug the camera"});
  }
  request_ = request;
  isIdle_ = false;
  isStreamRequested_ = true;
  started_.reset();
  handedOver_.reset();
  changed_.notify_all();
  holdsWithin(changed_, lock, limit,
              [&] { return started_.has_value() || interrupted.stop_requested(); });
  if (started_) return *started_;
  isStreamRequested_ = false;
  if (interrupted.stop_requested()) {
    return tl::unexpected(Error{.kind = ErrorKind::kBusy,
                                .subject = identity_.backend + ":" + identity_.id,
                                .problem = "its opening was broken off: the program stops"});
  }
  return tl::unexpected(
      Error{.kind = ErrorKind::kTimeout,
            .subject = identity_.backend + ":" + identity_.id,
            .problem = "its driver gave no answer for " + durationText(limit) + " when opened",
            .remedy = "unplug the camera"});
}

NextFrame WorkerCamera::Worker::next(TimePoint deadline) {
  const auto isThere = [this] { return handedOver_.has_value(); };
  std::unique_lock lock(mutex_);
  if (deadline == kNoDeadline) {
    changed_.wait(lock, isThere);
  } else {
    const std::chrono::steady_clock::time_point until(deadline.time_since_epoch());
    if (!changed_.wait_until(lock, until, isThere)) return CameraTimeout{};
  }
  if (!goesOn(*handedOver_)) return *handedOver_;
  NextFrame next = *std::exchange(handedOver_, std::nullopt);
  changed_.notify_all();
  return next;
}

bool WorkerCamera::Worker::stop(Duration limit) {
  std::unique_lock lock(mutex_);
  isStreamRequested_ = false;
  changed_.notify_all();
  const bool isIdle = holdsWithin(changed_, lock, limit, [this] { return isIdle_; });
  handedOver_.reset();
  return isIdle;
}

bool WorkerCamera::Worker::quit(Duration limit) {
  std::unique_lock lock(mutex_);
  isStreamRequested_ = false;
  isQuitRequested_ = true;
  changed_.notify_all();
  if (holdsWithin(changed_, lock, limit, [this] { return hasQuit_; })) return true;
  isAbandoned_ = true;
  ++*hanging_;
  return false;
}

void WorkerCamera::Worker::run() {
  pthread_setname_np(pthread_self(), "driver");
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return !isIdle_ || isQuitRequested_; });
    if (isIdle_) break;
    const StreamRequest request = request_;
    lock.unlock();
    Result<StreamFormat> format = camera_->start(request);
    const bool isStreaming = format.has_value();
    CameraIdentity identity = camera_->identity();
    lock.lock();
    identity_ = std::move(identity);
    started_ = std::move(format);
    changed_.notify_all();
    lock.unlock();
    if (isStreaming) stream();
    camera_->stop();
    lock.lock();
    isIdle_ = true;
    changed_.notify_all();
  }
  lock.unlock();
  camera_.reset();
  lock.lock();
  hasQuit_ = true;
  if (isAbandoned_) --*hanging_;
  changed_.notify_all();
}

void WorkerCamera::Worker::stream() {
  while (isStreamRequested()) {
    NextFrame next = camera_->next(clock_.now() + kPollInterval);
    if (std::holds_alternative<CameraTimeout>(next)) continue;
    const bool isLast = !goesOn(next);
    if (!handOver(std::move(next))) return;
    if (!isLast) continue;
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !isStreamRequested_; });
    return;
  }
}

bool WorkerCamera::Worker::handOver(NextFrame next) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !isStreamRequested_ || !handedOver_; });
  if (!isStreamRequested_) return false;
  handedOver_ = std::move(next);
  changed_.notify_all();
  return true;
}

WorkerCamera::WorkerCamera(CameraFactory make, WorkerLimits limits,
                           std::shared_ptr<std::atomic<int>> hanging, std::stop_token interrupted)
    : limits_(limits),
      hanging_(hanging ? std::move(hanging) : std::make_shared<std::atomic<int>>(0)),
      interrupted_(std::move(interrupted)),
      worker_(std::make_shared<Worker>(std::move(make), hanging_)),
      thread_([worker = worker_] { worker->run(); }) {}

WorkerCamera::~WorkerCamera() {
  stop();
  if (worker_->quit(isHanging_ ? Duration::zero() : limits_.stop)) {
    thread_.join();
  } else {
    thread_.detach();  // it owns what it uses
  }
}

CameraIdentity WorkerCamera::identity() const {
  return worker_->identity();
}

Result<StreamFormat> WorkerCamera::start(const StreamRequest& request) {
  if (const int count = *hanging_; count >= limits_.maxHanging) {
    const CameraIdentity who = identity();
    return tl::unexpected(Error{
        .kind = ErrorKind::kBusy,
        .subject = who.backend + ":" + who.id,
        .problem = std::to_string(count) + " earlier openings of cameras still hang in a driver",
        .remedy = "unplug the camera, or start the program anew"});
  }
  return worker_->start(request, limits_.start, interrupted_);
}

NextFrame WorkerCamera::next(TimePoint deadline) {
  return worker_->next(deadline);
}

void WorkerCamera::stop() {
  isHanging_ = !worker_->stop(isHanging_ ? Duration::zero() : limits_.stop);
}

CameraWrapper onDriverThreads(WorkerLimits limits) {
  return [limits, hanging = std::make_shared<std::atomic<int>>(0)](CameraFactory make,
                                                                   std::stop_token stop) {
    return std::make_unique<WorkerCamera>(std::move(make), limits, hanging, std::move(stop));
  };
}

}  // namespace pleinair::hal
