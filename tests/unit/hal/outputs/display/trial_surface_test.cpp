#include "hal/outputs/display/trial_surface.h"

#include <array>
#include <cstdint>

#include <gtest/gtest.h>

#include "hal/clock.h"
#include "hal/surface_pattern.h"
#include "tests/support/drawn_surface.h"
#include "tests/support/fake_card.h"

namespace pleinair::hal {
namespace {

constexpr std::array<std::uint64_t, 1> kRows{kLinearModifier};

class TrialSurfaceTest : public testing::Test {
 protected:
  SteppedClock clock_{TimePoint(std::chrono::seconds(100))};
  support::FakeCards cards_{clock_};
};

TEST_F(TrialSurfaceTest, ShowsWhatWasDrawnIntoIt) {
  cards_.add({.gpuModifiers = {kLinearModifier}});
  {
    const auto surface = TrialSurface::make("display", kRows, cards_);
    ASSERT_TRUE(surface.has_value()) << surface.error().message();
    const GpuSurface drawn = (*surface)->surface();
    support::drawPatternInto(drawn);
    const auto seen = (*surface)->copy();
    ASSERT_TRUE(seen.has_value());
    const auto same = checkSurfacePattern(seen->view(), drawn.surface.id);
    EXPECT_TRUE(same.has_value()) << same.error().message();
    support::drawInto(drawn, [](int x, int y) { return static_cast<std::uint32_t>(x * y); });
    EXPECT_FALSE(checkSurfacePattern((*surface)->copy()->view(), drawn.surface.id).has_value());
  }
  EXPECT_EQ(cards_.gpuBuffers, 0);
  EXPECT_EQ(cards_.modesets, 0);
  EXPECT_EQ(cards_.openCards, 0);
}

TEST_F(TrialSurfaceTest, SaysWhyThereIsNone) {
  EXPECT_EQ(TrialSurface::make("display", kRows, cards_).error().kind, ErrorKind::kNotFound);
  cards_.add({});
  EXPECT_EQ(TrialSurface::make("display", kRows, cards_).error().kind, ErrorKind::kUnsupported);
  cards_.add({.node = "/dev/dri/card1",
              .gpuModifiers = {kLinearModifier},
              .planeModifiers = {kLinearModifier + 1}});
  const auto other = TrialSurface::make("display:card1-HDMI-A-1", kRows, cards_);
  ASSERT_FALSE(other.has_value());
  EXPECT_NE(other.error().message().find("none of the layouts"), std::string::npos)
      << other.error().message();
}

}  // namespace
}  // namespace pleinair::hal
