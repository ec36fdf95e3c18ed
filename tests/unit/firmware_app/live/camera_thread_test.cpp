#include "firmware_app/live/camera_thread.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;

constexpr hal::Duration kLong = 10s;
constexpr hal::FrameFormat kFormat{.pixelFormat = hal::PixelFormat::kGrey8, .size = {4, 2}};

/// Answers what the test feeds it, and waits where that is nothing yet.
class FedCamera final : public hal::Camera {
 public:
  hal::CameraIdentity identity() const override { return {"fed", "fed", "fed"}; }

  hal::Result<hal::StreamFormat> start(const hal::StreamRequest& request) override {
    const std::scoped_lock lock(mutex_);
    threads_.push_back(std::this_thread::get_id());
    ++starts_;
    request_ = request;
    if (starts_ >= failsFromStart_) {
      return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kBusy, .subject = "fed"});
    }
    return hal::StreamFormat{.frame = kFormat};
  }

  hal::NextFrame next(hal::TimePoint) override {
    std::unique_lock lock(mutex_);
    threads_.push_back(std::this_thread::get_id());
    if (!fed_.wait_for(lock, 20ms, [this] { return !frames_.empty(); })) {
      return hal::CameraTimeout{};
    }
    hal::NextFrame next = std::move(frames_.front());
    frames_.pop_front();
    ++handed_;
    fed_.notify_all();
    return next;
  }

  void stop() override {
    const std::scoped_lock lock(mutex_);
    threads_.push_back(std::this_thread::get_id());
    ++stops_;
  }

  void feed(std::deque<hal::NextFrame> frames) {
    const std::scoped_lock lock(mutex_);
    for (hal::NextFrame& each : frames) frames_.push_back(std::move(each));
    fed_.notify_all();
  }
  /// Waits until the camera was asked for one more than it has: what was fed has been handed over.
  void waitUntilEaten() {
    std::unique_lock lock(mutex_);
    fed_.wait(lock, [this] { return frames_.empty(); });
    const std::size_t calls = threads_.size();
    lock.unlock();
    for (bool asked = false; !asked; std::this_thread::yield()) {
      const std::scoped_lock again(mutex_);
      asked = threads_.size() > calls;
    }
  }
  bool isAllOnOneThread() const {
    const std::scoped_lock lock(mutex_);
    for (const std::thread::id id : threads_) {
      if (id != threads_.front() || id == std::this_thread::get_id()) return false;
    }
    return true;
  }
  int starts() const {
    const std::scoped_lock lock(mutex_);
    return starts_;
  }
  int stops() const {
    const std::scoped_lock lock(mutex_);
    return stops_;
  }
  void failFromStart(int number) { failsFromStart_ = number; }
  hal::StreamRequest request() const {
    const std::scoped_lock lock(mutex_);
    return request_;
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable fed_;
  std::deque<hal::NextFrame> frames_;
  std::vector<std::thread::id> threads_;
  hal::StreamRequest request_;
  int starts_ = 0;
  int stops_ = 0;
  int handed_ = 0;
  int failsFromStart_ = 1000;
};

hal::CapturedFrame frame(std::uint64_t sequence, std::uint64_t droppedBefore = 0) {
  return {.sequence = sequence, .droppedBefore = droppedBefore};
}

class CameraThreadTest : public testing::Test {
 protected:
  FedCamera camera_;
  hal::SteadyClock clock_;
};

TEST_F(CameraThreadTest, SaysWhatTheCameraDelivers) {
  CameraThread thread(camera_, clock_, {.size = hal::FrameSize{4, 2}});
  EXPECT_EQ(thread.format().frame, kFormat);
  EXPECT_EQ(camera_.request().size, (hal::FrameSize{4, 2}));
}

TEST_F(CameraThreadTest, ThrowsWhereTheCameraDoesNotStart) {
  camera_.failFromStart(1);
  CameraThread thread(camera_, clock_);
  EXPECT_THROW(thread.format(), hal::StartupError);
}

TEST_F(CameraThreadTest, HandsOutNothingBeforeItBeginsAndStartsAnew) {
  camera_.feed({frame(0)});
  CameraThread thread(camera_, clock_);
  thread.format();
  EXPECT_FALSE(thread.take(0ms).frame);
  EXPECT_EQ(camera_.starts(), 1);
  thread.begin();
  EXPECT_TRUE(thread.take(kLong).frame);
  EXPECT_EQ(camera_.starts(), 2);
}

TEST_F(CameraThreadTest, GivesTheNewestFrameAndCountsTheOthers) {
  CameraThread thread(camera_, clock_);
  thread.begin();
  camera_.feed({frame(0), frame(3, 2), frame(4)});
  camera_.waitUntilEaten();
  CameraThread::Taken taken = thread.take(kLong);
  ASSERT_TRUE(taken.frame);
  EXPECT_EQ(taken.frame->sequence, 4u);
  EXPECT_EQ(taken.replaced, 2u);
  EXPECT_EQ(taken.leftOut, 2u);
  EXPECT_FALSE(taken.hasEnded);
  taken = thread.take(0ms);
  EXPECT_FALSE(taken.frame);
  EXPECT_EQ(taken.replaced + taken.leftOut, 0u) << "counted once";
}

TEST_F(CameraThreadTest, HoldsNoFrameThatWasReplaced) {
  CameraThread thread(camera_, clock_);
  thread.begin();
  auto lease = std::make_shared<int>();
  hal::CapturedFrame old = frame(0);
  old.lease = lease;
  camera_.feed({std::move(old), frame(1)});
  camera_.waitUntilEaten();
  EXPECT_EQ(lease.use_count(), 1) << "given back to the camera";
}

TEST_F(CameraThreadTest, GoesOnAfterTimeoutsAndChangesOfFormat) {
  CameraThread thread(camera_, clock_);
  thread.begin();
  camera_.feed({hal::CameraTimeout{}, hal::FormatChanged{}, frame(5)});
  const CameraThread::Taken taken = thread.take(kLong);
  ASSERT_TRUE(taken.frame);
  EXPECT_EQ(taken.frame->sequence, 5u);
}

TEST_F(CameraThreadTest, EndsAfterTheLastFrame) {
  CameraThread thread(camera_, clock_);
  thread.begin();
  camera_.feed({frame(0), hal::EndOfStream{}});
  CameraThread::Taken taken = thread.take(kLong);
  EXPECT_TRUE(taken.frame);
  do taken = thread.take(kLong);
  while (!taken.hasEnded);
  EXPECT_FALSE(taken.frame);
  EXPECT_FALSE(taken.failure);
  EXPECT_TRUE(thread.take(kLong).hasEnded) << "and stays ended";
}

TEST_F(CameraThreadTest, TellsWhyNoFrameComesAnyMore) {
  const hal::Error cause{.kind = hal::ErrorKind::kDeviceLost, .subject = "fed"};
  for (const hal::NextFrame& ending :
       {hal::NextFrame(hal::CameraLost{cause}), hal::NextFrame(cause),
        hal::NextFrame(hal::EndOfStream{.truncated = cause})}) {
    FedCamera camera;
    CameraThread thread(camera, clock_);
    thread.begin();
    camera.feed({ending});
    const CameraThread::Taken taken = thread.take(kLong);
    EXPECT_TRUE(taken.hasEnded);
    ASSERT_TRUE(taken.failure);
    EXPECT_EQ(taken.failure->kind, hal::ErrorKind::kDeviceLost);
  }
}

TEST_F(CameraThreadTest, TellsThatTheCameraDoesNotStartAgain) {
  camera_.failFromStart(2);
  CameraThread thread(camera_, clock_);
  thread.format();
  thread.begin();
  const CameraThread::Taken taken = thread.take(kLong);
  ASSERT_TRUE(taken.failure);
  EXPECT_EQ(taken.failure->kind, hal::ErrorKind::kBusy);
}

TEST_F(CameraThreadTest, StopsInAnyStateAndLeavesWhatCameLast) {
  { const CameraThread never(camera_, clock_); }
  EXPECT_GE(camera_.stops(), 1);
  CameraThread thread(camera_, clock_);
  thread.begin();
  camera_.feed({frame(7)});
  camera_.waitUntilEaten();
  thread.stop();
  thread.stop();
  EXPECT_EQ(thread.take(0ms).frame->sequence, 7u);
  EXPECT_FALSE(thread.take(0ms).frame);
}

TEST_F(CameraThreadTest, CallsTheCameraFromOneThread) {
  {
    CameraThread thread(camera_, clock_);
    thread.format();
    thread.begin();
    camera_.feed({frame(0)});
    EXPECT_TRUE(thread.take(kLong).frame);
  }
  EXPECT_TRUE(camera_.isAllOnOneThread());
}

}  // namespace
}  // namespace pleinair::app
