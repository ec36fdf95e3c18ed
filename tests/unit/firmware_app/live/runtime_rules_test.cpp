#include "firmware_app/live/runtime_rules.h"

#include <chrono>
#include <string>

#include <gtest/gtest.h>

#include "hal/error.h"
#include "hal/outputs/registry.h"

namespace pleinair::app {
namespace {

OutputOpener openerWith(const hal::OutputOptionsByKind& options = {}) {
  return [options](const std::string& target) { return hal::openOutput(target, options); };
}

runtime::OutputStageOptions rulesOf(const std::string& target) {
  return outputRules(target, openerWith(), {}, {.framePeriod = std::chrono::milliseconds(40)});
}

TEST(OutputRules, FollowTheTraitsOfTheKind) {
  for (const std::string target :
       {"window", "loopback", "loopback:/dev/video50", "headless", "a.mp4", "a/"}) {
    const hal::OutputTraits& traits = hal::orThrow(hal::outputKindOf(target))->traits;
    const runtime::OutputStageOptions rules = rulesOf(target);
    EXPECT_EQ(rules.name, target);
    EXPECT_EQ(rules.rules.isPaced, traits.isPaced) << target;
    EXPECT_EQ(static_cast<bool>(rules.reopen), traits.reopens) << target;
  }
  EXPECT_FALSE(rulesOf("a.mp4").rules.isPaced);
  EXPECT_TRUE(rulesOf("window").rules.isPaced);
  EXPECT_TRUE(rulesOf("loopback").reopen);
}

TEST(OutputRules, OpenADeviceAnewWithItsOptions) {
  EXPECT_TRUE(rulesOf("loopback").reopen());
  const auto rules =
      outputRules("loopback", openerWith({{"loopback", {{"format", "rgb"}}}}), {}, {});
  EXPECT_FALSE(rules.reopen());
}

TEST(OutputRules, AreNoneOfAnUnknownTarget) {
  EXPECT_THROW(rulesOf("screen"), hal::Failure);
}

}  // namespace
}  // namespace pleinair::app
