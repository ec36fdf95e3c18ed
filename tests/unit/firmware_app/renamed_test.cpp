// Renamed keys, options and views are refused by an error that gives the new name.
#include "firmware_app/config/renamed.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/firmware_app/configuration_test.h"

namespace pleinair::app {
namespace {

TEST_F(ConfigurationTest, RefusesEveryOldKeyAndNamesTheNewOne) {
  ASSERT_FALSE(renamedKeys().empty());
  for (const config::RenamedKey& each : renamedKeys()) {
    request_ = {};
    request_.defaultSiteFile = path("absent.toml");
    const std::string old(each.old);
    request_.set = {old + "=1"};
    EXPECT_EQ(refusal(), "--set " + old + ": is now " + std::string(each.now));
    request_.set.clear();
    const std::size_t dot = old.rfind('.');
    request_.siteFile =
        write("s.toml", "[" + old.substr(0, dot) + "]\n" + old.substr(dot + 1) + " = 1\n");
    EXPECT_EQ(refusal(),
              path("s.toml").string() + ":2: " + old + ": is now " + std::string(each.now));
  }
}

TEST_F(ConfigurationTest, RefusesAnOldParameterOfTheStyleInForce) {
  request_.set = {"steady_time=0"};
  EXPECT_EQ(refusal(), "--set steady_time: is now style.watercolor.filter_time");
  request_.set.clear();
  request_.environment = {{"PLEINAIR_STYLE_WATERCOLOR_STEADY_TIME", "0"}};
  EXPECT_EQ(refusal(),
            "PLEINAIR_STYLE_WATERCOLOR_STEADY_TIME: is now PLEINAIR_STYLE_WATERCOLOR_FILTER_TIME");
}

TEST_F(ConfigurationTest, RefusesAnOldNameOfAView) {
  request_.options = {{"painting.view", "steady", "--view"}};
  EXPECT_EQ(refusal(), "--view: \"steady\" is now \"filtered\"");
  request_.options = {{"painting.view", "filtered", "--view"}};
  EXPECT_EQ(resolved().painting().view, "filtered");
}

TEST(RenamedOptions, LeadToTheNewOne) {
  EXPECT_EQ(renamedOption("--stills"), "--snapshots");
  EXPECT_EQ(renamedOption("--snapshots"), std::nullopt);
}

}  // namespace
}  // namespace pleinair::app
