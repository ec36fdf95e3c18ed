#include "firmware_app/live/status/service_reporter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/notify_socket.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

/// A service with WatchdogSec=10 and one display.
class ServiceReporterTest : public testing::Test {
 protected:
  ServiceReporterTest() { seen_.outputs.push_back({.name = "display", .isScreen = true}); }

  /// The main loop turns for so long; a display that works shows a picture in each turn.
  std::vector<std::string> runFor(hal::Duration duration, const std::string& status = "") {
    for (const auto end = now_ + duration; now_ < end; now_ += 10ms) {
      if (!reporter_.isDue(now_)) continue;
      OutputProgress& display = seen_.outputs.front();
      ++display.steps;
      if (shows_) ++display.shown;
      reporter_.update(seen_, status, now_);
    }
    return socket_.take();
  }

  support::TemporaryFolder folder_;
  support::NotifySocket socket_{folder_.path() / "notify"};
  ServiceManager manager_{{.notifySocket = socket_.path(), .watchdogUsec = "10000000"}};
  ServiceReporter reporter_{manager_};
  PresentationWatch::Seen seen_;
  hal::TimePoint now_{100s};
  bool shows_ = true;
};

TEST_F(ServiceReporterTest, IsReadyWithTheFirstPicture) {
  shows_ = false;
  EXPECT_THAT(runFor(1s), testing::Not(testing::Contains("READY=1")));
  shows_ = true;
  EXPECT_THAT(runFor(40ms), testing::Contains("READY=1"));
  EXPECT_THAT(runFor(1s), IsEmpty()) << "once";
}

TEST_F(ServiceReporterTest, FeedsTheWatchdogWhilePicturesAreShown) {
  runFor(1s);
  const std::vector<std::string> messages = runFor(20s);
  EXPECT_GE(messages.size(), 7u);
  EXPECT_LE(messages.size(), 9u);
  for (const std::string& each : messages) EXPECT_EQ(each, "WATCHDOG=1");
}

TEST_F(ServiceReporterTest, StarvesTheWatchdogWhereThePresenterHangs) {
  runFor(20s);
  shows_ = false;
  runFor(3s);  // one may be due of what was shown until then
  EXPECT_THAT(runFor(60s), IsEmpty()) << "though the loop turns";
  shows_ = true;
  EXPECT_THAT(runFor(1s), ElementsAre("WATCHDOG=1")) << "a control";
}

TEST_F(ServiceReporterTest, WaitsForADisplayWithoutBecomingReady) {
  shows_ = false;
  seen_.outputs.front().isExcused = true;
  EXPECT_THAT(runFor(10s), testing::Each("EXTEND_TIMEOUT_USEC=30000000"));
  EXPECT_THAT(runFor(10s), testing::SizeIs(testing::Ge(3)));
  seen_.outputs.front().isExcused = false;
  runFor(3s);
  EXPECT_THAT(runFor(60s), IsEmpty()) << "a display that is there and shows nothing hangs";
}

TEST_F(ServiceReporterTest, TellsReloads) {
  runFor(1s);
  reporter_.reloading(now_);
  reporter_.reloaded("");
  const std::vector<std::string> good = socket_.take();
  ASSERT_EQ(good.size(), 2u);
  EXPECT_THAT(good[0], StartsWith("RELOADING=1\nMONOTONIC_USEC=1010"));
  EXPECT_EQ(good[1], "READY=1");
  reporter_.reloading(now_);
  reporter_.reloaded("site.toml:3: wrong");
  socket_.take();
  now_ += 10s;
  reporter_.update(seen_, "painting", now_);
  EXPECT_THAT(socket_.take("-"), testing::IsSupersetOf({"STATUS=site.toml:3: wrong · painting"}));
}

TEST_F(ServiceReporterTest, TellsWhatItDoesAndThatItStops) {
  socket_.take("-");
  reporter_.update(seen_, "waiting for a camera", now_);
  EXPECT_THAT(socket_.take("-"), testing::Contains("STATUS=waiting for a camera"));
  reporter_.stopping();
  EXPECT_THAT(socket_.take(), ElementsAre("STOPPING=1"));
}

TEST_F(ServiceReporterTest, HasWaitingPicturesRenewedForTheWatchdog) {
  EXPECT_EQ(reporter_.renewal(), 2s);
  const ServiceManager careless({.notifySocket = socket_.path(), .watchdogUsec = {}});
  EXPECT_EQ(ServiceReporter(careless).renewal(), 0s);
  const ServiceManager none{ServiceEnvironment{}};
  EXPECT_FALSE(ServiceReporter(none).isDue(now_));
}

}  // namespace
}  // namespace pleinair::app
