#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/config_error.h"
#include "firmware_app/config/configuration.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class OutputTargets : public testing::Test {
 protected:
  /// [output] of a site file with these lines.
  OutputSettings settingsOf(const std::string& lines) const {
    const fs::path file = folder_.path() / "site.toml";
    std::ofstream(file) << "[output]\n" << lines << "\n";
    return Configuration({.siteFile = file}).output();
  }
  std::string refusalOf(const std::string& lines) const {
    try {
      settingsOf(lines);
    } catch (const config::ConfigError& error) {
      return error.what();
    }
    return "taken";
  }
  static OutputSettings withSet(const std::string& text) {
    return Configuration({.set = {text}, .defaultSiteFile = {}}).output();
  }

  support::TemporaryFolder folder_;
};

TEST_F(OutputTargets, AreNamesOrPathsFromTheirFile) {
  EXPECT_THAT(settingsOf("").targets, ElementsAre("window"));
  EXPECT_THAT(settingsOf("targets = [\"window\", \"loopback:/dev/video50\", \"loopback:the hall\"]")
                  .targets,
              ElementsAre("window", "loopback:/dev/video50", "loopback:the hall"));
  EXPECT_THAT(settingsOf("targets = [\"a.mp4\", \"./painted\", \"/tmp/b/\"]").targets,
              ElementsAre(folder_.path() / "a.mp4", folder_.path() / "./painted", "/tmp/b/"));
}

TEST_F(OutputTargets, AreRefusedWhereAWordIsNoKindOfOutput) {
  for (const std::string name : {"screen", "screen:HDMI-A-1", "windw", "loopback:", ""}) {
    const std::string refusal = refusalOf("targets = [\"window\", \"" + name + "\"]");
    EXPECT_THAT(refusal, HasSubstr("site.toml:2: output.targets: found \"" + name + "\"")) << name;
  }
  const std::string refusal = refusalOf("targets = [\"screen\"]");
  EXPECT_THAT(refusal,
              HasSubstr("window, display, loopback, headless, display:CONNECTOR, loopback:DEVICE"));
  EXPECT_THAT(refusal, HasSubstr("./NAME or NAME/"));
  EXPECT_THAT(refusalOf("targets = [\"windw\"]"), HasSubstr("did you mean \"window\"?"));
  for (const std::string list : {"[]", "\"window\"", "[1]", "[\"window\", [\"a.mp4\"]]"}) {
    EXPECT_THAT(refusalOf("targets = " + list), HasSubstr("output.targets")) << list;
  }
}

TEST_F(OutputTargets, OfSetAndOfVariablesAreSeparatedByCommas) {
  EXPECT_THAT(withSet("output.targets=window,a\\,b.mp4,c\\\\.png").targets,
              ElementsAre("window", "a,b.mp4", "c\\.png"));
  EXPECT_THROW(withSet("output.targets=window,"), config::ConfigError);
  EXPECT_THROW(withSet("output.targets=a\\b.mp4"), config::ConfigError);
  EXPECT_THROW(withSet("output.targets=screen"), config::ConfigError);
}

TEST_F(OutputTargets, ArePrintedAsTheyAreRead) {
  const Configuration configuration(
      {.set = {"output.targets=loopback:a \"b\",/x\\,y.mp4,/z/"}, .defaultSiteFile = {}});
  const std::string toml = configuration.toToml(config::Printed::kGiven);
  EXPECT_THAT(toml, HasSubstr("targets = [\"loopback:a \\\"b\\\"\", \"/x,y.mp4\", \"/z/\"]"));
  const fs::path file = folder_.path() / "copy.toml";
  std::ofstream(file) << toml;
  EXPECT_EQ(Configuration({.siteFile = file}).output().targets, configuration.output().targets);
}

TEST_F(OutputTargets, HaveTheOptionsOfTheirKind) {
  EXPECT_EQ(settingsOf("").options.at("loopback").at("format"), "auto");
  EXPECT_EQ(settingsOf("[output.loopback]\nformat = \"nv12\"").options.at("loopback").at("format"),
            "nv12");
  EXPECT_EQ(withSet("output.loopback.format=i420").options.at("loopback").at("format"), "i420");
  EXPECT_THAT(refusalOf("[output.loopback]\nformat = \"rgb\""),
              HasSubstr("auto, yuyv, nv12, i420"));
  EXPECT_THAT(refusalOf("[output.window]\nformat = \"rgb\""), HasSubstr("unknown key"));
}

TEST_F(OutputTargets, HadOtherKeys) {
  for (const auto& [former, now] : {std::pair{"target", "output.targets"},
                                    {"second_target", "output.targets"},
                                    {"third_target", "output.targets"},
                                    {"loopback_format", "output.loopback.format"}}) {
    const std::string key = std::string("output.") + former;
    EXPECT_THAT(refusalOf(std::string(former) + " = \"window\""),
                testing::AllOf(HasSubstr("site.toml:2: " + key + ": is now "), HasSubstr(now)));
    EXPECT_THROW(withSet(key + "=window"), config::ConfigError);
  }
  EXPECT_THROW(Configuration({.environment = {{"PLEINAIR_OUTPUT_SECOND_TARGET", "window"}},
                              .defaultSiteFile = {}}),
               config::ConfigError);
}

}  // namespace
}  // namespace pleinair::app
