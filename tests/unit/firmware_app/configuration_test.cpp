#include "firmware_app/configuration.h"

#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/profiles.h"
#include "firmware_app/configuration_sections.h"
#include "firmware_app/configured_parts.h"
#include "pipeline/styles/style_registry.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

class ConfigurationTest : public testing::Test {
 protected:
  ConfigurationTest() { request_.defaultSiteFile = path("absent.toml"); }

  fs::path path(const std::string& name) const { return folder_.path() / name; }

  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }

  Configuration resolved() const { return Configuration(request_); }

  /// What the error says; "(nothing thrown)" if there is none.
  std::string refusal() const {
    try {
      resolved();
    } catch (const config::ConfigError& error) {
      return error.what();
    }
    return "(nothing thrown)";
  }

  support::TemporaryFolder folder_;
  ConfigurationRequest request_;
};

// ---- layers

/// A way to give cell_size, the weakest first.
struct Layer {
  std::string name;
  std::function<void(ConfigurationRequest&, const fs::path& folder, int size)> give;
  std::function<std::string(const fs::path& folder)> origin;
};

const std::vector<Layer>& layers() {
  const auto write = [](const fs::path& file, int size) {
    std::ofstream(file) << "[style.watercolor]\ncell_size = " << size << "\n";
    return file;
  };
  static const std::vector<Layer> kLayers{
      {"profile",
       [write](ConfigurationRequest& request, const fs::path& folder, int size) {
         request.profile = write(folder / "profile.toml", size).string();
       },
       [](const fs::path& folder) { return (folder / "profile.toml:2").string(); }},
      {"site file",
       [write](ConfigurationRequest& request, const fs::path& folder, int size) {
         request.siteFile = write(folder / "site.toml", size);
       },
       [](const fs::path& folder) { return (folder / "site.toml:2").string(); }},
      {"environment",
       [](ConfigurationRequest& request, const fs::path&, int size) {
         request.environment.push_back(
             {"PLEINAIR_STYLE_WATERCOLOR_CELL_SIZE", std::to_string(size)});
       },
       [](const fs::path&) { return "PLEINAIR_STYLE_WATERCOLOR_CELL_SIZE"; }},
      {"command line",
       [](ConfigurationRequest& request, const fs::path&, int size) {
         request.set.push_back("cell_size=" + std::to_string(size));
       },
       [](const fs::path&) { return "--set cell_size"; }}};
  return kLayers;
}

TEST_F(ConfigurationTest, BeginsWithTheDefaults) {
  const Configuration configuration = resolved();
  EXPECT_EQ(configuration.painting().style, "watercolor");
  EXPECT_EQ(configuration.camera().source, "synthetic");
  EXPECT_EQ(configuration.styleParameters().text("cell_size"), "8");
  EXPECT_EQ(configuration.origin("style.watercolor.cell_size"), "default");
  EXPECT_TRUE(configuration.files().empty());
}

TEST_F(ConfigurationTest, EachLayerWinsOverTheDefaults) {
  for (std::size_t i = 0; i < layers().size(); ++i) {
    request_ = {};
    request_.defaultSiteFile = path("absent.toml");
    layers()[i].give(request_, folder_.path(), 20);
    const Configuration configuration = resolved();
    EXPECT_EQ(configuration.styleParameters().text("cell_size"), "20") << layers()[i].name;
    EXPECT_EQ(configuration.origin("style.watercolor.cell_size"),
              layers()[i].origin(folder_.path()))
        << layers()[i].name;
  }
}

TEST_F(ConfigurationTest, OfEachPairTheStrongerLayerWins) {
  for (std::size_t weak = 0; weak < layers().size(); ++weak) {
    for (std::size_t strong = weak + 1; strong < layers().size(); ++strong) {
      request_ = {};
      request_.defaultSiteFile = path("absent.toml");
      // The order in which they are given makes no difference.
      layers()[strong].give(request_, folder_.path(), 30);
      layers()[weak].give(request_, folder_.path(), 20);
      const Configuration configuration = resolved();
      const std::string pair = layers()[weak].name + " and " + layers()[strong].name;
      EXPECT_EQ(configuration.styleParameters().text("cell_size"), "30") << pair;
      EXPECT_EQ(configuration.origin("style.watercolor.cell_size"),
                layers()[strong].origin(folder_.path()))
          << pair;
    }
  }
}

TEST_F(ConfigurationTest, LayersLeaveOtherKeysAlone) {
  request_.profile = write("p.toml", "[camera]\nrate = 10\nseed = 5\n").string();
  request_.siteFile = write("s.toml", "[camera]\nseed = 6\n");
  const CameraSettings camera = resolved().camera();
  EXPECT_EQ(camera.framesPerSecond, 10);
  EXPECT_EQ(camera.seed, 6);
}

// ---- looks and styles

TEST_F(ConfigurationTest, ALookReplacesDefaults) {
  request_.options = {{"painting.look", "wet_in_wet", "--look"}};
  const Configuration configuration = resolved();
  const auto look = styles::styleInfo("watercolor").parametersOf("wet_in_wet");
  EXPECT_EQ(configuration.styleParameters(), look);
  EXPECT_EQ(configuration.styleParameters().origin("bleeding"), "look wet_in_wet");
  EXPECT_EQ(configuration.styleParameters().origin("cell_size"), "default");
}

TEST_F(ConfigurationTest, WhatAnyLayerGivesWinsOverTheLookOfAnyOther) {
  const std::string look = "[painting]\nlook = \"wet_in_wet\"\n";
  // Against the look's, were it the default's.
  const std::string usual = styles::styleInfo("watercolor").defaults.text("bleeding");
  const std::string value = "[style.watercolor]\nbleeding = " + usual + "\n";
  // The weaker layer's value stands against the stronger one's look.
  request_.profile = write("p.toml", value).string();
  request_.siteFile = write("s.toml", look);
  EXPECT_EQ(resolved().styleParameters().text("bleeding"), usual);
  EXPECT_EQ(resolved().styleParameters().origin("bleeding"), path("p.toml").string() + ":2");
  EXPECT_EQ(resolved().styleParameters().origin("hardness"), "look wet_in_wet");
  // And the other way round.
  request_.profile = write("p.toml", look).string();
  request_.siteFile = write("s.toml", value);
  EXPECT_EQ(resolved().styleParameters().text("bleeding"), usual);
  EXPECT_EQ(resolved().styleParameters().origin("hardness"), "look wet_in_wet");
}

TEST_F(ConfigurationTest, TheStrongestLayersLookIsTheOne) {
  request_.siteFile = write("s.toml", "[painting]\nlook = \"wet_in_wet\"\n");
  request_.options = {{"painting.look", "default", "--look"}};
  EXPECT_EQ(resolved().styleParameters(), styles::styleInfo("watercolor").defaults);
}

TEST_F(ConfigurationTest, AnotherStyleForgetsLookAndViewOfTheFormer) {
  request_.siteFile = write("s.toml", "[painting]\nlook = \"wet_in_wet\"\nview = \"cells\"\n");
  request_.options = {{"painting.style", "none", "--style"}};
  const Configuration configuration = resolved();
  EXPECT_EQ(configuration.painting().look, "default");
  EXPECT_EQ(configuration.painting().view, "finished");
  EXPECT_EQ(configuration.origin("painting.look"), "default");
}

TEST_F(ConfigurationTest, TheSameStyleAgainKeepsThem) {
  request_.siteFile = write("s.toml", "[painting]\nlook = \"wet_in_wet\"\nview = \"cells\"\n");
  request_.options = {{"painting.style", "watercolor", "--style"}};
  EXPECT_EQ(resolved().painting().look, "wet_in_wet");
  EXPECT_EQ(resolved().painting().view, "cells");
}

TEST_F(ConfigurationTest, ALayersOwnLookIsOfTheStyleItNames) {
  request_.siteFile = write("s.toml", "[painting]\nlook = \"wet_in_wet\"\nstyle = \"none\"\n");
  EXPECT_EQ(refusal(), path("s.toml").string() +
                           ":2: painting.look: found \"wet_in_wet\", allowed: the looks of none: "
                           "default");
  request_.siteFile = write("s.toml", "[painting]\nview = \"cels\"\n");
  EXPECT_THAT(refusal(), StartsWith(path("s.toml").string() +
                                    ":2: painting.view: found \"cels\" (did you mean \"cells\"?), "
                                    "allowed: the views of watercolor: finished, camera, ar, "));
}

TEST_F(ConfigurationTest, EveryLookOfEveryStyleIsTaken) {
  for (const styles::StyleInfo& style : styles::styleInfos()) {
    for (const styles::Look& look : style.looks) {
      request_.options = {{"painting.style", std::string(style.name), "--style"},
                          {"painting.look", std::string(look.name), "--look"}};
      EXPECT_EQ(resolved().styleParameters(), style.parametersOf(look.name)) << look.name;
    }
  }
}

// ---- the command line

TEST_F(ConfigurationTest, SetTakesParametersOfTheStyleAndNamedKeys) {
  request_.set = {"cell_size=20", "camera.rate=12.5", "style.watercolor.wobble=1"};
  const Configuration configuration = resolved();
  EXPECT_EQ(configuration.styleParameters().text("cell_size"), "20");
  EXPECT_EQ(configuration.styleParameters().text("wobble"), "1");
  EXPECT_EQ(configuration.camera().framesPerSecond, 12.5);
  EXPECT_EQ(configuration.origin("camera.rate"), "--set camera.rate");
}

TEST_F(ConfigurationTest, OfSeveralSetsTheLastWins) {
  request_.set = {"cell_size=20", "cell_size=21"};
  EXPECT_EQ(resolved().styleParameters().text("cell_size"), "21");
}

TEST_F(ConfigurationTest, SetIsOfTheStyleThatTheCommandLineChooses) {
  request_.set = {"cell_size=20", "painting.style=none"};
  EXPECT_THAT(refusal(),
              StartsWith("--set cell_size: unknown key (did you mean "
                         "\"style.watercolor.cell_size\"?), allowed: camera.…, painting.…, "));
}

TEST_F(ConfigurationTest, SetNamesItsMistakes) {
  const auto refused = [&](const std::string& setting) {
    request_.set = {setting};
    return refusal();
  };
  const std::string form = ", allowed: NAME=VALUE, such as cell_size=12 or camera.rate=15";
  EXPECT_EQ(refused("cell_size"), "--set: found \"cell_size\"" + form);
  EXPECT_EQ(refused("=8"), "--set: found \"=8\"" + form);
  EXPECT_EQ(refused("cell_size=0"),
            "--set cell_size: found \"0\", allowed: a whole number of px in [4, 64]");
  EXPECT_THAT(refused("cellsize=8"),
              StartsWith("--set cellsize: unknown key (did you mean \"cell_size\"?), allowed: "));
  EXPECT_THAT(refused("look=wet_in_wet"),
              StartsWith("--set look: unknown key (did you mean \"painting.look\"?), allowed: "));
  EXPECT_EQ(refused("camera.rate="),
            "--set camera.rate: found \"\", allowed: a number of frames a second in [1, 240]");
}

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
  const fs::path one = write("1.toml", "[camera]\nseed = 1\n");
  const fs::path two = write("2.toml", "[camera]\nseed = 2\n");
  const fs::path three = write("3.toml", "[camera]\nseed = 3\n");
  request_.siteFile = write("s.toml", "profile = \"1.toml\"\n");  // beside it
  EXPECT_EQ(resolved().origin("camera.seed"), one.string() + ":2");
  request_.environment = {{"PLEINAIR_PROFILE", two.string()}};
  EXPECT_EQ(resolved().origin("camera.seed"), two.string() + ":2");
  request_.profile = three.string();
  EXPECT_EQ(resolved().origin("camera.seed"), three.string() + ":2");
  request_.profile = "none";
  EXPECT_EQ(resolved().origin("camera.seed"), "default");
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
  const fs::path machine = write("machine.toml", "[camera]\nseed = 1\n");
  const fs::path variable = write("variable.toml", "[camera]\nseed = 2\n");
  const fs::path option = write("option.toml", "[camera]\nseed = 3\n");
  request_.defaultSiteFile = machine;
  EXPECT_EQ(resolved().camera().seed, 1);
  EXPECT_THAT(resolved().files(), testing::ElementsAre(machine));
  request_.environment = {{"PLEINAIR_CONFIG", variable.string()}};
  EXPECT_EQ(resolved().camera().seed, 2);
  request_.siteFile = option;
  EXPECT_EQ(resolved().camera().seed, 3);
}

TEST_F(ConfigurationTest, AnEmptyVariableMeansNoSiteFile) {
  request_.defaultSiteFile = write("machine.toml", "[camera]\nseed = 5\n");
  request_.environment = {{"PLEINAIR_CONFIG", ""}};
  EXPECT_EQ(resolved().camera().seed, 1);
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
  request_.siteFile =
      write("s.toml", "\xef\xbb\xbf# a site\r\n[camera]\r\nseed = 7 # of it\r\nrate = 5\r\n");
  const Configuration configuration = resolved();
  EXPECT_EQ(configuration.camera().seed, 7);
  EXPECT_EQ(configuration.origin("camera.rate"), path("s.toml").string() + ":4");
  request_.siteFile = write("s.toml", "\xef\xbb\xbf\r\n\r\n[camera]\r\nsede = 7\r\n");
  EXPECT_THAT(refusal(), StartsWith(path("s.toml").string() + ":4: camera.sede: unknown key"));
  request_.siteFile = write("s.toml", "");
  EXPECT_EQ(refusal(), "(nothing thrown)");
}

TEST_F(ConfigurationTest, RefusesWhatIsNoTomlOrTooMuchOfIt) {
  const auto refused = [&](const std::string& text) {
    request_.siteFile = write("s.toml", text);
    return refusal();
  };
  const std::string name = path("s.toml").string();
  EXPECT_THAT(refused("[camera]\nseed = 1\nseed = 2\n"), StartsWith(name + ":3: not TOML: "));
  EXPECT_THAT(refused("[camera\n"), StartsWith(name + ":1: not TOML: "));
  EXPECT_THAT(refused(std::string("[camera]\nseed\0 = 1\n", 19)),
              StartsWith(name + ":2: not TOML"));
  EXPECT_THAT(refused("a = " + std::string(200'000, '[')), HasSubstr("nested too deeply"));
  EXPECT_THAT(refused(std::string(100'000, 'a') + " = 1\n"), HasSubstr("unknown key"));
  EXPECT_THAT(refused("a" + std::string(50'000, '.') + "a = 1\n"),
              testing::AnyOf(HasSubstr("nested too deeply"), HasSubstr("not TOML")));
  EXPECT_THAT(refused(std::string((1 << 20) + 1, '#')), HasSubstr("too large"));
}

TEST_F(ConfigurationTest, NothingUnknownIsSkipped) {
  const auto refused = [&](const std::string& text) {
    request_.siteFile = write("s.toml", text);
    return refusal();
  };
  const std::string name = path("s.toml").string();
  // Of a style that is not in force, too.
  EXPECT_THAT(refused("[painting]\nstyle = \"none\"\n[style.watercolor]\ncell_sise = 3\n"),
              StartsWith(name + ":4: style.watercolor.cell_sise: unknown key (did you mean "
                                "\"cell_size\"?), allowed: bleeding, cell_size, "));
  EXPECT_EQ(refused("[painting]\nstyle = \"none\"\n[style.watercolor]\ncell_size = 3\n"),
            name +
                ":4: style.watercolor.cell_size: found 3, allowed: a whole number of px in [4, "
                "64]");
  EXPECT_EQ(refused("[style.watercolour]\ncell_size = 8\n"),
            name +
                ":1: style.watercolour: unknown key (did you mean \"watercolor\"?), allowed: "
                "none, painterly, watercolor");
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
                          {"PLEINAIR_OUTPUT_TARGET", "/out.mp4"},
                          {"PLEINAIR_STYLE_WATERCOLOR_CELL_SIZE", "9"}};
  const Configuration configuration = resolved();
  EXPECT_EQ(configuration.camera().source, "/in.mp4");
  EXPECT_EQ(configuration.painting().style, "none");
  EXPECT_EQ(configuration.painting().size, (config::PixelSize{320, 240}));
  EXPECT_EQ(configuration.output().target, "/out.mp4");
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

// ---- what comes later

TEST_F(ConfigurationTest, BlamesThePlaceThatNamedAFile) {
  request_.siteFile = write("s.toml", "[painting]\nscene = \"absent.toml\"\n");
  const Configuration configuration = resolved();
  const auto message = [](const Configuration& of) -> std::string {
    try {
      of.blaming([&] { return configuredScene(of); });
    } catch (const config::ConfigError& error) {
      return error.what();
    }
    return "(nothing thrown)";
  };
  EXPECT_EQ(message(configuration),
            path("s.toml").string() + ":2: painting.scene: " + path("absent.toml").string() +
                ": cannot open: No such file or directory, allowed: a TOML file of at most 1 MiB");
  // One that a person has just typed is known to them.
  request_.options = {{"painting.scene", path("typed.toml").string(), "--scene"}};
  EXPECT_THAT(message(resolved()), StartsWith(path("typed.toml").string() + ": cannot open"));
}

TEST_F(ConfigurationTest, LeavesAMistakeWithinAFileToItsLine) {
  request_.siteFile = write("s.toml", "[painting]\nscene = \"scene.toml\"\n");
  write("scene.toml", "[[tag]]\nid = -1\n");
  const Configuration configuration = resolved();
  try {
    configuration.blaming([&] { return configuredScene(configuration); });
    ADD_FAILURE() << "nothing thrown";
  } catch (const config::ConfigError& error) {
    EXPECT_THAT(error.what(), StartsWith(path("scene.toml").string() + ":2: tag[0].id: "));
  }
}

TEST_F(ConfigurationTest, BlamesThePlaceOfWhatADeviceRefuses) {
  request_.environment = {{"PLEINAIR_CAMERA_SOURCE", "/gone.mp4"}};
  const Configuration configuration = resolved();
  const auto subject = [&](const std::string& of) {
    try {
      configuration.blaming([&] { throw hal::StartupError({.subject = of, .problem = "no"}); });
    } catch (const hal::StartupError& error) {
      return error.error().subject;
    }
    return std::string("(nothing thrown)");
  };
  EXPECT_EQ(subject("/gone.mp4"), "PLEINAIR_CAMERA_SOURCE: camera.source: /gone.mp4");
  EXPECT_EQ(subject("/other.mp4"), "/other.mp4");
}

// ---- what is printed

TEST_F(ConfigurationTest, WhatItPrintsIsASiteFileOfTheSameValues) {
  request_.profile = "kiosk";
  request_.siteFile =
      write("s.toml", "[painting]\nscene = \"a \\\"b\\\".toml\"\nsize = \"320x240\"\n");
  request_.environment = {{"PLEINAIR_CAMERA_RATE", "12.5"}};
  request_.options = {{"painting.look", "wet_in_wet", "--look"}};
  request_.set = {"wobble=0.1"};
  const Configuration configuration = resolved();
  for (const auto which : {config::Printed::kAll, config::Printed::kGiven}) {
    fs::create_directories(path("elsewhere"));
    ConfigurationRequest again;
    again.defaultSiteFile = write("elsewhere/copy.toml", configuration.toToml(which));
    const Configuration copy(again);
    EXPECT_EQ(copy.styleParameters(), configuration.styleParameters());
    EXPECT_EQ(copy.painting().scene, path("a \"b\".toml"));
    EXPECT_EQ(copy.painting().look, "wet_in_wet");
    EXPECT_EQ(copy.painting().size, configuration.painting().size);
    EXPECT_EQ(copy.camera().framesPerSecond, 12.5);
    EXPECT_EQ(copy.output().target, configuration.output().target);
    EXPECT_EQ(copy.camera().source, configuration.camera().source);
  }
}

TEST_F(ConfigurationTest, TheShortFormKeepsALookOpen) {
  request_.options = {{"painting.look", "wet_in_wet", "--look"}};
  const std::string given = resolved().toToml(config::Printed::kGiven);
  EXPECT_THAT(given, HasSubstr("look = \"wet_in_wet\"  # --look\n"));
  EXPECT_THAT(given, testing::Not(HasSubstr("bleeding")));
}

TEST_F(ConfigurationTest, TellsEveryKindOfOrigin) {
  request_.profile = "kiosk";
  request_.siteFile = write("s.toml", "[camera]\nseed = 5\n");
  request_.environment = {{"PLEINAIR_CAMERA_RATE", "12.5"}};
  request_.options = {{"painting.look", "wet_in_wet", "--look"}};
  request_.set = {"wobble=0.1"};
  const std::string toml = resolved().toToml(config::Printed::kAll);
  for (const std::string line :
       {"profile = \"kiosk\"  # --profile\n", "cell_size = 12  # profile kiosk:14\n",
        "rate = 12.5  # PLEINAIR_CAMERA_RATE\n", "look = \"wet_in_wet\"  # --look\n",
        "wobble = 0.1  # --set wobble\n", "bleeding = 2  # look wet_in_wet\n",
        "view = \"finished\"  # default\n"}) {
    EXPECT_THAT(toml, HasSubstr("\n" + line));
  }
  EXPECT_THAT(toml, HasSubstr("\nseed = 5  # " + path("s.toml").string() + ":2\n"));
}

// ---- what it means

TEST_F(ConfigurationTest, BecomesAPaintersOptions) {
  request_.set = {"painting.view=cells", "painting.size=320x240", "cell_size=20"};
  const PaintingOptions options = configuredPainting(resolved(), {.output = "o.mp4"});
  EXPECT_EQ(options.output, "o.mp4");
  EXPECT_EQ(options.style, "watercolor");
  EXPECT_EQ(options.view, "cells");
  EXPECT_EQ(options.size, (hal::FrameSize{320, 240}));
  ASSERT_TRUE(options.parameters);
  EXPECT_EQ(options.parameters->text("cell_size"), "20");
  request_.set.clear();
  const PaintingOptions plain = configuredPainting(resolved(), {});
  EXPECT_EQ(plain.view, "");
  EXPECT_FALSE(plain.size);
}

TEST_F(ConfigurationTest, BecomesASyntheticCamerasOptions) {
  request_.set = {"camera.rate=25",
                  "camera.size=320x240",
                  "camera.seed=7",
                  "camera.noise=0",
                  "camera.source=synthetic:roll",
                  "camera.exposure_drift=0.5",
                  "camera.white_balance_drift=0.1",
                  "camera.readout=0.5"};
  const CameraSettings camera = resolved().camera();
  EXPECT_TRUE(isSynthetic(camera));
  const hal::SyntheticOptions options = syntheticOptions(camera);
  EXPECT_EQ(options.framePeriod, std::chrono::milliseconds(40));
  EXPECT_EQ(options.size, (hal::FrameSize{320, 240}));
  EXPECT_EQ(options.seed, 7u);
  EXPECT_EQ(options.noiseSigma, 0);
  EXPECT_EQ(options.shot, hal::SyntheticShot::kRoll);
  EXPECT_EQ(options.exposureDriftStops, 0.5);
  EXPECT_EQ(options.whiteBalanceDrift, 0.1);
  EXPECT_EQ(options.rowTime, std::chrono::nanoseconds(40'000'000 / 2 / 240));
  // The defaults are the camera's own.
  const hal::SyntheticOptions defaults = syntheticOptions(CameraSettings());
  EXPECT_EQ(defaults.framePeriod, hal::SyntheticOptions().framePeriod);
  EXPECT_EQ(defaults.noiseSigma, hal::SyntheticOptions().noiseSigma);
  EXPECT_EQ(defaults.seed, hal::SyntheticOptions().seed);
  EXPECT_EQ(defaults.shot, hal::SyntheticOptions().shot);
  EXPECT_EQ(defaults.rowTime, hal::SyntheticOptions().rowTime);
  EXPECT_EQ(defaults.size, hal::SyntheticOptions().size);
}

}  // namespace
}  // namespace pleinair::app
