#include "firmware_app/live/interaction/live_window.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;

/// Records its title and caption.
class FakeWindow final : public hal::Window {
 public:
  hal::OutputIdentity identity() const override { return {"window", "fake"}; }
  hal::Result<hal::OutputFormat> start(const hal::OutputRequest&) override { return {}; }
  hal::Result<void> write(const hal::ImageView&, hal::Duration) override { return {}; }
  hal::Result<void> finish() override { return {}; }
  std::vector<hal::WindowEvent> takeEvents() override { return std::exchange(events, {}); }
  void setCaption(const std::string& text, double newOpacity) override {
    caption = text;
    opacity = newOpacity;
  }
  hal::Result<void> redraw() override {
    ++redraws;
    if (isLost) return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kDeviceLost});
    return {};
  }
  void setTitle(const std::string& text) override { title = text; }
  void setFullScreen(bool on) override { isFullScreen = on; }
  void setClipboard(const std::string& text) override { clipboard = text; }
  hal::Result<hal::Image> shown() override { return hal::Image(); }

  std::vector<hal::WindowEvent> events;
  std::string caption;
  std::string title;
  std::string clipboard;
  double opacity = 0.0;
  int redraws = 0;
  bool isFullScreen = false;
  bool isLost = false;
};

class LiveWindowTest : public testing::Test {
 protected:
  LiveWindow::Requests press(const std::string& key) {
    window_.events.emplace_back(hal::KeyPressed{.name = key});
    const LiveWindow::Requests requests = live_.takeRequests();
    live_.update(24.4, true);
    return requests;
  }
  void updateAfter(hal::Duration time, bool pictureFollows = true) {
    clock_.advance(time);
    live_.update(24.4, pictureFollows);
  }

  hal::SteppedClock clock_{hal::TimePoint(100s)};
  FakeWindow window_;
  config::ParameterValues nothing_{
      std::make_shared<const config::ParameterList>(std::vector<config::ParameterDescriptor>{})};
  LiveTuning tuning_{{{.name = "brush",
                       .start = {.style = nothing_, .view = {}},
                       .views = {{"cells", ""}},
                       .looks = {}}}};
  LiveWindow live_{window_, tuning_, clock_};
};

TEST_F(LiveWindowTest, PointsToTheHelpAtFirst) {
  live_.update(0.0, true);
  EXPECT_EQ(window_.caption, "h: help\nbrush · 0 frames/s");
  EXPECT_EQ(window_.opacity, 1.0);
  EXPECT_EQ(window_.title, "pleinair: brush");
}

TEST_F(LiveWindowTest, SaysWhatAKeyChangedAndFades) {
  press("v");
  EXPECT_EQ(window_.caption, "brush has nothing to tune\nbrush · view cells · 24 frames/s");
  EXPECT_EQ(window_.title, "pleinair: brush · view cells");
  updateAfter(3250ms);
  EXPECT_NEAR(window_.opacity, 0.5, 1e-6);
  updateAfter(1s);
  EXPECT_EQ(window_.opacity, 0.0);
  press("v");
  EXPECT_EQ(window_.opacity, 1.0);
}

TEST_F(LiveWindowTest, AsksForLookFilesAndCommandLines) {
  EXPECT_TRUE(press("w").saveLook);
  const LiveWindow::Requests requests = press("c");
  EXPECT_TRUE(requests.commandLine);
  EXPECT_FALSE(requests.saveLook);
  live_.copy("pleinair run");
  EXPECT_EQ(window_.clipboard, "pleinair run");
}

TEST_F(LiveWindowTest, StaysAwayForKeysThatMeanNothing) {
  updateAfter(10s);
  press("z");
  EXPECT_EQ(window_.opacity, 0.0);
}

TEST_F(LiveWindowTest, KeepsTheHelpUntilItIsPutAway) {
  press("h");
  updateAfter(1min);
  EXPECT_EQ(window_.opacity, 1.0);
  EXPECT_THAT(window_.caption, HasSubstr("full screen"));
  press("h");
  EXPECT_THAT(window_.caption, Not(HasSubstr("full screen")));
}

TEST_F(LiveWindowTest, GivesANotice) {
  updateAfter(10s);
  live_.notify("saved a.png");
  live_.update(24.4, true);
  EXPECT_THAT(window_.caption, testing::StartsWith("saved a.png\n"));
  EXPECT_EQ(window_.opacity, 1.0);
  press("v");
  EXPECT_THAT(window_.caption, Not(HasSubstr("saved")));
}

TEST_F(LiveWindowTest, PassesRequestsOn) {
  EXPECT_FALSE(press("v").quit);
  EXPECT_TRUE(press("q").quit);
  EXPECT_TRUE(press("escape").quit);
  EXPECT_TRUE(press("s").snapshot);
  EXPECT_FALSE(press("s").quit);
  window_.events = {hal::WindowClosed{}};
  EXPECT_TRUE(live_.takeRequests().quit);
  window_.events = {hal::WindowResized{{9, 9}}};
  EXPECT_FALSE(live_.takeRequests().quit);
}

TEST_F(LiveWindowTest, FillsTheScreenAndComesBack) {
  press("f");
  EXPECT_TRUE(window_.isFullScreen);
  press("f");
  EXPECT_FALSE(window_.isFullScreen);
}

TEST_F(LiveWindowTest, RedrawsACaptionWhereNoPictureComesButNotTooOften) {
  updateAfter(1s, false);
  EXPECT_EQ(window_.redraws, 1);
  updateAfter(1ms, false);
  EXPECT_EQ(window_.redraws, 1);
  updateAfter(40ms, false);
  EXPECT_EQ(window_.redraws, 2);
  updateAfter(10s, false);
  EXPECT_EQ(window_.redraws, 3) << "once more, to take it away";
  updateAfter(1s, false);
  EXPECT_EQ(window_.redraws, 3);
}

TEST_F(LiveWindowTest, SaysWhereItCannotBeDrawn) {
  window_.isLost = true;
  clock_.advance(1s);
  EXPECT_FALSE(live_.update(0.0, false));
}

}  // namespace
}  // namespace pleinair::app
