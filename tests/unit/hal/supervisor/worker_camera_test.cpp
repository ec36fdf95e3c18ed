#include "hal/supervisor/worker_camera.h"

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/image.h"
#include "hal/supervisor/camera_supervisor.h"

namespace pleinair::hal {
namespace {

using testing::HasSubstr;

/// A driver that the test controls step by step. The test waits for it, so that timing does not
/// depend on a clock.
class Driver {
 public:
  enum class Call { kStart, kNext, kStop };

  void give(NextFrame next) {
    const std::scoped_lock lock(mutex_);
    waiting_.push_back(std::move(next));
    changed_.notify_all();
  }
  /// Waits until two frames were taken; the second cannot be handed over before the first.
  void waitUntilHeldBack() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return taken_ == 2; });
  }
  void hangIn(Call call) {
    const std::scoped_lock lock(mutex_);
    hangs_ = call;
  }
  void letGo() {
    const std::scoped_lock lock(mutex_);
    hangs_.reset();
    changed_.notify_all();
  }
  void waitUntilHanging() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return isHanging_; });
  }
  void waitUntilGone() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return isGone_; });
  }

  // Called by the camera.
  void call(Call call) {
    std::unique_lock lock(mutex_);
    isHanging_ = hangs_ == call;
    changed_.notify_all();
    changed_.wait(lock, [&] { return hangs_ != call; });
    isHanging_ = false;
  }
  NextFrame next() {
    call(Call::kNext);
    std::unique_lock lock(mutex_);
    if (waiting_.empty()) {
      lock.unlock();
      std::this_thread::yield();
      return CameraTimeout{};
    }
    ++taken_;
    changed_.notify_all();
    NextFrame next = std::move(waiting_.front());
    waiting_.erase(waiting_.begin());
    return next;
  }
  void gone() {
    const std::scoped_lock lock(mutex_);
    isGone_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<NextFrame> waiting_;
  std::optional<Call> hangs_;
  int taken_ = 0;
  bool isGone_ = false;
  bool isHanging_ = false;
};

class DrivenCamera final : public Camera {
 public:
  explicit DrivenCamera(std::shared_ptr<Driver> driver) : driver_(std::move(driver)) {}
  ~DrivenCamera() override { driver_->gone(); }
  CameraIdentity identity() const override {
    return {.backend = "driven", .id = "a", .description = {}};
  }
  Result<StreamFormat> start(const StreamRequest&) override {
    driver_->call(Driver::Call::kStart);
    return StreamFormat{};
  }
  NextFrame next(TimePoint) override { return driver_->next(); }
  void stop() override { driver_->call(Driver::Call::kStop); }

 private:
  std::shared_ptr<Driver> driver_;
};

/// A back end with one controlled camera.
class DrivenBackend final : public CameraBackend {
 public:
  explicit DrivenBackend(std::shared_ptr<Driver> driver) : driver_(std::move(driver)) {}
  std::string_view name() const override { return "driven"; }
  Result<std::vector<CameraDescription>> list() override {
    return std::vector<CameraDescription>{{.identity = {.backend = "driven", .id = "a"}}};
  }
  std::unique_ptr<Camera> make(const std::string&, Clock&) override {
    return std::make_unique<DrivenCamera>(driver_);
  }

 private:
  std::shared_ptr<Driver> driver_;
};

CapturedFrame frameNumber(std::uint64_t number, std::uint64_t dropped = 0) {
  return {.image = {}, .dmaBufs = {}, .sequence = number, .droppedBefore = dropped, .lease = {}};
}

class WorkerCameraTest : public testing::Test {
 protected:
  // Long limits, which only a hanging driver reaches, or none in tests of such drivers.
  static constexpr WorkerLimits kPatient{.start = std::chrono::minutes(1),
                                         .stop = std::chrono::minutes(1)};
  static constexpr WorkerLimits kNone{.start = Duration::zero(), .stop = Duration::zero()};

  std::unique_ptr<WorkerCamera> camera(WorkerLimits limits) {
    return std::make_unique<WorkerCamera>(
        [driver = driver_](Clock&) { return std::make_unique<DrivenCamera>(driver); }, limits,
        hanging_);
  }

  std::shared_ptr<Driver> driver_ = std::make_shared<Driver>();
  std::shared_ptr<std::atomic<int>> hanging_ = std::make_shared<std::atomic<int>>(0);
};

TEST_F(WorkerCameraTest, HandsFramesFormatsAndTheEndOverInOrder) {
  const auto worker = camera(kPatient);
  EXPECT_EQ(worker->identity().id, "a");
  ASSERT_TRUE(worker->start({}));
  driver_->give(frameNumber(7));
  EXPECT_EQ(std::get<CapturedFrame>(worker->next(kNoDeadline)).sequence, 7U);
  driver_->give(FormatChanged{});
  driver_->give(frameNumber(8));
  driver_->give(CameraLost{});
  EXPECT_TRUE(std::holds_alternative<FormatChanged>(worker->next(kNoDeadline)));
  EXPECT_EQ(std::get<CapturedFrame>(worker->next(kNoDeadline)).sequence, 8U);
  EXPECT_TRUE(std::holds_alternative<CameraLost>(worker->next(kNoDeadline)));
  EXPECT_TRUE(std::holds_alternative<CameraLost>(worker->next(kNoDeadline))) << "again and again";
}

TEST_F(WorkerCameraTest, DropsNoFrameHoweverLateItIsTaken) {
  const auto worker = camera(kPatient);
  ASSERT_TRUE(worker->start({}));
  driver_->give(frameNumber(1));
  driver_->give(frameNumber(4, 2));
  driver_->give(FormatChanged{});
  driver_->give(frameNumber(6, 1));
  driver_->waitUntilHeldBack();  // one is handed over, one is in the thread's hand
  for (const auto& [sequence, dropped] : {std::pair{1U, 0U}, {4U, 2U}, {6U, 1U}}) {
    NextFrame next = worker->next(kNoDeadline);
    if (std::holds_alternative<FormatChanged>(next)) next = worker->next(kNoDeadline);
    const auto frame = std::get<CapturedFrame>(std::move(next));
    EXPECT_EQ(frame.sequence, sequence);
    EXPECT_EQ(frame.droppedBefore, dropped) << "the camera's own count";
    EXPECT_EQ(frame.underrunsBefore, 0U) << "the camera had buffers";
  }
}

TEST_F(WorkerCameraTest, StopsWhileAFrameIsNotTaken) {
  const auto worker = camera(kPatient);
  ASSERT_TRUE(worker->start({}));
  for (std::uint64_t i = 0; i < 3; ++i) driver_->give(frameNumber(i));
  driver_->waitUntilHeldBack();
  worker->stop();
  ASSERT_TRUE(worker->start({}));
  EXPECT_EQ(std::get<CapturedFrame>(worker->next(kNoDeadline)).sequence, 2U)
      << "of the new session; what was under way went with the old one";
}

TEST_F(WorkerCameraTest, TimesOut) {
  const auto worker = camera(kPatient);
  ASSERT_TRUE(worker->start({}));
  EXPECT_TRUE(std::holds_alternative<CameraTimeout>(worker->next(SteadyClock().now())));
}

TEST_F(WorkerCameraTest, StartsAndStopsAHundredTimes) {
  const auto worker = camera(kPatient);
  for (std::uint64_t i = 0; i < 100; ++i) {
    ASSERT_TRUE(worker->start({}));
    driver_->give(frameNumber(i));
    EXPECT_EQ(std::get<CapturedFrame>(worker->next(kNoDeadline)).sequence, i);
    worker->stop();
  }
  EXPECT_EQ(*hanging_, 0);
}

TEST_F(WorkerCameraTest, ADriverThatHangsInStopDoesNotHoldUpOurs) {
  auto worker = camera({.start = kPatient.start, .stop = Duration::zero()});
  ASSERT_TRUE(worker->start({}));
  driver_->hangIn(Driver::Call::kStop);
  worker->stop();
  const Result<StreamFormat> again = worker->start({});
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().kind, ErrorKind::kBusy);
  EXPECT_THAT(again.error().message(), HasSubstr("driven:a: its driver still hangs"));
  worker.reset();
  EXPECT_EQ(*hanging_, 1);
  driver_->letGo();
  driver_->waitUntilGone();  // the abandoned thread ends by itself, and destroys the camera
}

TEST_F(WorkerCameraTest, ADriverThatHangsInStartIsATimeout) {
  driver_->hangIn(Driver::Call::kStart);
  auto worker = camera(kNone);
  const Result<StreamFormat> format = worker->start({});
  ASSERT_FALSE(format);
  EXPECT_EQ(format.error().kind, ErrorKind::kTimeout);
  EXPECT_THAT(format.error().message(), HasSubstr("gave no answer for 0 ms when opened"));
  worker.reset();
  driver_->letGo();
  driver_->waitUntilGone();
}

TEST_F(WorkerCameraTest, StoppingASupervisorBreaksOffAnOpeningThatHangs) {
  driver_->hangIn(Driver::Call::kStart);
  SteadyClock clock;
  CameraSelector selector({{.backend = std::make_shared<DrivenBackend>(driver_)}}, "driven", clock,
                          onDriverThreads({.start = kPatient.start, .stop = Duration::zero()}));
  {
    CameraSupervisor supervisor(selector, clock);
    std::thread consumer([&] {
      while (!std::holds_alternative<EndOfStream>(supervisor.next(kNoDeadline))) continue;
    });
    driver_->waitUntilHanging();
    supervisor.stop();
    consumer.join();
  }
  EXPECT_FALSE(selector.open({})) << "nothing more";
  driver_->letGo();
  driver_->waitUntilGone();
}

TEST_F(WorkerCameraTest, OpensNothingMoreOnceTooManyHang) {
  *hanging_ = 4;
  const auto worker = camera(kPatient);
  const Result<StreamFormat> format = worker->start({});
  ASSERT_FALSE(format);
  EXPECT_EQ(format.error().kind, ErrorKind::kBusy);
  EXPECT_THAT(format.error().message(), HasSubstr("4 earlier openings of cameras still hang"));
}

TEST_F(WorkerCameraTest, FramesMayOutliveIt) {
  auto worker = camera(kPatient);
  ASSERT_TRUE(worker->start({}));
  const auto lease = std::make_shared<int>(1);
  CapturedFrame given = frameNumber(1);
  given.lease = lease;
  driver_->give(std::move(given));
  NextFrame kept = worker->next(kNoDeadline);
  worker.reset();
  EXPECT_EQ(lease.use_count(), 2);
}

TEST_F(WorkerCameraTest, ASupervisorOnAThreadIsStoppedFromAnother) {
  for (int i = 0; i < 50; ++i) {
    SteadyClock clock;
    CameraSelector selector({{.backend = std::make_shared<DrivenBackend>(driver_)}}, "driven",
                            clock, onDriverThreads(kPatient));
    CameraSupervisor supervisor(selector, clock);
    std::atomic<bool> hasBegun = false;
    std::thread consumer([&] {
      while (!std::holds_alternative<EndOfStream>(supervisor.next(kNoDeadline))) hasBegun = true;
    });
    while (i % 2 == 0 && !hasBegun) std::this_thread::yield();
    supervisor.wake();
    supervisor.devicesChanged();
    EXPECT_FALSE(supervisor.status().reason.empty());
    supervisor.stop();
    consumer.join();
    EXPECT_EQ(supervisor.state(), CameraState::kEnded);
  }
}

}  // namespace
}  // namespace pleinair::hal
