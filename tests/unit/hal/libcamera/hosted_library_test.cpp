#include "hal/cameras/libcamera/hosted_library.h"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include "hal/cameras/libcamera/host_channel.h"
#include "hal/cameras/libcamera/host_server.h"
#include "hal/cameras/libcamera/libcamera_camera.h"
#include "tests/support/fake_libcamera.h"
#include "tests/support/process_resources.h"

namespace pleinair::hal::libcamera {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// What a library does to its process.
struct Misdeeds {
  bool abortsInList = false, abortsInStop = false, hangsInStop = false, hangsInOpen = false;
  std::optional<int> abortsAfter;  ///< frames
};

class BadStream final : public Stream {
 public:
  BadStream(std::unique_ptr<Stream> stream, Misdeeds misdeeds)
      : stream_(std::move(stream)), misdeeds_(misdeeds) {}
  ~BadStream() override {
    if (misdeeds_.abortsInStop) std::abort();
    if (misdeeds_.hangsInStop) std::this_thread::sleep_for(1h);
  }
  std::size_t bufferCount() const override { return stream_->bufferCount(); }
  std::shared_ptr<const BufferMemory> memory(std::size_t index) const override {
    return stream_->memory(index);
  }
  std::shared_ptr<const BufferMemory> lumaMemory(std::size_t index) const override {
    return stream_->lumaMemory(index);
  }
  std::optional<Completed> pop(Duration timeout) override {
    if (misdeeds_.abortsAfter == frames_) std::abort();
    auto completed = stream_->pop(timeout);
    if (completed) ++frames_;
    return completed;
  }
  int push(std::size_t index) override { return stream_->push(index); }
  bool isLost() const override { return stream_->isLost(); }

 private:
  std::unique_ptr<Stream> stream_;
  Misdeeds misdeeds_;
  int frames_ = 0;
};

class BadDevice final : public Device {
 public:
  BadDevice(std::unique_ptr<Device> device, Misdeeds misdeeds)
      : device_(std::move(device)), misdeeds_(misdeeds) {}
  std::string description() const override { return device_->description(); }
  std::vector<OfferedFormat> formats() override { return device_->formats(); }
  Result<StreamAnswer> configure(const StreamWish& wish) override {
    return device_->configure(wish);
  }
  std::optional<ControlRange> range(Control control) override { return device_->range(control); }
  bool hasAutomatic(Control control) override { return device_->hasAutomatic(control); }
  std::optional<std::array<Duration, 2>> periods() override { return device_->periods(); }
  Result<std::unique_ptr<Stream>> start(const StartSettings& settings) override {
    auto stream = device_->start(settings);
    if (!stream) return tl::unexpected(stream.error());
    return std::make_unique<BadStream>(*std::move(stream), misdeeds_);
  }

 private:
  std::unique_ptr<Device> device_;
  Misdeeds misdeeds_;
};

class BadLibrary final : public Library {
 public:
  BadLibrary(Library& library, Misdeeds misdeeds) : library_(library), misdeeds_(misdeeds) {}
  Result<std::vector<FoundCamera>> list() override {
    if (misdeeds_.abortsInList) std::abort();
    return library_.list();
  }
  Result<std::unique_ptr<Device>> open(const std::string& id) override {
    if (misdeeds_.hangsInOpen) std::this_thread::sleep_for(1h);
    auto device = library_.open(id);
    if (!device) return tl::unexpected(device.error());
    return std::make_unique<BadDevice>(*std::move(device), misdeeds_);
  }

 private:
  Library& library_;
  Misdeeds misdeeds_;
};

/// A camera in a process of its own, on a fake library there.
class HostedLibraryTest : public testing::Test {
 protected:
  HostedLibraryTest() {
    sensor.isShared = true;
    sensor.period = 5ms;
    sensor.formats[0].sizes = {{64, 48}};
  }

  Result<StartedHost> startHost() {
    auto calls = HostChannel::pair();
    auto frames = HostChannel::pair();
    EXPECT_TRUE(calls && frames);
    const pid_t process = fork();
    if (process == 0) {
      (*calls)[0].reset();
      (*frames)[0].reset();
      // Aborts are what is asked for, and no news.
      if (std::freopen("/dev/null", "w", stderr) == nullptr) _exit(2);
      SteadyClock clock;
      support::FakeLibcamera library(clock);
      library.plug(sensor);
      BadLibrary bad(library, misdeeds);
      serveLibrary(
          bad, std::move((*calls)[1]), std::move((*frames)[1]),
          {.isDeviceGone = [this] { return isDeviceGone; }, .onHanging = [] { _exit(3); }});
      _exit(0);
    }
    started.push_back(process);
    return StartedHost{
        .calls = std::move((*calls)[0]), .frames = std::move((*frames)[0]), .process = process};
  }

  Result<StreamFormat> start(const StreamRequest& request = {.size = FrameSize{64, 48}}) {
    camera_ = std::make_unique<LibcameraCamera>(sensor.id, options, library_, clock_);
    return camera_->start(request);
  }
  NextFrame next(Duration within = 5s) { return camera_->next(clock_.now() + within); }
  CapturedFrame frame() {
    NextFrame answer = next();
    if (auto* frame = std::get_if<CapturedFrame>(&answer)) return std::move(*frame);
    ADD_FAILURE() << "variant " << answer.index();
    return {};
  }
  /// How long it takes, in ms.
  static double took(const std::function<void()>& what) {
    const auto begin = std::chrono::steady_clock::now();
    what();
    return toMilliseconds(std::chrono::steady_clock::now() - begin);
  }
  static bool isThere(pid_t process) { return kill(process, 0) == 0; }

  support::FakeSensor sensor;
  LibcameraOptions options;
  Misdeeds misdeeds;
  bool isDeviceGone = false;
  std::vector<pid_t> started;
  SteadyClock clock_;
  HostedLibrary library_{[this] { return startHost(); }};
  std::unique_ptr<LibcameraCamera> camera_;
};

TEST_F(HostedLibraryTest, ListsAndRefusesAsTheLibraryDoes) {
  auto found = library_.list();
  ASSERT_TRUE(found) << found.error().message();
  ASSERT_EQ(found->size(), 1u);
  EXPECT_EQ(found->front().id, sensor.id);
  EXPECT_EQ(found->front().model, sensor.model);
  found->clear();
  EXPECT_FALSE(isThere(started[0])) << "the process of a listing lives while its cameras are held";
  sensor.isBusy = true;
  const auto device = library_.open(sensor.id);
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().kind, ErrorKind::kBusy);
  EXPECT_EQ(device.error().problem, "cannot be taken");
}

TEST_F(HostedLibraryTest, ACameraTakesOverTheProcessThatFoundIt) {
  auto found = library_.list();
  ASSERT_TRUE(found);
  ASSERT_TRUE(start());
  EXPECT_EQ(started.size(), 1u) << "it has looked for devices already";
  found->clear();
  EXPECT_EQ(frame().health, FrameHealth::kValid) << "and is the camera's now";
  const auto second = library_.open(sensor.id);
  EXPECT_EQ(started.size(), 2u) << "each open camera has its own";
  camera_.reset();
  EXPECT_FALSE(isThere(started[0]));
}

TEST_F(HostedLibraryTest, ACameraThatDoesNotStartIsLetGoThoughItsListingIsHeld) {
  const auto found = library_.list();
  ASSERT_TRUE(found);
  auto device = library_.open(sensor.id);
  ASSERT_TRUE(device);
  EXPECT_EQ(started.size(), 1u);
  device->reset();
  EXPECT_FALSE(isThere(started[0])) << "it would keep the camera from whoever comes next";
}

TEST_F(HostedLibraryTest, AProcessThatEndedSinceItsListingHoldsUpNoCamera) {
  const auto found = library_.list();
  ASSERT_TRUE(found);
  kill(started[0], SIGKILL);  // as libcamera does when a device returns that it has not let go of
  const auto format = start();
  ASSERT_TRUE(format) << format.error().message();
  EXPECT_EQ(started.size(), 2u);
  EXPECT_EQ(frame().health, FrameHealth::kValid);
}

TEST_F(HostedLibraryTest, FramesAreInMemoryOfBoth) {
  const auto format = start();
  ASSERT_TRUE(format) << format.error().message();
  EXPECT_EQ(format->frame.pixelFormat, PixelFormat::kNv12);
  EXPECT_EQ(format->memory, FrameMemory::kExported);
  EXPECT_EQ(camera_->identity().description, "imx708");
  std::optional<TimePoint> last;
  for (int i = 0; i < 100; ++i) {
    const CapturedFrame taken = frame();
    ASSERT_TRUE(taken.image.isComplete());
    EXPECT_GE(taken.dmaBufs[0].fd, 0);
    // Byte i of frame n is i + n: which frame it is, the first byte tells.
    const FrameMapping mapped = taken.image.map();
    const std::uint8_t number = mapped.view().row(0, 0)[0];
    EXPECT_EQ(mapped.view().row(0, 1)[0], static_cast<std::uint8_t>(64 + number));
    EXPECT_EQ(number, static_cast<std::uint8_t>(taken.sequence));
    EXPECT_EQ(taken.health, FrameHealth::kValid);
    if (last) {
      EXPECT_GT(taken.captureTime, *last);
    }
    last = taken.captureTime;
  }
}

TEST_F(HostedLibraryTest, SecondImagesAreInMemoryOfBoth) {
  sensor.luma = 0x3231564E;  // NV12
  sensor.formats[0].sizes = {{128, 96}};
  const auto format = start({.size = FrameSize{128, 96}, .lumaSidePx = 32});
  ASSERT_TRUE(format) << format.error().message();
  ASSERT_TRUE(format->luma) << format->lumaNote;
  EXPECT_EQ(format->luma->size, (FrameSize{32, 24}));
  for (int i = 0; i < 20; ++i) {
    const CapturedFrame taken = frame();
    EXPECT_EQ(taken.health, FrameHealth::kValid);
    ASSERT_TRUE(taken.luma && taken.luma->isComplete());
    EXPECT_EQ(taken.luma->map().view().row(0, 1)[0],
              static_cast<std::uint8_t>(128 + 32 + taken.sequence));
  }
}

TEST_F(HostedLibraryTest, ControlsAndWishesArrive) {
  sensor.ranges[Control::kExposure] = {.min = 100, .max = 20'000};
  sensor.ranges[Control::kGain] = {.min = 1, .max = 16};
  sensor.automatic = {Control::kGain};
  sensor.periods = std::array<Duration, 2>{5ms, 100ms};
  StreamRequest request{.size = FrameSize{64, 48}, .framePeriod = Duration(20ms)};
  request.controls.exposure = Duration(3ms);
  request.controls.gain = Automatic{};
  const auto format = start(request);
  ASSERT_TRUE(format) << format.error().message();
  EXPECT_EQ(format->framePeriod, Duration(20ms));
  request.controls.focus = 0.5;
  const auto refused = start(request);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message(),
            "libcamera:" + sensor.id +
                ": has no control of focus; remove the setting; the device has exposure (no auto), "
                "gain");
}

TEST_F(HostedLibraryTest, ALibraryThatAbortsInMidStreamIsALostCamera) {
  misdeeds.abortsAfter = 3;
  ASSERT_TRUE(start());
  for (int i = 0; i < 3; ++i) frame();
  NextFrame answer;
  const double time = took([&] { answer = next(); });
  const auto* const lost = std::get_if<CameraLost>(&answer);
  ASSERT_NE(lost, nullptr) << "variant " << answer.index();
  EXPECT_THAT(lost->cause.message(), HasSubstr("the process of libcamera was ended by signal 6"));
  EXPECT_LT(time, 1000) << "it need not be waited for";

  misdeeds = {};
  ASSERT_TRUE(start()) << "another process";
  frame();
}

TEST_F(HostedLibraryTest, ALibraryThatAbortsWhenItIsStoppedEndsNothingElse) {
  misdeeds.abortsInStop = true;
  ASSERT_TRUE(start());
  frame();
  EXPECT_LT(took([&] { camera_->stop(); }), 1000);
  EXPECT_FALSE(isThere(started.back())) << "no process is left";
}

TEST_F(HostedLibraryTest, ALibraryThatHangsWhenItIsStoppedIsKilledWithinASecond) {
  misdeeds.hangsInStop = true;
  ASSERT_TRUE(start());
  frame();
  EXPECT_LT(took([&] { camera_->stop(); }), 1000);
  EXPECT_FALSE(isThere(started.back()));
}

TEST_F(HostedLibraryTest, ALibraryThatAbortsInAListingIsAnError) {
  misdeeds.abortsInList = true;
  const auto found = library_.list();
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().message(),
            "libcamera: the process of libcamera was ended by signal 6; its last lines in the log "
            "say why");
}

TEST_F(HostedLibraryTest, ADeviceWhoseNodesAreGoneIsLostWithoutAWord) {
  sensor.frames[2] = {.isSilent = true};
  isDeviceGone = true;
  misdeeds.abortsInStop = true;  // as libcamera 0.0.3 does then
  ASSERT_TRUE(start());
  frame();
  frame();
  NextFrame answer;
  // 3 periods and 200 ms, and what a busy machine takes.
  EXPECT_LT(took([&] { answer = next(); }), 1000);
  const auto* const lost = std::get_if<CameraLost>(&answer);
  ASSERT_NE(lost, nullptr) << "variant " << answer.index();
  EXPECT_THAT(lost->cause.message(), HasSubstr("is unplugged, or its driver is gone"));
  EXPECT_LT(took([&] { camera_->stop(); }), 1000);
}

TEST_F(HostedLibraryTest, ASilentDeviceThatIsThereIsATimeout) {
  sensor.frames[1] = {.isSilent = true};
  ASSERT_TRUE(start());
  frame();
  EXPECT_TRUE(std::holds_alternative<CameraTimeout>(next(400ms)));
}

TEST_F(HostedLibraryTest, BuffersThatAreRefusedEndTheStream) {
  sensor.pushAnswer = -EINVAL;
  ASSERT_TRUE(start());
  NextFrame answer;
  do {
    answer = next();
  } while (std::holds_alternative<CapturedFrame>(answer));
  ASSERT_TRUE(std::holds_alternative<Error>(answer)) << "variant " << answer.index();
  EXPECT_THAT(std::get<Error>(answer).message(), HasSubstr("refuses to requeue its buffers"));
}

TEST_F(HostedLibraryTest, BuffersWithoutDescriptorsAreRefused) {
  sensor.isShared = false;
  const auto format = start();
  ASSERT_FALSE(format);
  EXPECT_THAT(format.error().message(), HasSubstr("has buffers that cannot be shared"));
}

TEST_F(HostedLibraryTest, FramesOutliveTheProcess) {
  ASSERT_TRUE(start());
  const CapturedFrame kept = frame();
  const std::uint8_t first = kept.image.map().view().row(0, 0)[0];
  camera_->stop();
  EXPECT_FALSE(isThere(started.back()));
  EXPECT_EQ(kept.image.map().view().row(0, 1)[0], static_cast<std::uint8_t>(64 + first));
  camera_.reset();
}

TEST_F(HostedLibraryTest, StartsAndStopsLeaveNothing) {
  ASSERT_TRUE(start());
  camera_.reset();
  const support::ProcessResources before = support::ProcessResources::now();
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(start()) << i;
    frame();
    camera_.reset();
  }
  const support::ProcessResources after = support::ProcessResources::now();
  EXPECT_EQ(after.descriptors, before.descriptors);
  for (const pid_t each : started) EXPECT_FALSE(isThere(each)) << each;
}

TEST(RemovedNodes, AreSeenByTheLinksOfOpenFiles) {
  const std::string folder = testing::TempDir() + "removed_nodes";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  const auto link = [&](const char* target, const char* name) {
    std::filesystem::create_symlink(target, folder + "/" + name);
  };
  link("/dev/video0", "3");
  link("/dev/shm/frames (deleted)", "4");
  link("socket:[4711]", "5");
  EXPECT_FALSE(holdsRemovedNode(folder));
  link("/dev/v4l-subdev2 (deleted)", "6");
  EXPECT_TRUE(holdsRemovedNode(folder));
  EXPECT_FALSE(holdsRemovedNode(folder + "/none"));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace pleinair::hal::libcamera
