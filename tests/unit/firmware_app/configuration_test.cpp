#include "tests/unit/firmware_app/configuration_test.h"

#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/styles/registry.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;
using testing::StartsWith;

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
  request_.profile =
      write("p.toml", "[camera]\nrate = 10\n[camera.synthetic]\nseed = 5\n").string();
  request_.siteFile = write("s.toml", "[camera.synthetic]\nseed = 6\n");
  EXPECT_EQ(resolved().camera().framesPerSecond, 10);
  EXPECT_EQ(seedOf(resolved()), "6");
}

// ---- looks and styles

TEST_F(ConfigurationTest, ALookReplacesDefaults) {
  request_.options = {{"painting.look", "wet_in_wet", "--look"}};
  const Configuration configuration = resolved();
  const auto look = styles::styleKind("watercolor").parametersOf("wet_in_wet");
  EXPECT_EQ(configuration.styleParameters(), look);
  EXPECT_EQ(configuration.styleParameters().origin("bleeding"), "look wet_in_wet");
  EXPECT_EQ(configuration.styleParameters().origin("cell_size"), "default");
}

TEST_F(ConfigurationTest, WhatAnyLayerGivesWinsOverTheLookOfAnyOther) {
  const std::string look = "[painting]\nlook = \"wet_in_wet\"\n";
  // Against the look's, were it the default's.
  const std::string usual = styles::styleKind("watercolor").defaults.text("bleeding");
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
  EXPECT_EQ(resolved().styleParameters(), styles::styleKind("watercolor").defaults);
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
                           ":2: painting.look: found \"wet_in_wet\" (a look of watercolor: --style "
                           "watercolor), allowed: the looks of none: default");
  request_.siteFile = write("s.toml", "[painting]\nview = \"cels\"\n");
  EXPECT_THAT(refusal(), StartsWith(path("s.toml").string() +
                                    ":2: painting.view: found \"cels\" (did you mean \"cells\"?), "
                                    "allowed: the views of watercolor: finished, camera, ar, "));
}

TEST_F(ConfigurationTest, ALookOfAnotherStyleChoosesThatStyle) {
  request_.options = {{"painting.look", "oil", "--look"}};
  EXPECT_EQ(resolved().painting().style, "painterly");
  EXPECT_EQ(resolved().origin("painting.style"), "--look");
  request_.siteFile = write("s.toml", "[painting]\nstyle = \"hatching\"\n");
  EXPECT_EQ(resolved().painting().style, "painterly") << "of a weaker layer";
  request_.options.push_back({"painting.style", "watercolor", "--style"});
  EXPECT_THAT(refusal(),
              StartsWith("--look: found \"oil\" (a look of painterly: --style painterly), "
                         "allowed: the looks of watercolor: "));
}

TEST_F(ConfigurationTest, ANameOfAnotherStyleIsRefusedWithThatStyle) {
  const auto refused = [&](const std::string& key, const std::string& text) {
    request_.options = {{"painting." + key, text, "--" + key}};
    return refusal();
  };
  EXPECT_THAT(refused("look", "oill"),
              StartsWith("--look: found \"oill\" (did you mean \"oil\", a look of painterly?), "));
  EXPECT_THAT(refused("look", "glased"), StartsWith("--look: found \"glased\" (did you mean "
                                                    "\"glazed\"?), "));
  EXPECT_THAT(refused("look", "watercolor"),
              StartsWith("--look: found \"watercolor\" (a style: --style watercolor), "));
  EXPECT_THAT(refused("view", "tensors"),
              StartsWith("--view: found \"tensors\" (a view of painterly: --style painterly), "));
  EXPECT_THAT(refused("view", "tensor"),
              StartsWith("--view: found \"tensor\" (did you mean \"tensors\", a view of "
                         "painterly?), "));
  EXPECT_THAT(refused("style", "oil"), StartsWith("--style: found \"oil\" (a look of painterly: "
                                                  "--look oil), allowed: one of watercolor, "));
  EXPECT_THAT(refused("style", "watercolour"),
              StartsWith("--style: found \"watercolour\" (did you mean \"watercolor\"?), "));
}

TEST_F(ConfigurationTest, EveryLookOfEveryStyleIsTaken) {
  for (const styles::StyleKind* style : styles::styleKinds()) {
    for (const styles::Look& look : style->looks) {
      request_.options = {{"painting.style", std::string(style->name), "--style"},
                          {"painting.look", std::string(look.name), "--look"}};
      EXPECT_EQ(resolved().styleParameters(), style->parametersOf(look.name)) << look.name;
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
  EXPECT_THAT(
      refusal(),
      StartsWith("--set cell_size: unknown key (did you mean "
                 "\"style.watercolor.cell_size\"?), allowed: camera.…, camera.libcamera.…, "));
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

}  // namespace
}  // namespace pleinair::app
