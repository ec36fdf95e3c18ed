// Where a configuration is read from: profiles, the site file, the environment.
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/profiles.h"
#include "pipeline/styles/registry.h"
#include "tests/unit/firmware_app/configuration_test.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

// ---- profiles

TEST_F(ConfigurationTest, EveryProfileOfTheProgramLoads) {
  std::vector<std::string> names = config::profileNames();
  EXPECT_THAT(names, testing::IsSupersetOf({"demo", "kiosk", "repair_station"}));
  for (const std::string& name : names) {
    request_.profile = name;
    const Configuration configuration = resolved();
    EXPECT_THAT(configuration.toToml(config::Printed::kGiven), HasSubstr("profile " + name + ":"));
    EXPECT_TRUE(configuration.files().empty());
    // The embedded text is the file's.
    const fs::path file = fs::path(PLEINAIR_TESTS_DIR) / "../config/profiles" / (name + ".toml");
    request_.profile = file.string();
    EXPECT_EQ(resolved().painting().style, configuration.painting().style);
    EXPECT_EQ(resolved().styleParameters(), configuration.styleParameters());
    EXPECT_THAT(resolved().files(), testing::ElementsAre(file));
  }
}

TEST_F(ConfigurationTest, TheStrongestLayerNamesTheProfile) {
  const fs::path one = write("1.toml", "[camera.synthetic]\nseed = 1\n");
  const fs::path two = write("2.toml", "[camera.synthetic]\nseed = 2\n");
  const fs::path three = write("3.toml", "[camera.synthetic]\nseed = 3\n");
  request_.siteFile = write("s.toml", "profile = \"1.toml\"\n");  // beside it
  EXPECT_EQ(resolved().origin("camera.synthetic.seed"), one.string() + ":2");
  request_.environment = {{"PLEINAIR_PROFILE", two.string()}};
  EXPECT_EQ(resolved().origin("camera.synthetic.seed"), two.string() + ":2");
  request_.profile = three.string();
  EXPECT_EQ(resolved().origin("camera.synthetic.seed"), three.string() + ":2");
  request_.profile = "none";
  EXPECT_EQ(resolved().origin("camera.synthetic.seed"), "default");
}

TEST_F(ConfigurationTest, ProfilesNameTheirMistakes) {
  request_.profile = "dmeo";
  EXPECT_EQ(refusal(),
            "--profile: found \"dmeo\" (did you mean \"demo\"?), allowed: demo, kiosk, "
            "loopback, repair_station, none, or a path that ends in .toml");
  request_.profile = path("absent.toml").string();
  EXPECT_EQ(refusal(), "--profile: " + path("absent.toml").string() +
                           ": cannot open: No such file or directory, allowed: a TOML file of at "
                           "most 1 MiB");
  request_.profile = write("p.toml", "profile = \"demo\"\n").string();
  EXPECT_THAT(refusal(), StartsWith(path("p.toml").string() + ":1: profile: a profile builds on"));
  request_.profile = write("p.toml", "\n[painting]\nstile = \"none\"\n").string();
  EXPECT_THAT(refusal(), StartsWith(path("p.toml").string() +
                                    ":3: painting.stile: unknown key (did you mean \"style\"?)"));
  request_.profile.reset();
  request_.siteFile = write("s.toml", "\nprofile = \"absent.toml\"\n");
  EXPECT_THAT(refusal(), StartsWith(path("s.toml").string() + ":2: profile: " +
                                    path("absent.toml").string() + ": cannot open: "));
}

// ---- the site file

TEST_F(ConfigurationTest, FindsTheSiteFile) {
  const fs::path machine = write("machine.toml", "[camera.synthetic]\nseed = 1\n");
  const fs::path variable = write("variable.toml", "[camera.synthetic]\nseed = 2\n");
  const fs::path option = write("option.toml", "[camera.synthetic]\nseed = 3\n");
  request_.defaultSiteFile = machine;
  EXPECT_EQ(seedOf(resolved()), "1");
  EXPECT_THAT(resolved().files(), testing::ElementsAre(machine));
  request_.environment = {{"PLEINAIR_CONFIG", variable.string()}};
  EXPECT_EQ(seedOf(resolved()), "2");
  request_.siteFile = option;
  EXPECT_EQ(seedOf(resolved()), "3");
}

TEST_F(ConfigurationTest, AnEmptyVariableMeansNoSiteFile) {
  request_.defaultSiteFile = write("machine.toml", "[camera.synthetic]\nseed = 5\n");
  request_.environment = {{"PLEINAIR_CONFIG", ""}};
  EXPECT_EQ(seedOf(resolved()), "1");
}

TEST_F(ConfigurationTest, ASiteFileThatIsNamedMustBeReadable) {
  request_.environment = {{"PLEINAIR_CONFIG", path("absent.toml").string()}};
  EXPECT_EQ(refusal(), "PLEINAIR_CONFIG: " + path("absent.toml").string() +
                           ": cannot open: No such file or directory, allowed: a TOML file of at "
                           "most 1 MiB");
  request_.environment.clear();
  request_.siteFile = folder_.path();
  EXPECT_THAT(refusal(), StartsWith(folder_.path().string() + ": is a directory"));
  request_.siteFile.reset();
  request_.defaultSiteFile = folder_.path();
  EXPECT_THAT(refusal(), StartsWith(folder_.path().string() + ": is a directory"));
}

TEST_F(ConfigurationTest, TakesByteOrderMarksAndCarriageReturns) {
  request_.siteFile = write(
      "s.toml", "\xef\xbb\xbf# a site\r\n[camera]\r\nsize = \"64x48\" # of it\r\nrate = 5\r\n");
  const Configuration configuration = resolved();
  EXPECT_EQ(configuration.camera().size, (config::PixelSize{64, 48}));
  EXPECT_EQ(configuration.origin("camera.rate"), path("s.toml").string() + ":4");
  request_.siteFile = write("s.toml", "\xef\xbb\xbf\r\n\r\n[camera.synthetic]\r\nsede = 7\r\n");
  EXPECT_THAT(refusal(),
              StartsWith(path("s.toml").string() + ":4: camera.synthetic.sede: unknown key"));
  request_.siteFile = write("s.toml", "");
  EXPECT_EQ(refusal(), "(nothing thrown)");
}

TEST_F(ConfigurationTest, RefusesWhatIsNoTomlOrTooMuchOfIt) {
  const auto refused = [&](const std::string& text) {
    request_.siteFile = write("s.toml", text);
    return refusal();
  };
  const std::string name = path("s.toml").string();
  EXPECT_THAT(refused("[camera.synthetic]\nseed = 1\nseed = 2\n"),
              StartsWith(name + ":3: not TOML: "));
  EXPECT_THAT(refused("[camera\n"), StartsWith(name + ":1: not TOML: "));
  EXPECT_THAT(refused(std::string("[camera.synthetic]\nseed\0 = 1\n", 29)),
              StartsWith(name + ":2: not TOML"));
  EXPECT_THAT(refused("a = " + std::string(200'000, '[')), HasSubstr("nested too deeply"));
  EXPECT_THAT(refused(std::string(100'000, 'a') + " = 1\n"), HasSubstr("unknown key"));
  EXPECT_THAT(refused("a" + std::string(50'000, '.') + "a = 1\n"),
              testing::AnyOf(HasSubstr("nested too deeply"), HasSubstr("not TOML")));
  EXPECT_THAT(refused(std::string((1 << 20) + 1, '#')), HasSubstr("too large"));
}

TEST_F(ConfigurationTest, TellsWhereALookIsGivenForAStyle) {
  request_.siteFile = write("site.toml", "[painting]\nstyle = \"oil\"\n");
  EXPECT_THAT(refusal(), HasSubstr("site.toml:2: painting.style: found \"oil\" (a look of "
                                   "painterly: look = \"oil\"), allowed: one of "));
  request_.siteFile = write("site.toml", "[painting]\nstyle = \"painterli\"\n");
  EXPECT_THAT(refusal(), HasSubstr("did you mean \"painterly\"?"));
  request_.siteFile = write("site.toml", "style = \"painterly\"\n");
  EXPECT_THAT(refusal(), HasSubstr("site.toml:1: style: is the table of the styles' parameters, "
                                   "allowed: style = \"painterly\" in [painting]"));
}

TEST_F(ConfigurationTest, NothingUnknownIsSkipped) {
  const auto refused = [&](const std::string& text) {
    request_.siteFile = write("s.toml", text);
    return refusal();
  };
  const std::string name = path("s.toml").string();
  // Also for a style that is not in force.
  EXPECT_THAT(refused("[painting]\nstyle = \"none\"\n[style.watercolor]\ncell_sise = 3\n"),
              StartsWith(name + ":4: style.watercolor.cell_sise: unknown key (did you mean "
                                "\"cell_size\"?), allowed: bleeding, cell_size, "));
  EXPECT_EQ(refused("[painting]\nstyle = \"none\"\n[style.watercolor]\ncell_size = 3\n"),
            name +
                ":4: style.watercolor.cell_size: found 3, allowed: a whole number of px in [4, "
                "64]");
  std::set<std::string> names;
  for (const styles::StyleKind* kind : styles::styleKinds()) names.emplace(kind->name);
  EXPECT_EQ(refused("[style.watercolour]\ncell_size = 8\n"),
            fmt::format("{}:1: style.watercolour: unknown key (did you mean \"watercolor\"?), "
                        "allowed: {}",
                        name, fmt::join(names, ", ")));
  EXPECT_EQ(refused("[painting]\ncell_size = 8\n"),
            name +
                ":2: painting.cell_size: unknown key (it belongs to [style.watercolor]), "
                "allowed: look, scene, size, style, view");
}

// ---- the environment

TEST_F(ConfigurationTest, EveryKeyHasItsVariable) {
  request_.environment = {{"PLEINAIR_CAMERA_SOURCE", "/in.mp4"},
                          {"PLEINAIR_PAINTING_STYLE", "none"},
                          {"PLEINAIR_PAINTING_SIZE", "320x240"},
                          {"PLEINAIR_OUTPUT_TARGETS", "window,/out\\,.mp4"},
                          {"PLEINAIR_STYLE_WATERCOLOR_CELL_SIZE", "9"}};
  const Configuration configuration = resolved();
  EXPECT_EQ(configuration.camera().source, "/in.mp4");
  EXPECT_EQ(configuration.painting().style, "none");
  EXPECT_EQ(configuration.painting().size, (config::PixelSize{320, 240}));
  EXPECT_EQ(configuration.output().targets, (std::vector<fs::path>{"window", "/out,.mp4"}));
  EXPECT_EQ(configuration.origin("painting.style"), "PLEINAIR_PAINTING_STYLE");
  EXPECT_EQ(configuration.origin("style.watercolor.cell_size"),
            "PLEINAIR_STYLE_WATERCOLOR_CELL_SIZE");
}

TEST_F(ConfigurationTest, VariablesOfNoKeyAreRefused) {
  request_.environment = {{"PLEINAIR_PAINTING_STLYE", "none"}};
  EXPECT_EQ(
      refusal(),
      "PLEINAIR_PAINTING_STLYE: unknown variable (did you mean \"PLEINAIR_PAINTING_STYLE\"?), "
      "allowed: PLEINAIR_PAINTING_STYLE, PLEINAIR_PAINTING_LOOK, PLEINAIR_PAINTING_VIEW, "
      "PLEINAIR_PAINTING_SIZE, PLEINAIR_PAINTING_SCENE");
  request_.environment = {{"PLEINAIR_UNHEARD_OF", ""}};
  EXPECT_THAT(refusal(), StartsWith("PLEINAIR_UNHEARD_OF: unknown variable, allowed: "
                                    "PLEINAIR_CONFIG, PLEINAIR_PROFILE, PLEINAIR_CAMERA_…, "));
}

TEST_F(ConfigurationTest, OfSeveralMistakesItTellsTheSameOne) {
  request_.environment = {{"PLEINAIR_ZZ", ""}, {"PLEINAIR_AA", ""}};
  const std::string first = refusal();
  std::swap(request_.environment[0], request_.environment[1]);
  EXPECT_EQ(refusal(), first);
}

}  // namespace
}  // namespace pleinair::app
