#include "firmware_app/live/screens/waiting_state.h"

#include <chrono>
#include <cstdint>

#include <gtest/gtest.h>

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;
using hal::CameraState;

constexpr hal::TimePoint kStart{100s};

class WaitingStateTest : public testing::Test {
 protected:
  Awaited update(hal::TimePoint now) {
    if (framesCome_) ++camera_.arrived;
    state_.update({.camera = camera_,
                   .hasBegun = hasBegun_,
                   .hasPainter = hasPainter_,
                   .isRenewing = isRenewing_,
                   .painted = painted_},
                  now);
    return state_.awaited(now);
  }
  void paint() {
    camera_.format = hal::StreamFormat{};
    camera_.state = CameraState::kStreaming;
    hasBegun_ = hasPainter_ = true;
  }

  runtime::CaptureStage::Status camera_;
  bool hasBegun_ = false;
  bool hasPainter_ = false;
  bool isRenewing_ = false;
  bool framesCome_ = true;
  std::uint64_t painted_ = 0;
  WaitingState state_;
};

TEST_F(WaitingStateTest, FollowsTheStartOfARun) {
  EXPECT_EQ(update(kStart), Awaited::kCamera);
  camera_.state = CameraState::kBackingOff;
  EXPECT_EQ(update(kStart + 60s), Awaited::kCamera) << "it waits for as long as it takes";
  camera_.format = hal::StreamFormat{};
  camera_.state = CameraState::kStreaming;
  EXPECT_EQ(update(kStart + 61s), Awaited::kPainter);
  EXPECT_EQ(update(kStart + 91s), Awaited::kPainter) << "compiling may take long";
  hasBegun_ = hasPainter_ = true;
  EXPECT_EQ(update(kStart + 92s), Awaited::kNothing);
}

TEST_F(WaitingStateTest, TellsAPainterThatIsMadeAnewFromALostOne) {
  paint();
  EXPECT_EQ(update(kStart), Awaited::kNothing);
  isRenewing_ = true;
  EXPECT_EQ(update(kStart + 1s), Awaited::kNothing) << "the old one is finishing its frames";
  hasPainter_ = false;
  EXPECT_EQ(update(kStart + 2s), Awaited::kPainter);
  isRenewing_ = false;
  EXPECT_EQ(update(kStart + 3s), Awaited::kGpu);
}

TEST_F(WaitingStateTest, NamesTheCameraThatIsLostOrSilent) {
  paint();
  EXPECT_EQ(update(kStart), Awaited::kNothing);
  for (const CameraState state : {CameraState::kStalled, CameraState::kLost,
                                  CameraState::kBackingOff, CameraState::kOpening}) {
    camera_.state = state;
    EXPECT_EQ(update(kStart + 1s), Awaited::kCameraAgain) << hal::toString(state);
  }
  camera_.state = CameraState::kStreaming;
  EXPECT_EQ(update(kStart + 60s), Awaited::kNothing) << "not too slow: it has just come";
}

TEST_F(WaitingStateTest, TheCameraComesBeforeTheGpu) {
  paint();
  hasPainter_ = false;
  EXPECT_EQ(update(kStart), Awaited::kGpu);
  camera_.state = CameraState::kLost;
  EXPECT_EQ(update(kStart), Awaited::kCameraAgain);
}

TEST_F(WaitingStateTest, IsTooSlowOnceNothingIsPaintedForAWhile) {
  paint();
  EXPECT_EQ(update(kStart), Awaited::kNothing);
  EXPECT_EQ(update(kStart + WaitingState::kTooSlow), Awaited::kNothing);
  EXPECT_EQ(update(kStart + WaitingState::kTooSlow + 1ms), Awaited::kPace) << "none at all";
  ++painted_;
  EXPECT_EQ(update(kStart + 10s), Awaited::kNothing);
  EXPECT_EQ(update(kStart + 13s), Awaited::kNothing);
  EXPECT_EQ(update(kStart + 15s), Awaited::kPace);
}

TEST_F(WaitingStateTest, ACameraThatWaitsForItsTriggerIsNotTooSlow) {
  paint();
  camera_.format->isTriggered = true;
  EXPECT_EQ(update(kStart), Awaited::kNothing);
  framesCome_ = false;
  EXPECT_EQ(update(kStart + 60s), Awaited::kNothing);
  framesCome_ = true;
  EXPECT_EQ(update(kStart + 61s), Awaited::kNothing);
  framesCome_ = false;
  EXPECT_EQ(update(kStart + 66s), Awaited::kPace) << "the frame that came is not painted";
}

TEST_F(WaitingStateTest, TheEndOfARecordingIsNothingToWaitFor) {
  paint();
  camera_.state = CameraState::kEnded;
  camera_.hasEnded = true;
  EXPECT_EQ(update(kStart), Awaited::kNothing);
  EXPECT_EQ(update(kStart + 60s), Awaited::kNothing) << "nor is it too slow";
}

TEST(WaitingText, NamesWhatIsAwaited) {
  runtime::CaptureStage::Status camera;
  const std::string choice = "v4l2:/dev/video7";
  EXPECT_EQ(waitingText(Awaited::kCamera, camera, choice),
            (present::WaitingText{.title = "Waiting for the camera", .detail = choice}));
  camera.cause = hal::Error{.kind = hal::ErrorKind::kNotFound,
                            .subject = "/dev/video7",
                            .problem = "no such camera",
                            .remedy = "plug it in"};
  EXPECT_EQ(waitingText(Awaited::kCamera, camera, choice).detail, "/dev/video7: no such camera");
  camera.camera = hal::CameraIdentity{.backend = "v4l2", .id = "usb-1", .description = "C920"};
  EXPECT_EQ(waitingText(Awaited::kCameraAgain, camera, choice).detail, "C920");
  for (const Awaited each : {Awaited::kCamera, Awaited::kPainter, Awaited::kCameraAgain,
                             Awaited::kGpu, Awaited::kPace}) {
    EXPECT_FALSE(waitingText(each, camera, choice).title.empty());
  }
}

}  // namespace
}  // namespace pleinair::app
