#include <array>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/toml_reader.h"
#include "tests/unit/config/thrown_error.h"

namespace pleinair::config {
namespace {

using testing::ElementsAre;

constexpr const char* kScene = R"(title = "desk"
frames = 12
quiet = true
scale = -inf

[[tag]]
id = 3
edge = "big"
position = [0, 0.5,
            "x"]

[[tag]]
id = 587
edge = 0.08
family = "tag36h12"
position = [1, 2]

[camera.lens]
focal = 7
date = 2024-01-01
)";

constexpr NumberRange kEdge{.min = 0, .max = 10, .minOpen = true, .unit = "metres"};
constexpr IntegerRange kId{.min = 0, .max = 586};

TomlTable parsed(std::string_view text) {
  return TomlDocument::parseText(text, "scene.toml").root();
}

TEST(TomlTable, GivesTypedValues) {
  const TomlTable root = parsed(kScene);
  EXPECT_EQ(root.string("title"), "desk");
  EXPECT_EQ(root.integer("frames", {.min = 1}), 12);
  EXPECT_EQ(root.number("frames"), 12.0);
  EXPECT_TRUE(root.boolean("quiet"));
  const auto tags = root.tables("tag");
  ASSERT_EQ(tags.size(), 2u);
  EXPECT_EQ(tags[0].integer("id", kId), 3);
  EXPECT_EQ(tags[1].number("edge", kEdge), 0.08);
  EXPECT_THAT(tags[1].vector<2>("position"), ElementsAre(1.0, 2.0));
  EXPECT_EQ(tags[1].numbers("position", {1, 2}), (std::vector<double>{1, 2}));
  EXPECT_EQ(root.table("camera").table("lens").number("focal"), 7.0);
}

TEST(TomlTable, GivesNothingForAnAbsentOptional) {
  const TomlTable root = parsed(kScene);
  EXPECT_EQ(root.optionalString("x"), std::nullopt);
  EXPECT_EQ(root.optionalNumber("x").value_or(2.5), 2.5);
  EXPECT_EQ(root.optionalInteger("x"), std::nullopt);
  EXPECT_EQ(root.optionalBoolean("x"), std::nullopt);
  EXPECT_EQ(root.optionalNumbers("x"), std::nullopt);
  EXPECT_EQ(root.optionalVector<3>("x"), std::nullopt);
  EXPECT_EQ(root.optionalChoice("x", std::vector<std::string>{"a"}), std::nullopt);
  EXPECT_FALSE(root.optionalTable("x").has_value());
  EXPECT_TRUE(root.tables("x").empty());
}

TEST(TomlTable, TakesOnAndOffForSwitches) {
  const TomlTable root = parsed("a = \"on\"\nb = \"off\"\nc = \"yes\"\n");
  EXPECT_TRUE(root.boolean("a"));
  EXPECT_FALSE(root.boolean("b"));
  EXPECT_EQ(thrownBy([&] { root.boolean("c"); }),
            "scene.toml:3: c: found \"yes\" (string), allowed: true or false");
}

TEST(TomlTable, TakesNumbersForWordsThatAreNumbers) {
  const TomlTable root = parsed("a = 90\nb = \"90\"\nc = 45\nd = true\n");
  const std::vector<std::string> turns{"0", "90"};
  EXPECT_EQ(root.optionalChoice("a", turns), 1U);
  EXPECT_EQ(root.optionalChoice("b", turns), 1U);
  EXPECT_EQ(thrownBy([&] { root.optionalChoice("c", turns); }),
            "scene.toml:3: c: found 45 (integer), allowed: 0, 90");
  EXPECT_EQ(thrownBy([&] { root.optionalChoice("d", turns); }),
            "scene.toml:4: d: found true (boolean), allowed: 0, 90");
}

TEST(TomlTable, SaysWhatIsMissing) {
  const TomlTable root = parsed(kScene);
  EXPECT_EQ(thrownBy([&] { root.tables("tag")[1].string("name"); }),
            "scene.toml:12: tag[1].name: missing, allowed: a string");
  EXPECT_EQ(thrownBy([&] { root.table("camera").table("lens").vector<3>("k"); }),
            "scene.toml:18: camera.lens.k: missing, allowed: an array of 3 numbers");
  EXPECT_EQ(thrownBy([&] { root.table("world"); }), "scene.toml: world: missing, allowed: a table");
}

TEST(TomlTable, SaysWhatTypeWasFound) {
  const TomlTable root = parsed(kScene);
  const TomlTable tag = root.tables("tag")[0];
  EXPECT_EQ(
      thrownBy([&] { tag.number("edge", kEdge); }),
      "scene.toml:8: tag[0].edge: found \"big\" (string), allowed: a number of metres in (0, 10]");
  EXPECT_EQ(thrownBy([&] { root.string("frames"); }),
            "scene.toml:2: frames: found 12 (integer), allowed: a string");
  EXPECT_EQ(thrownBy([&] { root.tables("tag")[1].integer("edge"); }),
            "scene.toml:14: tag[1].edge: found 0.08 (number), allowed: a whole number");
  EXPECT_EQ(thrownBy([&] { root.boolean("frames"); }),
            "scene.toml:2: frames: found 12 (integer), allowed: true or false");
  EXPECT_EQ(thrownBy([&] { root.number("quiet"); }),
            "scene.toml:3: quiet: found true (boolean), allowed: a number");
  EXPECT_EQ(thrownBy([&] { root.table("tag"); }),
            "scene.toml:6: tag: found an array of 2, allowed: a table");
  EXPECT_EQ(thrownBy([&] { root.tables("camera"); }),
            "scene.toml:18: camera: found a table, allowed: an array of tables, [[camera]]");
  EXPECT_EQ(thrownBy([&] { root.table("camera").table("lens").number("date"); }),
            "scene.toml:20: camera.lens.date: found a date or time, allowed: a number");
}

TEST(TomlTable, SaysWhatRangeIsAllowed) {
  const TomlTable root = parsed(kScene);
  EXPECT_EQ(thrownBy([&] { root.tables("tag")[1].integer("id", kId); }),
            "scene.toml:13: tag[1].id: found 587, allowed: a whole number in [0, 586]");
  EXPECT_EQ(thrownBy([&] { root.number("scale"); }),
            "scene.toml:4: scale: found -inf, allowed: a number");
  EXPECT_EQ(thrownBy([&] { root.number("frames", {.max = 12, .maxOpen = true, .unit = "s"}); }),
            "scene.toml:2: frames: found 12, allowed: a number of s below 12");
  EXPECT_EQ(thrownBy([&] { root.number("frames", {.min = 12, .minOpen = true}); }),
            "scene.toml:2: frames: found 12, allowed: a number above 12");
  EXPECT_EQ(thrownBy([&] { root.integer("frames", {.min = 13, .unit = "frames"}); }),
            "scene.toml:2: frames: found 12, allowed: a whole number of frames at least 13");
  const TomlTable big = parsed("id = 9223372036854775807");
  EXPECT_EQ(thrownBy([&] { big.integer("id"); }),
            "scene.toml:1: id: found 9223372036854775807, allowed: a whole number");
  EXPECT_EQ(root.number("frames", {.min = 12, .max = 12}), 12);
}

TEST(TomlTable, NamesTheElementOfAnArray) {
  const TomlTable root = parsed(kScene);
  const auto tags = root.tables("tag");
  EXPECT_EQ(thrownBy([&] { tags[0].vector<3>("position", {.unit = "metres"}); }),
            "scene.toml:10: tag[0].position[2]: found \"x\" (string), allowed: a number of metres");
  EXPECT_EQ(
      thrownBy([&] { tags[1].vector<3>("position", {.unit = "metres"}); }),
      "scene.toml:16: tag[1].position: found an array of 2, allowed: an array of 3 numbers of "
      "metres");
  EXPECT_EQ(
      thrownBy([&] {
        tags[1].numbers("position", {4, 8});
      }),
      "scene.toml:16: tag[1].position: found an array of 2, allowed: an array of 4 to 8 numbers");
  EXPECT_EQ(
      thrownBy([&] { tags[1].numbers("id", {4}); }),
      "scene.toml:13: tag[1].id: found 587 (integer), allowed: an array of at least 4 numbers");
  const TomlTable mixed = parsed("models = [\n  {name = 'a'},\n  3]");
  EXPECT_EQ(thrownBy([&] { mixed.tables("models"); }),
            "scene.toml:3: models[1]: found 3 (integer), allowed: a table");
}

enum class Family { k16h5, k36h11 };
constexpr std::array<Choice<Family>, 2> kFamilies = {
    {{"tag16h5", Family::k16h5}, {"tag36h11", Family::k36h11}}};

TEST(TomlTable, TakesChoices) {
  EXPECT_EQ(parsed("family = 'tag36h11'").choice("family", kFamilies), Family::k36h11);
  EXPECT_EQ(parsed("").optionalChoice("family", kFamilies), std::nullopt);
  const TomlTable root = parsed(kScene);
  EXPECT_EQ(thrownBy([&] { root.tables("tag")[1].choice("family", kFamilies); }),
            "scene.toml:15: tag[1].family: found \"tag36h12\" (did you mean \"tag36h11\"?), "
            "allowed: tag16h5, tag36h11");
  EXPECT_EQ(thrownBy([&] { root.choice("frames", kFamilies); }),
            "scene.toml:2: frames: found 12 (integer), allowed: tag16h5, tag36h11");
}

TEST(TomlTable, RefusesUnknownKeys) {
  const TomlTable root = parsed("\nedge = 1\nfamliy = 'x'\n");
  root.number("edge");
  root.optionalString("family");
  EXPECT_EQ(thrownBy([&] { root.finish(); }),
            "scene.toml:3: famliy: unknown key (did you mean \"family\"?), allowed: edge, family");
  root.string("famliy");
  EXPECT_EQ(thrownBy([&] { root.finish(); }), "(nothing thrown)");
}

TEST(TomlTable, RefusesUnknownKeysOfTheTablesWithin) {
  const TomlTable root = parsed("[a]\nx = 1\n[[b]]\n[[b]]\ny = 1\n");
  root.optionalTable("a")->number("x");
  for (const TomlTable& each : root.tables("b")) each.optionalNumber("z");
  EXPECT_EQ(thrownBy([&] { root.finish(); }), "scene.toml:5: b[1].y: unknown key, allowed: z");
  for (const TomlTable& each : root.tables("b")) each.optionalNumber("y");
  EXPECT_EQ(thrownBy([&] { root.finish(); }), "(nothing thrown)");
}

TEST(TomlTable, HelpsReadersToTheirOwnErrors) {
  const TomlTable root = parsed(kScene);
  const ConfigError error = root.tables("tag")[1].error("id", "id 3 is used twice");
  EXPECT_STREQ(error.what(), "scene.toml:13: tag[1].id: id 3 is used twice");
  EXPECT_EQ(error.file(), "scene.toml");
  EXPECT_EQ(error.line(), 13);
  EXPECT_EQ(error.key(), "tag[1].id");
  EXPECT_TRUE(root.has("tag"));
  EXPECT_FALSE(root.has("tags"));
  EXPECT_THAT(parsed("b = 1\na = 2").keys(), ElementsAre("a", "b"));
}

TEST(TomlTable, OutlivesItsDocument) {
  const TomlTable lens = parsed(kScene).table("camera").table("lens");
  EXPECT_EQ(lens.number("focal"), 7.0);
}

TEST(ConfigError, IsOneShortLine) {
  const TomlTable root = parsed("a = \"x\\n\\u001b[2Jy\"\nb = \"" + std::string(59, 'b') + "äää\"");
  EXPECT_EQ(thrownBy([&] { root.number("a"); }),
            "scene.toml:1: a: found \"x\\n\\x1b[2Jy\" (string), allowed: a number");
  EXPECT_EQ(
      thrownBy([&] { root.number("b"); }),
      "scene.toml:2: b: found \"" + std::string(59, 'b') + "...\" (string), allowed: a number");
}

}  // namespace
}  // namespace pleinair::config
