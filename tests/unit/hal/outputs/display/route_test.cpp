#include "hal/outputs/display/route.h"

#include <gtest/gtest.h>

#include "tests/support/fake_card.h"

namespace pleinair::hal::display {
namespace {

using support::FakeCards;
using support::FakeCardSpec;
using support::FakeConnector;
using support::FakeMode;

class Route : public testing::Test {
 protected:
  CardState stateOf(FakeCardSpec spec) {
    cards_.add(std::move(spec));
    return *(*cards_.open("/dev/dri/card0"))->read(true);
  }
  Mode modeFor(std::vector<FakeMode> modes, const std::string& mode,
               std::optional<double> framesPerSecond = std::nullopt) {
    const CardState state = stateOf({.connectors = {{.modes = std::move(modes)}}});
    DisplayRequest wish{.mode = mode};
    if (framesPerSecond) wish.framePeriod = fromSeconds(1.0 / *framesPerSecond);
    const Result<Mode> chosen = chooseMode(state.connectors.front(), wish);
    EXPECT_TRUE(chosen.has_value()) << (chosen ? "" : chosen.error().message());
    return chosen.value_or(Mode{});
  }
  static double hertz(const Mode& mode) { return 1.0 / toSeconds(mode.period); }

  SteppedClock clock_;
  FakeCards cards_{clock_};
};

const std::vector<FakeMode> kTelevision{{.size = {1920, 1080}, .hertz = 60.0, .isPreferred = true},
                                        {.size = {1920, 1080}, .hertz = 59.94},
                                        {.size = {1920, 1080}, .hertz = 50.0},
                                        {.size = {1920, 1080}, .hertz = 24.0},
                                        {.size = {1280, 720}, .hertz = 75.0},
                                        {.size = {1280, 720}, .hertz = 60.0}};

TEST_F(Route, TheFirstConnectedConnectorIsTaken) {
  const CardState state =
      stateOf({.connectors = {{.name = "DP-1", .isConnected = false}, {.name = "HDMI-A-1"}}});
  EXPECT_EQ(chooseConnector(state, "", {})->name, "HDMI-A-1");
}

TEST_F(Route, ATakenConnectorIsLeftToItsOutput) {
  const CardState state = stateOf({.connectors = {{.name = "DP-1"}, {.name = "HDMI-A-1"}}});
  const std::vector<ObjectId> taken{state.connectors[0].id};
  EXPECT_EQ(chooseConnector(state, "", taken)->name, "HDMI-A-1");
  EXPECT_EQ(chooseConnector(state, "DP-1", taken).error().kind, ErrorKind::kBusy);
}

TEST_F(Route, AnEmptyConnectorIsADisplayThatMayCome) {
  const CardState state = stateOf({.connectors = {{.name = "DP-1", .isConnected = false}}});
  EXPECT_EQ(chooseConnector(state, "", {}).error().kind, ErrorKind::kDeviceLost);
  EXPECT_EQ(chooseConnector(state, "DP-1", {}).error().kind, ErrorKind::kDeviceLost);
}

TEST_F(Route, AConnectorThatIsNotThereListsThoseThatAre) {
  const CardState state = stateOf({.connectors = {{.name = "DP-1"}, {.name = "HDMI-A-1"}}});
  const Error error = chooseConnector(state, "VGA-1", {}).error();
  EXPECT_EQ(error.kind, ErrorKind::kNotFound);
  EXPECT_NE(error.remedy.find("DP-1"), std::string::npos);
}

TEST_F(Route, AutoIsAWholeMultipleOfTheCamerasRate) {
  EXPECT_NEAR(hertz(modeFor(kTelevision, "auto", 25.0)), 50.0, 1e-3);
}
TEST_F(Route, AutoKeepsThePreferredModeWhereItFits) {
  EXPECT_NEAR(hertz(modeFor(kTelevision, "auto", 30.0)), 60.0, 1e-3);
}
TEST_F(Route, AutoTakesNoModeThatIsSlowerThanTheCamera) {
  EXPECT_NEAR(hertz(modeFor(kTelevision, "auto", 60.0)), 60.0, 1e-3);
}
TEST_F(Route, AutoIsThePreferredModeForACameraWithoutARate) {
  EXPECT_NEAR(hertz(modeFor(kTelevision, "auto")), 60.0, 1e-3);
}
TEST_F(Route, AutoAvoidsInterlacedModes) {
  const Mode mode = modeFor({{.size = {1920, 1080}, .hertz = 60.0, .isPreferred = true},
                             {.size = {1920, 1080}, .hertz = 50.0, .isInterlaced = true}},
                            "auto", 25.0);
  EXPECT_FALSE(mode.isInterlaced);
}
TEST_F(Route, AModeIsNamedBySizeAndRate) {
  EXPECT_NEAR(hertz(modeFor(kTelevision, "1920x1080@24")), 24.0, 1e-3);
  EXPECT_NEAR(hertz(modeFor(kTelevision, "1920x1080@59.94")), 59.94, 1e-3);
  EXPECT_NEAR(hertz(modeFor(kTelevision, "1280x720")), 75.0, 1e-3);
}
TEST_F(Route, AModeThatIsNotThereListsTheSizes) {
  const CardState state = stateOf({.connectors = {{.modes = kTelevision}}});
  for (const char* mode : {"1024x768", "1920x1080@100"}) {
    const Result<Mode> chosen = chooseMode(state.connectors.front(), {.mode = mode});
    ASSERT_FALSE(chosen.has_value()) << mode;
    EXPECT_EQ(chosen.error().kind, ErrorKind::kNotFound);
    EXPECT_NE(chosen.error().remedy.find("1280x720"), std::string::npos);
  }
}
TEST_F(Route, TextThatIsNoModeIsRefused) {
  for (const char* mode : {"", "1920", "1920x", "x1080", "1920x1080@", "1920x1080@-5", "big"}) {
    EXPECT_FALSE(isModeText(mode)) << mode;
  }
}

TEST_F(Route, GoesThroughTheCrtcThatDrivesTheConnectorAlready) {
  const CardState state = stateOf({.connectors = {{}, {.name = "DP-1"}}, .crtcs = 3});
  const Connector& first = state.connectors.front();
  EXPECT_EQ(routeTo(state, first, first.modes.front(), {})->crtcIndex, 0u);
}
TEST_F(Route, GoesThroughAFreeCrtcAndItsPlane) {
  const CardState state =
      stateOf({.connectors = {{}, {.name = "DP-1", .crtcs = 0b110}}, .crtcs = 3});
  const Connector& second = state.connectors.back();
  const auto route =
      routeTo(state, second, second.modes.front(), {.crtcs = 0b011, .planes = 0b011});
  ASSERT_TRUE(route.has_value());
  EXPECT_EQ(route->crtcIndex, 2u);
  EXPECT_EQ(route->planeIndex, 2u);
}
TEST_F(Route, IsRefusedWhereAllCrtcsAreInUse) {
  const CardState state = stateOf({});
  const Connector& connector = state.connectors.front();
  const auto route = routeTo(state, connector, connector.modes.front(), {.crtcs = 0b11});
  EXPECT_EQ(route.error().kind, ErrorKind::kBusy);
}

TEST(DisplayName, SaysTheConnectorAndMaybeTheCard) {
  EXPECT_TRUE(isDisplayName("display"));
  EXPECT_FALSE(isDisplayName("display:"));
  EXPECT_FALSE(isDisplayName("displays"));
  EXPECT_FALSE(isDisplayName("display:/dev/dri/card0"));
  EXPECT_EQ(parseDisplayName("display").connector, "");
  EXPECT_EQ(parseDisplayName("display:HDMI-A-1").connector, "HDMI-A-1");
  const DisplayName both = parseDisplayName("display:card1-HDMI-A-1");
  EXPECT_EQ(both.connector, "HDMI-A-1");
  EXPECT_TRUE(both.isOn("/dev/dri/card1"));
  EXPECT_FALSE(both.isOn("/dev/dri/card0"));
}

}  // namespace
}  // namespace pleinair::hal::display
