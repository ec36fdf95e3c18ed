#include <array>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/parameter_table.h"
#include "tests/unit/config/thrown_error.h"

namespace pleinair::config {
namespace {

using testing::ElementsAre;

enum class View { kPicture, kCells };
constexpr std::array<Choice<View>, 2> kViews = {
    {{"picture", View::kPicture}, {"cells", View::kCells}}};

struct Parameters {
  double cellSize = 8;
  double drying = 0.25;
  int seed = 1;
  bool paper = true;
  View view = View::kPicture;
  bool operator==(const Parameters&) const = default;
};

const ParameterTable<Parameters>& table() {
  static const ParameterTable<Parameters> parameters{
      numberParameter("cell_size", &Parameters::cellSize, {.min = 2, .max = 64, .unit = "px"},
                      "Side of a Voronoi cell."),
      numberParameter("drying", &Parameters::drying, {.min = 0, .minOpen = true, .unit = "s"},
                      "Time constant of the paint."),
      integerParameter("seed", &Parameters::seed, {.min = 0}, "Of the noise.",
                       TakesEffect::kRestart),
      switchParameter("paper", &Parameters::paper, "Lay the picture on paper."),
      choiceParameter("view", &Parameters::view, kViews, "What is shown."),
  };
  return parameters;
}

TomlTable parsed(std::string_view text) {
  return TomlDocument::parseText(text, "p.toml").root();
}

TEST(Parameter, DefaultsAreTheStructs) {
  const ParameterValues values = table().defaults();
  EXPECT_EQ(table().typed(values), Parameters());
  EXPECT_THAT(values.list().names(), ElementsAre("cell_size", "drying", "seed", "paper", "view"));
  const ParameterDescriptor& cellSize = values.list().descriptors()[0];
  EXPECT_EQ(cellSize.kind(), ParameterKind::kNumber);
  EXPECT_EQ(cellSize.unit(), "px");
  EXPECT_EQ(values.list().descriptors()[4].kind(), ParameterKind::kChoice);
  EXPECT_EQ(values.origin("seed"), "default");
}

TEST(Parameter, AChangeIsANewSnapshot) {
  const ParameterValues before = table().defaults();
  const ParameterValues after = before.with("cell_size", "9.5", "--set")
                                    .with("seed", "7")
                                    .with("paper", "false")
                                    .with("view", "cells");
  EXPECT_EQ(table().typed(before), Parameters());
  EXPECT_EQ(table().typed(after),
            (Parameters{.cellSize = 9.5, .seed = 7, .paper = false, .view = View::kCells}));
  EXPECT_EQ(after.text("cell_size"), "9.5");
  EXPECT_EQ(after.text("view"), "cells");
  EXPECT_EQ(after.origin("cell_size"), "--set");
  EXPECT_EQ(after.origin("drying"), "default");
}

TEST(Parameter, SwitchesTakeOnAndOff) {
  const ParameterValues values = table().defaults();
  EXPECT_EQ(values.with("paper", "off", "--set").text("paper"), "false");
  EXPECT_EQ(values.with("paper", "on", "--set").text("paper"), "true");
}

TEST(Parameter, SaysWhatTextIsAllowed) {
  const ParameterValues values = table().defaults();
  const auto refusal = [&](const char* name, const char* text) {
    return thrownBy([&] { (void)values.with(name, text, "--set"); });
  };
  EXPECT_EQ(refusal("cell_size", "900"),
            "--set: cell_size: found \"900\", allowed: a number of px in [2, 64]");
  EXPECT_EQ(refusal("drying", "0"), "--set: drying: found \"0\", allowed: a number of s above 0");
  EXPECT_EQ(refusal("seed", "1.5"),
            "--set: seed: found \"1.5\", allowed: a whole number at least 0");
  EXPECT_EQ(refusal("paper", "yes"), "--set: paper: found \"yes\", allowed: true or false");
  EXPECT_EQ(refusal("view", "seeds"),
            "--set: view: found \"seeds\", allowed: one of picture, cells");
  EXPECT_EQ(
      refusal("view", "cell"),
      "--set: view: found \"cell\" (did you mean \"cells\"?), allowed: one of picture, cells");
  EXPECT_EQ(refusal("cel_size", "8"),
            "--set: cel_size: unknown parameter (did you mean \"cell_size\"?), allowed: cell_size, "
            "drying, seed, paper, view");
  for (const char* text : {"", " 8", "8 ", "8px", "nan", "inf", "1e999", "0x8", "8,5"}) {
    EXPECT_NE(refusal("drying", text), "(nothing thrown)") << text;
  }
  EXPECT_NE(refusal("seed", "99999999999"), "(nothing thrown)");
}

TEST(Parameter, ComesFromToml) {
  const ParameterValues values = table()
                                     .defaults()
                                     .with("seed", "7", "--set")
                                     .with(parsed("view = 'cells'\ncell_size = 12\n"));
  EXPECT_EQ(table().typed(values), (Parameters{.cellSize = 12, .seed = 7, .view = View::kCells}));
  EXPECT_EQ(values.origin("cell_size"), "p.toml:2");
  EXPECT_EQ(values.origin("seed"), "--set");
}

TEST(Parameter, SaysWhereTomlIsWrong) {
  const auto refusal = [](const char* text) {
    return thrownBy([&] { (void)table().defaults().with(parsed(text)); });
  };
  EXPECT_EQ(refusal("\ncell_size = 1"),
            "p.toml:2: cell_size: found 1, allowed: a number of px in [2, 64]");
  EXPECT_EQ(refusal("seed = true"),
            "p.toml:1: seed: found true (boolean), allowed: a whole number at least 0");
  EXPECT_EQ(refusal("views = 'cells'"),
            "p.toml:1: views: unknown key (did you mean \"view\"?), allowed: cell_size, drying, "
            "seed, paper, view");
}

TEST(Parameter, PrintsATomlTableWithItsHelp) {
  EXPECT_EQ(table().defaults().with("view", "cells", "site.toml:3").toToml(),
            "# Side of a Voronoi cell.\n"
            "# a number of px in [2, 64]; default: 8; live\n"
            "cell_size = 8  # default\n"
            "\n"
            "# Time constant of the paint.\n"
            "# a number of s above 0; default: 0.25; live\n"
            "drying = 0.25  # default\n"
            "\n"
            "# Of the noise.\n"
            "# a whole number at least 0; default: 1; at the next start\n"
            "seed = 1  # default\n"
            "\n"
            "# Lay the picture on paper.\n"
            "# true or false; default: true; live\n"
            "paper = true  # default\n"
            "\n"
            "# What is shown.\n"
            "# one of picture, cells; default: picture; live\n"
            "view = \"cells\"  # site.toml:3\n");
}

TEST(Parameter, PrintsWhatWasGivenAlone) {
  EXPECT_EQ(table().defaults().toToml(Printed::kGiven), "");
  // A value that was set counts as set even if it equals the default.
  EXPECT_EQ(table().defaults().with("seed", "1", "--set").toToml(Printed::kGiven),
            "# Of the noise.\n"
            "# a whole number at least 0; default: 1; at the next start\n"
            "seed = 1  # --set\n");
}

TEST(Parameter, SurvivesPrintingAndParsing) {
  for (const double drying :
       {0.1, 1.0 / 3.0, 1e-7, 5e-324, 1e22, std::numeric_limits<double>::max()}) {
    const Parameters given{
        .drying = drying, .seed = 2147483647, .paper = false, .view = View::kCells};
    const ParameterValues values = table().valuesOf(given, "host");
    EXPECT_EQ(table().typed(table().defaults().with(parsed(values.toToml()))), given) << drying;
    ParameterValues copied = table().defaults();
    for (const std::string& name : values.list().names()) {
      copied = copied.with(name, values.text(name));
    }
    EXPECT_EQ(copied, values) << drying;
  }
}

TEST(Parameter, ChecksTheStructOfAHost) {
  EXPECT_EQ(thrownBy([] { table().valuesOf({.cellSize = 1}, "host"); }),
            "host: cell_size: found 1, allowed: a number of px in [2, 64]");
  EXPECT_EQ(thrownBy([] { table().valuesOf({.view = static_cast<View>(9)}, "host"); }),
            "host: view: found a value without a name, allowed: one of picture, cells");
}

TEST(Parameter, KnowsWhatNeedsARestart) {
  const ParameterValues before = table().defaults();
  EXPECT_FALSE(before.needsRestartFor(before.with("cell_size", "9")));
  EXPECT_TRUE(before.needsRestartFor(before.with("seed", "9")));
  EXPECT_FALSE(before.needsRestartFor(before.with("seed", "1")));
  EXPECT_EQ(before, before.with("seed", "1", "--set"));
  EXPECT_FALSE(before == before.with("seed", "2"));
}

}  // namespace
}  // namespace pleinair::config
