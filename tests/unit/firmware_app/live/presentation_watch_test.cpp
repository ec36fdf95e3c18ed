#include "firmware_app/live/status/presentation_watch.h"

#include <gtest/gtest.h>

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;

class PresentationWatchTest : public testing::Test {
 protected:
  /// A second passes; every thread turns.
  bool progress() {
    now_ += 1s;
    if (framesCome_) ++seen_.arrived;
    for (OutputProgress& each : seen_.outputs) ++each.steps;
    watch_.update(seen_, now_);
    return watch_.takeProgress();
  }
  /// Whether there is progress after so many seconds, in each of which it shows something.
  bool showsFor(OutputProgress& display, int seconds) {
    bool isAlive = true;
    for (int i = 0; i < seconds; ++i) {
      ++display.shown;
      isAlive = progress();
    }
    return isAlive;
  }
  OutputProgress& add(const std::string& name, bool isScreen) {
    return seen_.outputs.emplace_back(OutputProgress{.name = name, .isScreen = isScreen});
  }

  PresentationWatch watch_;
  PresentationWatch::Seen seen_;
  hal::TimePoint now_{100s};
  bool framesCome_ = true;
};

TEST_F(PresentationWatchTest, IsNothingWithoutOutputs) {
  EXPECT_FALSE(progress());
  EXPECT_FALSE(watch_.hasShown());
}

TEST_F(PresentationWatchTest, IsWhatAScreenShows) {
  OutputProgress& display = add("display", true);
  display.shown = 1;
  EXPECT_TRUE(progress());
  EXPECT_TRUE(watch_.hasShown());
  EXPECT_FALSE(progress()) << "its thread turns, but it shows nothing: it hangs";
  ++display.submitted;
  EXPECT_FALSE(progress());
  ++display.shown;
  EXPECT_TRUE(progress());
}

TEST_F(PresentationWatchTest, ExcusesADisplayThatIsOff) {
  OutputProgress& display = add("display", true);
  EXPECT_TRUE(progress());
  EXPECT_FALSE(watch_.hasShown());
  display.isExcused = true;
  EXPECT_TRUE(progress());
  EXPECT_TRUE(progress());
  --display.steps;
  EXPECT_FALSE(progress()) << "unless its thread hangs";
}

TEST_F(PresentationWatchTest, ExcusesALoopbackThatGetsNothing) {
  OutputProgress& loopback = add("loopback", false);
  EXPECT_TRUE(progress());
  EXPECT_TRUE(progress());
  ++loopback.submitted;
  EXPECT_FALSE(progress()) << "it got a frame and did not show it";
  ++loopback.shown;
  EXPECT_TRUE(progress());
}

TEST_F(PresentationWatchTest, ExcusesALoopbackThatNobodyReads) {
  add("display", true);
  OutputProgress& loopback = add("loopback", false);
  for (int i = 0; i < 300; ++i) {
    ++seen_.outputs[0].shown;
    ++loopback.submitted;
    ++loopback.skipped;
    ASSERT_TRUE(progress());
  }
  ++seen_.outputs[0].shown;
  ++loopback.submitted;
  EXPECT_FALSE(progress()) << "it hangs";
  seen_.outputs[0].shown = 0;
  watch_.update(seen_, now_);
  EXPECT_TRUE(watch_.hasShown()) << "the loopback had pictures";
}

TEST_F(PresentationWatchTest, IsThatOfAllOutputs) {
  add("display", true).shown = 1;
  add("second", true).shown = 1;
  EXPECT_TRUE(progress());
  ++seen_.outputs[0].shown;
  EXPECT_FALSE(progress());
  ++seen_.outputs[1].shown;
  EXPECT_TRUE(progress());
}

TEST_F(PresentationWatchTest, EndsWherePaintingHangsBehindAWaitingPicture) {
  OutputProgress& display = add("display", true);
  seen_.expectsPaintings = true;
  seen_.painted = 5;
  EXPECT_TRUE(showsFor(display, 60));
  EXPECT_FALSE(showsFor(display, 2));
  ++seen_.painted;
  EXPECT_TRUE(showsFor(display, 30));
  seen_.expectsPaintings = false;  // the camera is gone
  EXPECT_TRUE(showsFor(display, 300));
}

TEST_F(PresentationWatchTest, ExpectsNoPaintingsOfACameraThatWaitsForItsTrigger) {
  OutputProgress& display = add("display", true);
  seen_.expectsPaintings = true;
  seen_.painted = 5;
  seen_.isTriggered = true;
  EXPECT_TRUE(showsFor(display, 1));
  framesCome_ = false;
  for (int i = 0; i < 300; ++i) ASSERT_TRUE(progress()) << "the painting stays";
  ++seen_.arrived;
  EXPECT_FALSE(progress()) << "its screen hangs";
  EXPECT_TRUE(showsFor(display, 59));
  EXPECT_FALSE(showsFor(display, 2)) << "the frame that came is not painted";
}

}  // namespace
}  // namespace pleinair::app
