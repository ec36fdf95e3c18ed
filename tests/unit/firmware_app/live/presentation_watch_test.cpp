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
    for (OutputProgress& each : seen_.outputs) ++each.steps;
    watch_.update(seen_, now_);
    return watch_.takeProgress();
  }
  OutputProgress& add(const std::string& name, bool isScreen) {
    return seen_.outputs.emplace_back(OutputProgress{.name = name, .isScreen = isScreen});
  }

  PresentationWatch watch_;
  PresentationWatch::Seen seen_;
  hal::TimePoint now_{100s};
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
  const auto showsFor = [&](int seconds) {
    bool isAlive = true;
    for (int i = 0; i < seconds; ++i) {
      ++display.shown;
      isAlive = progress();
    }
    return isAlive;
  };
  EXPECT_TRUE(showsFor(60));
  EXPECT_FALSE(showsFor(2));
  ++seen_.painted;
  EXPECT_TRUE(showsFor(30));
  seen_.expectsPaintings = false;  // the camera is gone
  EXPECT_TRUE(showsFor(300));
}

}  // namespace
}  // namespace pleinair::app
