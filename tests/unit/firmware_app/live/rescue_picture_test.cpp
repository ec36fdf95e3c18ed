// The rescue picture on a fake card whose refreshes follow a stepped clock.
#include "firmware_app/live/screens/rescue_picture.h"

#include <chrono>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/outputs/display/display_output.h"
#include "tests/support/fake_card.h"

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;

class RescuePictureTest : public testing::Test {
 protected:
  RescuePicture rescue(hal::Duration renewal = {}) {
    return {{"display"},
            [this](const std::string& target) {
              hal::DisplaySettings settings;
              settings.placement.fit = hal::display::Placement::Fit::kFill;
              return hal::openDisplay(target, settings, cards_, clock_);
            },
            {.title = "Soon", .detail = "site.toml:3"},
            std::nullopt,
            renewal,
            clock_};
  }
  void runFor(RescuePicture& picture, hal::Duration duration) {
    for (const auto end = clock_.now() + duration; clock_.now() < end; clock_.advance(5ms)) {
      picture.step();
    }
  }
  std::uint64_t shownBy(const RescuePicture& picture) const {
    return picture.progress().front().shown;
  }

  hal::SteppedClock clock_{hal::TimePoint(100s)};
  support::FakeCards cards_{clock_};
};

TEST_F(RescuePictureTest, IsShownOnce) {
  cards_.add({});
  RescuePicture picture = rescue();
  EXPECT_TRUE(cards_.shown.empty());
  runFor(picture, 3s);
  ASSERT_EQ(cards_.shown.size(), 1u);
  EXPECT_GT(cards_.shown.front().firstPixel & 0xFFU, 200u) << "paper";
  EXPECT_EQ(shownBy(picture), 1u);
  EXPECT_EQ(picture.problem(), "");
}

TEST_F(RescuePictureTest, IsRefusedWhereNothingIsThereToBeWaitedFor) {
  const auto none = [](const std::string& target) -> hal::Result<std::unique_ptr<hal::Output>> {
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kNotFound,
                                     .subject = target,
                                     .problem = "there is no desktop",
                                     .remedy = {}});
  };
  EXPECT_THROW(RescuePicture({"window"}, none, {.title = "Soon"}, std::nullopt, {}, clock_),
               hal::Failure);
}

TEST_F(RescuePictureTest, IsShownAgainForTheWatchdog) {
  cards_.add({});
  RescuePicture picture = rescue(1s);
  runFor(picture, 5500ms);
  EXPECT_GE(shownBy(picture), 5u);
  EXPECT_LE(shownBy(picture), 7u);
}

TEST_F(RescuePictureTest, WaitsForADisplay) {
  support::FakeCardSpec& card = cards_.add({});
  card.connectors.front().isConnected = false;
  RescuePicture picture = rescue();
  runFor(picture, 3s);
  EXPECT_TRUE(cards_.shown.empty());
  EXPECT_TRUE(picture.progress().front().isExcused);
  EXPECT_NE(picture.problem(), "");
  card.connectors.front().isConnected = true;
  runFor(picture, 7s);
  EXPECT_GE(cards_.shown.size(), 1u);
  EXPECT_EQ(picture.problem(), "");
}

TEST_F(RescuePictureTest, CountsNothingOnADisplayThatHangs) {
  support::FakeCardSpec spec;
  spec.losesFlips = true;
  cards_.add(std::move(spec));
  RescuePicture picture = rescue(1s);
  runFor(picture, 5s);
  EXPECT_EQ(shownBy(picture), 0u);
}

}  // namespace
}  // namespace pleinair::app
