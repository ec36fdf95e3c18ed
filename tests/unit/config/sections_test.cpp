#include "config/sections.h"

#include <array>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/parameter_table.h"
#include "tests/unit/config/thrown_error.h"

namespace pleinair::config {
namespace {

using testing::HasSubstr;

struct Root {
  std::string title = "untitled";
};
struct Camera {
  double rate = 30;
  int seed = 1;
};
struct Oil {
  int brushSize = 8;
  int seed = 2;
};

Sections sections() {
  static const ParameterTable<Root> kRoot{
      textParameter("title", &Root::title, "a title", "What it is called.")};
  static const ParameterTable<Camera> kCamera{
      numberParameter("rate", &Camera::rate, {.min = 1, .max = 240}, "Frames a second."),
      integerParameter("seed", &Camera::seed, {.min = 0}, "Of the noise.")};
  static const ParameterTable<Oil> kOil{
      integerParameter("brush-size", &Oil::brushSize, {.min = 1, .max = 64}, "Of a brush."),
      integerParameter("seed", &Oil::seed, {.min = 0}, "Of the strokes.")};
  static const auto kNothing =
      std::make_shared<const ParameterList>(std::vector<ParameterDescriptor>{});
  return Sections({{"", "", kRoot.defaults()},
                   {"camera", "What is painted.", kCamera.defaults()},
                   {"style.oil", "", kOil.defaults()},
                   {"style.none", "", ParameterValues(kNothing)}},
                  "APP_");
}

std::string refusal(const std::string& toml) {
  Sections all = sections();
  return thrownBy([&] { all.apply(TomlDocument::parseText(toml, "site.toml")); });
}

std::string refusalOf(const std::string& variable, const std::string& value) {
  Sections all = sections();
  const std::vector<std::string> others{"APP_CONFIG"};
  return thrownBy([&] { all.apply(EnvironmentVariable{variable, value}, others); });
}

TEST(Sections, TakeAFile) {
  Sections all = sections();
  all.apply(
      TomlDocument::parseText("title = 't'\n[camera]\nrate = 15\n[style.oil]\n"
                              "brush-size = 3\n[style.none]\n",
                              "site.toml"));
  EXPECT_EQ(all.values("").text("title"), "t");
  EXPECT_EQ(all.values("camera").text("rate"), "15");
  EXPECT_EQ(all.values("style.oil").text("brush-size"), "3");
  EXPECT_EQ(all.origin("title"), "site.toml:1");
  EXPECT_EQ(all.origin("camera.rate"), "site.toml:3");
  EXPECT_EQ(all.origin("camera.seed"), "default");
  EXPECT_EQ(all.origin("style.oil.brush-size"), "site.toml:5");
}

TEST(Sections, TakeDottedKeysAndInlineTables) {
  Sections all = sections();
  all.apply(TomlDocument::parseText("style.oil.seed = 9\ncamera = {rate = 5}\n", "s"));
  EXPECT_EQ(all.values("style.oil").text("seed"), "9");
  EXPECT_EQ(all.values("camera").text("rate"), "5");
}

TEST(Sections, NameWhatTheyDoNotKnowInAFile) {
  EXPECT_EQ(refusal("[camera]\nrat = 3\n"),
            "site.toml:2: camera.rat: unknown key (did you mean \"rate\"?), allowed: rate, seed");
  EXPECT_EQ(refusal("\n[camra]\nrate = 3\n"),
            "site.toml:2: camra: unknown key (did you mean \"camera\"?), allowed: camera, style, "
            "title");
  EXPECT_EQ(refusal("[style.oill]\n"),
            "site.toml:1: style.oill: unknown key (did you mean \"oil\"?), allowed: none, oil");
  EXPECT_EQ(refusal("[style.none]\nseed = 1\n"),
            "site.toml:2: style.none.seed: unknown key (it belongs to [camera]), allowed: none");
  EXPECT_EQ(refusal("brush-size = 3\n"),
            "site.toml:1: brush-size: unknown key (it belongs to [style.oil]), allowed: camera, "
            "style, title");
  EXPECT_EQ(refusal("[camera]\ntitle = 't'\n"),
            "site.toml:2: camera.title: unknown key (it belongs before all tables), allowed: rate, "
            "seed");
  EXPECT_EQ(refusal("[camera.lens]\n"),
            "site.toml:1: camera.lens: unknown key, allowed: rate, seed");
}

TEST(Sections, NameTheFirstOfSeveralUnknownKeys) {
  EXPECT_THAT(refusal("[camera]\nzoom = 3\nangle = 4\n"), HasSubstr("site.toml:2: camera.zoom"));
}

TEST(Sections, NameWhatIsNoTable) {
  EXPECT_EQ(refusal("camera = 3\n"), "site.toml:1: camera: found 3 (integer), allowed: a table");
  EXPECT_EQ(refusal("[[camera]]\nrate = 3\n"),
            "site.toml:1: camera: found an array of 1, allowed: a table");
  EXPECT_EQ(refusal("style = 'oil'\n"),
            "site.toml:1: style: found \"oil\" (string), allowed: a table");
  EXPECT_EQ(refusal("[title]\n"), "site.toml:1: title: found a table, allowed: a title");
}

TEST(Sections, AreLeftAloneByAFileThatIsWrong) {
  Sections all = sections();
  EXPECT_NE(
      thrownBy([&] {
        all.apply(TomlDocument::parseText("[camera]\nseed = 5\n[style.oil]\nseed = -1\n", "s"));
      }),
      "(nothing thrown)");
  EXPECT_EQ(all.values("camera").text("seed"), "1");
  EXPECT_EQ(all.origin("camera.seed"), "default");
}

TEST(Sections, TakeVariables) {
  Sections all = sections();
  all.apply(EnvironmentVariable{"APP_STYLE_OIL_BRUSH_SIZE", "4"});
  all.apply(EnvironmentVariable{"APP_TITLE", "of it"});
  EXPECT_EQ(all.values("style.oil").text("brush-size"), "4");
  EXPECT_EQ(all.origin("style.oil.brush-size"), "APP_STYLE_OIL_BRUSH_SIZE");
  EXPECT_EQ(all.values("").text("title"), "of it");
}

TEST(Sections, NameVariablesThatAreWrong) {
  EXPECT_EQ(refusalOf("APP_CAMERA_RATE", "fast"),
            "APP_CAMERA_RATE: found \"fast\", allowed: a number in [1, 240]");
  EXPECT_EQ(refusalOf("APP_CAMERA_RATE", ""),
            "APP_CAMERA_RATE: found \"\", allowed: a number in [1, 240]");
  EXPECT_EQ(refusalOf("APP_CAMERA_RAT", "3"),
            "APP_CAMERA_RAT: unknown variable (did you mean \"APP_CAMERA_RATE\"?), allowed: "
            "APP_CAMERA_RATE, APP_CAMERA_SEED");
  EXPECT_EQ(refusalOf("APP_CONFIGG", "3"),
            "APP_CONFIGG: unknown variable (did you mean \"APP_CONFIG\"?), allowed: APP_CONFIG, "
            "APP_TITLE, APP_CAMERA_…, APP_STYLE_OIL_…");
  EXPECT_EQ(refusalOf("APP_", "3"),
            "APP_: unknown variable, allowed: APP_CONFIG, APP_TITLE, APP_CAMERA_…, "
            "APP_STYLE_OIL_…");
}

TEST(Sections, TakeSingleKeys) {
  Sections all = sections();
  all.apply("camera.rate", "12", "--rate");
  all.apply("seed", "6", "--set seed", "style.oil");
  EXPECT_EQ(all.values("camera").text("rate"), "12");
  EXPECT_EQ(all.origin("camera.rate"), "--rate");
  EXPECT_EQ(all.values("style.oil").text("seed"), "6");
}

TEST(Sections, NameSingleKeysThatAreWrong) {
  const auto refused = [](const char* key, const char* text, const char* section) {
    Sections all = sections();
    return thrownBy([&] { all.apply(key, text, "--set", section); });
  };
  EXPECT_EQ(refused("camera.rate", "0", ""), "--set: found \"0\", allowed: a number in [1, 240]");
  EXPECT_EQ(
      refused("camera.rat", "0", ""),
      "--set: unknown key (did you mean \"camera.rate\"?), allowed: camera.rate, camera.seed");
  EXPECT_EQ(refused("brushsize", "0", "style.oil"),
            "--set: unknown key (did you mean \"brush-size\"?), allowed: brush-size, seed");
  EXPECT_EQ(refused("rate", "0", "style.oil"),
            "--set: unknown key (did you mean \"camera.rate\"?), allowed: brush-size, seed");
  EXPECT_EQ(refused("zoom.in", "0", ""), "--set: unknown key, allowed: camera.…, style.oil.…");
}

TEST(Sections, AttributesThePlaceOfAValue) {
  Sections all = sections();
  all.apply(TomlDocument::parseText("title = 't'\n", "a:b.toml"));
  all.apply("camera.seed", "3", "--seed");
  const ConfigError inFile = all.errorAt("title", "is no good", "better ones");
  EXPECT_STREQ(inFile.what(), "a:b.toml:1: title: is no good, allowed: better ones");
  EXPECT_EQ(inFile.file(), "a:b.toml");
  EXPECT_EQ(inFile.line(), 1);
  EXPECT_STREQ(all.errorAt("camera.seed", "is no good", "").what(), "--seed: is no good");
}

TEST(Sections, RefuseARenamedKeyInEveryLayerAndNameTheNewOne) {
  static constexpr std::array<RenamedKey, 2> kRenamed{
      {{"camera.random", "camera.seed"}, {"style.oil.width", "style.oil.brush-size"}}};
  const Sections plain = sections();
  Sections all({plain.all().begin(), plain.all().end()}, "APP_", kRenamed);
  EXPECT_EQ(thrownBy([&] {
              all.apply(TomlDocument::parseText("[camera]\nrate = 15\nrandom = 1\n", "site.toml"));
            }),
            "site.toml:3: camera.random: is now camera.seed");
  EXPECT_EQ(thrownBy([&] { all.apply("camera.random", "1", "--set camera.random"); }),
            "--set camera.random: is now camera.seed");
  EXPECT_EQ(thrownBy([&] { all.apply("width", "1", "--set width", "style.oil"); }),
            "--set width: is now style.oil.brush-size");
  EXPECT_EQ(thrownBy([&] {
              all.apply(EnvironmentVariable{"APP_CAMERA_RANDOM", "1"});
            }),
            "APP_CAMERA_RANDOM: is now APP_CAMERA_SEED");
  EXPECT_EQ(thrownBy([&] {
              all.apply(EnvironmentVariable{"APP_STYLE_OIL_WIDTH", "1"});
            }),
            "APP_STYLE_OIL_WIDTH: is now APP_STYLE_OIL_BRUSH_SIZE");
  EXPECT_EQ(all.values("camera").text("seed"), "1") << "nothing is taken from it";
}

TEST(Sections, ForgetAKey) {
  Sections all = sections();
  all.apply("camera.seed", "3", "--seed");
  all.forget("camera.seed");
  EXPECT_EQ(all.values("camera").text("seed"), "1");
  EXPECT_EQ(all.origin("camera.seed"), "default");
}

TEST(Sections, PrintAFileThatTheyTake) {
  Sections all = sections();
  all.apply("camera.rate", "12.5", "--rate");
  all.apply("title", "a # \"b\"", "--title");
  Sections again = sections();
  again.apply(TomlDocument::parseText(all.toToml(), "copy.toml"));
  for (std::size_t i = 0; i < all.all().size(); ++i) {
    EXPECT_EQ(again.all()[i].values, all.all()[i].values) << all.toToml();
  }
  EXPECT_EQ(all.toToml(Printed::kGiven),
            "# What it is called.\n"
            "# a title; default: untitled; live\n"
            "title = \"a # \\\"b\\\"\"  # --title\n"
            "\n"
            "# What is painted.\n"
            "[camera]\n"
            "# Frames a second.\n"
            "# a number in [1, 240]; default: 30; live\n"
            "rate = 12.5  # --rate\n");
}

}  // namespace
}  // namespace pleinair::config
