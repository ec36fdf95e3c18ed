#include "firmware_app/live/interaction/live_tuning.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/parameter_table.h"

namespace pleinair::app {
namespace {

using testing::HasSubstr;
using Request = LiveTuning::Request;

struct Brush {
  int size = 8;
  double water = 0.5;
  int restart = 1;
  bool paper = true;
};

const config::ParameterTable<Brush>& brush() {
  static const config::ParameterTable<Brush> table{
      config::integerParameter("size", &Brush::size, {.min = 4, .max = 64, .unit = "px"},
                               "Of the brush."),
      config::numberParameter("water", &Brush::water, {.min = 0, .max = 1}, "On the brush."),
      config::integerParameter("restart", &Brush::restart, {.min = 0, .max = 9}, "Not live.",
                               config::TakesEffect::kRestart),
      config::switchParameter("paper", &Brush::paper, "Under the paint."),
  };
  return table;
}

const std::vector<DebugView> kViews{{"camera", ""}, {"cells", ""}};

std::vector<LiveLook> looks() {
  return {{"dry", brush().defaults()},
          {"wet", brush().defaults().with("water", "0.9", "look wet").with("size", "20", "look")}};
}

LiveStyle brushStyle(PaintParameters start, std::vector<LiveLook> looks = app::looks()) {
  return {.name = "brush", .start = std::move(start), .views = kViews, .looks = std::move(looks)};
}

class Tuning : public testing::Test {
 protected:
  explicit Tuning(std::vector<LiveLook> looks = app::looks())
      : tuning_({brushStyle({.style = brush().defaults(), .view = {}}, std::move(looks))}) {}

  Request press(const std::string& name, bool shift = false, bool isRepeat = false) {
    return tuning_.press({.name = name, .shift = shift, .isRepeat = isRepeat});
  }
  Request shiftPress(const std::string& name) { return press(name, true); }
  Brush values() const { return brush().typed(tuning_.parameters().style); }
  std::string chosen() const {
    return tuning_.parameterLine().substr(0, tuning_.parameterLine().find(' '));
  }

  LiveTuning tuning_;
};

TEST_F(Tuning, TakesOtherParametersAsAtTheStart) {
  press("tab");
  const auto wet = looks()[1].values;
  tuning_.setParameters("brush", {.style = wet, .view = "cells"});
  EXPECT_EQ(tuning_.parameters().style, wet);
  EXPECT_EQ(tuning_.parameters().view, "cells");
  EXPECT_THAT(tuning_.state(), HasSubstr("wet"));
  EXPECT_EQ(chosen(), "water") << "the choice stays";
}

TEST_F(Tuning, StartsWithWhatItIsGiven) {
  EXPECT_EQ(tuning_.parameters().style, brush().defaults());
  EXPECT_EQ(tuning_.parameters().view, "");
  EXPECT_FALSE(tuning_.isPaused());
  EXPECT_FALSE(tuning_.showsHelp());
  EXPECT_EQ(tuning_.state(), "brush · dry");
  EXPECT_EQ(tuning_.parameterLine(), "size 8 px  (4 to 64)  Of the brush.");
}

TEST_F(Tuning, NamesTheOptionsThatPaintTheSame) {
  using testing::ElementsAre;
  EXPECT_THAT(tuning_.arguments(),
              ElementsAre("--style", "brush", "--look", "dry", "--view", "finished"));
  press("l");
  press("right");
  press("v");
  EXPECT_THAT(tuning_.arguments(), ElementsAre("--style", "brush", "--look", "wet", "--set",
                                               "size=21", "--view", "camera"));
}

TEST(TuningOfAConfiguration, RepeatsWhatTheConfigurationGave) {
  LiveTuning tuning({brushStyle(
      {.style = brush().defaults().with("water", "0.7", "site.toml:3"), .view = {}}, {})});
  EXPECT_THAT(tuning.arguments(),
              testing::ElementsAre("--style", "brush", "--set", "water=0.7", "--view", "finished"));
  tuning.press({.name = "tab"});
  tuning.press({.name = "backspace"});
  EXPECT_THAT(tuning.arguments(), testing::Contains("water=0.5")) << "or the file's would count";
}

TEST_F(Tuning, GivesItsValuesAsALookFile) {
  press("l");
  press("right");
  const std::string file = tuning_.lookFile();
  EXPECT_THAT(file, HasSubstr("[painting]\nstyle = \"brush\"\n"));
  EXPECT_THAT(file, HasSubstr("[style.brush]\n"));
  EXPECT_THAT(file, HasSubstr("\nsize = 21  # a key\n"));
  EXPECT_THAT(file, HasSubstr("\nwater = 0.9  # look wet\n"));
  EXPECT_THAT(file, testing::Not(HasSubstr("paper = ")));
}

TEST_F(Tuning, ChoosesParametersRoundAndRoundButThoseThatAreNotLive) {
  for (const std::string next : {"water", "paper", "size", "water"}) {
    EXPECT_EQ(press("tab"), Request::kNone);
    EXPECT_EQ(chosen(), next);
  }
  for (const std::string before : {"size", "paper", "water"}) {
    EXPECT_EQ(shiftPress("tab"), Request::kNone);
    EXPECT_EQ(chosen(), before);
  }
  press("down");
  EXPECT_EQ(chosen(), "paper");
  press("up");
  EXPECT_EQ(chosen(), "water");
}

TEST_F(Tuning, ChangesTheChosenOneWithinItsRange) {
  EXPECT_EQ(press("right"), Request::kNone);
  EXPECT_EQ(values().size, 9);
  EXPECT_EQ(shiftPress("right"), Request::kNone);
  EXPECT_EQ(values().size, 19);
  press("left");
  EXPECT_EQ(values().size, 18);
  for (int i = 0; i < 9; ++i) shiftPress("left");
  EXPECT_EQ(values().size, 4);
  EXPECT_EQ(press("left"), Request::kNone);
  EXPECT_EQ(values().size, 4);
  EXPECT_EQ(values().water, 0.5) << "the others stay";
  press("tab");
  shiftPress("right");
  EXPECT_EQ(values().water, 0.6);
  press("tab");
  press("right");
  EXPECT_FALSE(values().paper);
  EXPECT_EQ(tuning_.parameters().style.origin("paper"), "a key");
}

TEST_F(Tuning, MakesNewSnapshotsAndLeavesThoseInUseAlone) {
  const PaintParameters inUse = tuning_.parameters();
  press("right");
  EXPECT_EQ(brush().typed(inUse.style).size, 8);
  EXPECT_EQ(values().size, 9);
}

TEST_F(Tuning, ResetsTheChosenOneOnly) {
  press("right");
  press("tab");
  press("right");
  EXPECT_EQ(press("backspace"), Request::kNone);
  EXPECT_EQ(values().water, 0.5);
  EXPECT_EQ(values().size, 9);
  press("l");
  press("right");
  EXPECT_EQ(values().water, 0.91);
  press("backspace");
  EXPECT_EQ(values().water, 0.9) << "as the look has it";
}

TEST_F(Tuning, CyclesViewsFromTheFinishedPictureAndBackToIt) {
  for (const std::string view : {"camera", "cells", "", "camera"}) {
    EXPECT_EQ(press("v"), Request::kNone);
    EXPECT_EQ(tuning_.parameters().view, view);
  }
  for (const std::string view : {"", "cells", "camera"}) {
    EXPECT_EQ(shiftPress("v"), Request::kNone);
    EXPECT_EQ(tuning_.parameters().view, view);
  }
  EXPECT_EQ(tuning_.state(), "brush · dry · view camera");
}

TEST_F(Tuning, PutsLooksOn) {
  EXPECT_EQ(press("l"), Request::kNone);
  EXPECT_EQ(values().water, 0.9);
  EXPECT_EQ(values().size, 20);
  EXPECT_EQ(tuning_.state(), "brush · wet");
  press("right");
  EXPECT_EQ(tuning_.state(), "brush · wet, changed");
  press("left");
  EXPECT_EQ(tuning_.state(), "brush · wet");
  press("l");
  EXPECT_EQ(values().size, 8);
  EXPECT_EQ(tuning_.state(), "brush · dry");
  shiftPress("l");
  EXPECT_EQ(tuning_.state(), "brush · wet");
}

TEST_F(Tuning, KeepsTheViewUnderAnotherLook) {
  press("v");
  press("l");
  EXPECT_EQ(tuning_.parameters().view, "camera");
}

TEST_F(Tuning, PausesAndHelpsAndGoesOn) {
  EXPECT_EQ(press("space"), Request::kNone);
  EXPECT_TRUE(tuning_.isPaused());
  EXPECT_THAT(tuning_.state(), HasSubstr(" · paused"));
  EXPECT_EQ(press("space"), Request::kNone);
  EXPECT_FALSE(tuning_.isPaused());
  for (const std::string key : {"h", "?", "f1"}) {
    EXPECT_EQ(press(key), Request::kNone);
    EXPECT_TRUE(tuning_.showsHelp());
    EXPECT_EQ(press(key), Request::kNone);
    EXPECT_FALSE(tuning_.showsHelp());
  }
}

TEST_F(Tuning, WishesWhatOthersDo) {
  EXPECT_EQ(press("s"), Request::kSnapshot);
  EXPECT_EQ(press("f"), Request::kFullScreen);
  EXPECT_EQ(press("q"), Request::kQuit);
  EXPECT_EQ(press("escape"), Request::kQuit);
  EXPECT_EQ(tuning_.parameters().style, brush().defaults());
}

TEST_F(Tuning, KnowsNoOtherKey) {
  for (const std::string key : {"a", "1", "return", "f2", "pagedown", "", "S"}) {
    EXPECT_EQ(press(key), Request::kUnknownKey) << key;
  }
  EXPECT_EQ(tuning_.parameters().style, brush().defaults());
  EXPECT_EQ(tuning_.state(), "brush · dry");
}

TEST_F(Tuning, RepeatsOnlyWhatCanBeHeld) {
  for (int i = 0; i < 5; ++i) press("right", false, true);
  EXPECT_EQ(values().size, 13);
  press("tab", false, true);
  EXPECT_EQ(chosen(), "water");
  for (const std::string key : {"space", "f", "s", "h", "v", "l", "q", "escape", "backspace"}) {
    EXPECT_EQ(press(key, false, true), Request::kUnknownKey) << key;
  }
  EXPECT_FALSE(tuning_.isPaused());
  EXPECT_EQ(tuning_.state(), "brush · dry, changed");
}

TEST_F(Tuning, HelpNamesEveryKey) {
  for (const std::string key : {"Tab", "Down", "Left", "Right", "Shift", "Backspace", "l", "t", "v",
                                "Space", "s", "f", "h", "?", "q", "Escape"}) {
    EXPECT_THAT(tuning_.help(), HasSubstr(key));
  }
}

TEST_F(Tuning, HelpNamesTheKeysOfAProcedureFirst) {
  tuning_.setKeyFilter([](const hal::KeyPressed& key) { return key.name == "pagedown"; },
                       "Page Down\tends the step");
  EXPECT_THAT(tuning_.help(), testing::StartsWith("Page Down\tends the step\nTab, Down\t"));
  EXPECT_EQ(press("pagedown"), Request::kNone);
}

/// Brush and pen, with a view and values of their own.
std::vector<LiveStyle> twoStyles() {
  return {brushStyle({.style = brush().defaults(), .view = {}}),
          {.name = "pen",
           .start = {.style = brush().defaults().with("size", "5", "site.toml:2"), .view = {}},
           .views = {{"camera", ""}, {"lines", ""}},
           .looks = {}}};
}

TEST(TuningOfStyles, GoesRoundTheStylesWhichKeepWhatWasTuned) {
  LiveTuning tuning(twoStyles());
  tuning.press({.name = "right"});
  EXPECT_EQ(tuning.press({.name = "t"}), Request::kNone);
  EXPECT_EQ(tuning.styleName(), "pen");
  EXPECT_EQ(tuning.state(), "pen");
  EXPECT_EQ(brush().typed(tuning.parameters().style).size, 5) << "as it is configured";
  EXPECT_THAT(tuning.arguments(),
              testing::ElementsAre("--style", "pen", "--set", "size=5", "--view", "finished"));
  EXPECT_THAT(tuning.lookFile(), HasSubstr("style = \"pen\""));
  tuning.press({.name = "t", .shift = true});
  EXPECT_EQ(tuning.styleName(), "brush");
  EXPECT_EQ(brush().typed(tuning.parameters().style).size, 9) << "as it was left";
  tuning.press({.name = "t"});
  tuning.press({.name = "t"});
  EXPECT_EQ(tuning.styleName(), "brush") << "round and round";
}

TEST(TuningOfStyles, KeepsTheViewWhereTheNextStyleHasIt) {
  LiveTuning tuning(twoStyles(), 1);
  tuning.press({.name = "v"});
  tuning.press({.name = "t"});
  EXPECT_EQ(tuning.parameters().view, "camera");
  tuning.press({.name = "v"});
  EXPECT_EQ(tuning.parameters().view, "cells");
  tuning.press({.name = "t"});
  EXPECT_EQ(tuning.parameters().view, "") << "a pen has no cells";
}

TEST(TuningOfStyles, GoesBackToTheStyleOfTheConfiguration) {
  LiveTuning tuning(twoStyles());
  tuning.press({.name = "t"});
  tuning.setParameters("brush", {.style = brush().defaults(), .view = {}});
  EXPECT_EQ(tuning.state(), "brush · dry");
}

TEST(TuningStart, WearsNoLookWhereValuesWereSet) {
  LiveTuning tuning(
      {brushStyle({.style = brush().defaults().with("size", "10", "--set"), .view = {}})});
  EXPECT_EQ(tuning.state(), "brush");
  tuning.press({.name = "backspace"});
  EXPECT_EQ(brush().typed(tuning.parameters().style).size, 8) << "the style's default";
  tuning.press({.name = "l"});
  EXPECT_EQ(tuning.state(), "brush · dry") << "the first look";
}

TEST(TuningStart, GoesBackToTheLastLookFirst) {
  LiveTuning tuning(
      {brushStyle({.style = brush().defaults().with("size", "10", "--set"), .view = {}})});
  tuning.press({.name = "l", .shift = true});
  EXPECT_EQ(tuning.state(), "brush · wet");
}

TEST(TuningStart, KeepsTheViewThatWasAskedFor) {
  LiveTuning tuning({brushStyle({.style = brush().defaults(), .view = "cells"})});
  EXPECT_EQ(tuning.parameters().view, "cells");
  tuning.press({.name = "v"});
  EXPECT_EQ(tuning.parameters().view, "");
}

TEST(TuningStart, DoesWithoutLooksAndParameters) {
  const auto none =
      std::make_shared<const config::ParameterList>(std::vector<config::ParameterDescriptor>{});
  const config::ParameterValues nothing(none);
  LiveTuning tuning(
      {{.name = "none", .start = {.style = nothing, .view = {}}, .views = {}, .looks = {}}});
  EXPECT_EQ(tuning.parameterLine(), "none has nothing to tune");
  for (const std::string key : {"tab", "up", "left", "right", "backspace", "l", "v"}) {
    EXPECT_EQ(tuning.press({.name = key}), Request::kNone) << key;
    EXPECT_EQ(tuning.press({.name = key, .shift = true}), Request::kNone) << key;
  }
  EXPECT_EQ(tuning.state(), "none");
  EXPECT_EQ(tuning.parameters().view, "");
}

}  // namespace
}  // namespace pleinair::app
