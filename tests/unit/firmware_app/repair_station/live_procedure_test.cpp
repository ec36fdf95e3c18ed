#include <algorithm>
#include <functional>

#include <gmock/gmock.h>

#include "config/config_error.h"
#include "pipeline/record/record_check.h"
#include "tests/support/file_size_limit.h"
#include "tests/unit/firmware_app/repair_station/live_procedure_fixture.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;

using testing::HasSubstr;

TEST_F(LiveProcedureTest, KeysStepThroughItToTheSignOff) {
  LiveProcedure live = begin();
  EXPECT_THAT(live.text(),
              HasSubstr("1/4  Open it\nLift the cover.\nTorque: 5 Nm\nPage Down: done"));
  press(live, "pagedown");
  EXPECT_EQ(live.status().step, "look");
  EXPECT_EQ(live.status().number, 2U);
  press(live, "y 1 . 5 return");
  EXPECT_EQ(live.status().step, "shoot");
  EXPECT_FALSE(live.takeStillRequest());
  press(live, "pagedown");
  EXPECT_TRUE(live.takeStillRequest());
  EXPECT_FALSE(live.takeStillRequest()) << "once";
  EXPECT_EQ(live.status().step, "shoot") << "until the still is saved";
  live.putStill(picture());
  live.finish();
  EXPECT_EQ(live.status().step, "end");
  EXPECT_THAT(live.text(), HasSubstr("Enter: sign off"));
  press(live, "return");
  EXPECT_TRUE(live.status().isSignedOff);
  EXPECT_THAT(live.takeNotice().value_or(""), HasSubstr("signed off; final hash "));
  EXPECT_TRUE(record::checkRecordFile(live.status().record)->findings.empty());
  EXPECT_FALSE(live.press({.name = "pageup"})) << "it is over";
}

TEST_F(LiveProcedureTest, APedalAnswersNoQuestion) {
  LiveProcedure live = begin();
  press(live, "pagedown pagedown");
  EXPECT_EQ(live.status().step, "look");
  EXPECT_THAT(live.takeNotice().value_or(""), HasSubstr("y or n"));
  EXPECT_TRUE(live.press({.name = "pagedown", .isRepeat = true})) << "a pedal that is held";
  press(live, "n");
  EXPECT_EQ(live.status().step, "look");
  EXPECT_THAT(live.takeNotice().value_or(""), HasSubstr("do this step again"));
  press(live, "pageup");
  EXPECT_EQ(live.status().step, "open");
  EXPECT_TRUE(live.press({.name = "pagedown", .isRepeat = true}));
  EXPECT_EQ(live.status().step, "open");
  EXPECT_FALSE(live.press({.name = "l"})) << "a key of the painting";
  EXPECT_FALSE(live.press({.name = "y"})) << "there is no question here";
}

TEST_F(LiveProcedureTest, ValuesAreTypedAndMended) {
  LiveProcedure live = begin();
  press(live, "pagedown y return");
  EXPECT_THAT(live.takeNotice().value_or(""), HasSubstr("type a value in mm"));
  press(live, "9 , 5 backspace");
  EXPECT_THAT(live.text(), HasSubstr("Gap: 9._ (≤ 2 mm)"));
  press(live, "return");
  EXPECT_EQ(live.status().step, "gap") << "9 is too high";
  EXPECT_FALSE(live.press({.name = "backspace"})) << "nothing is typed: the painting's key";
}

TEST_F(LiveProcedureTest, GoesOnWithTheRecordThatIsNotSignedOff) {
  std::string record;
  {
    LiveProcedure live = begin();
    press(live, "pagedown y");
    record = live.status().record;
  }
  {
    LiveProcedure live = begin();
    EXPECT_EQ(live.status().record, record);
    EXPECT_EQ(live.status().step, "gap");
    pressAbort(live);
    live.finish();
  }
  LiveProcedure live = begin();
  EXPECT_NE(live.status().record, record) << "that one was signed off";
  EXPECT_EQ(live.status().step, "open");
}

TEST_F(LiveProcedureTest, IsReadAgainWhenItIsSaved) {
  LiveProcedure live = begin(false);
  press(live, "pagedown");
  const auto save = [&](const std::string& limit) {
    edit(limit);
    live.poll();
    live.finish();
    const auto failure = live.takeFailure();
    return failure ? *failure : live.takeNotice().value_or("");
  };
  EXPECT_EQ(save("max = 3"), "the procedure was read again");
  EXPECT_EQ(live.status().step, "look");
  EXPECT_THAT(save("max = \"three\""), HasSubstr("procedure.toml:7: step[2].check.max: found"));
  press(live, "y");
  EXPECT_THAT(live.text(), HasSubstr("≤ 3 mm")) << "the last version without mistakes";
}

TEST_F(LiveProcedureTest, StillsOfStepsAreTakenBeforeAndAfterEach) {
  LiveProcedure live({.folder = procedure(),
                      .records = records(),
                      .operatorName = "Jo",
                      .program = "1",
                      .stillsOfSteps = true},
                     clock_);
  EXPECT_TRUE(live.takeStillRequest());
  press(live, "pagedown");  // before the first still has come
  EXPECT_EQ(live.status().step, "open") << "until its picture is saved";
  press(live, "pagedown");
  EXPECT_THAT(live.takeNotice().value_or(""), HasSubstr("is awaited"));
  live.putStill(picture());
  live.finish();
  EXPECT_TRUE(live.takeStillRequest());
  live.putStill(picture());
  live.finish();
  EXPECT_EQ(live.status().step, "look");
  const auto reading = record::checkRecordFile(live.status().record);
  std::vector<std::string> lines;
  for (const auto& entry : reading->entries) {
    if (const auto* still = std::get_if<record::StillTaken>(&entry.event)) {
      lines.push_back(still->when + " " + still->step);
    }
    if (const auto* done = std::get_if<record::StepDone>(&entry.event)) lines.push_back(done->step);
  }
  EXPECT_THAT(lines, testing::ElementsAre("before open", "after open", "open"));
}

TEST_F(LiveProcedureTest, ACameraThatGivesNoPictureKeepsTheStep) {
  LiveProcedure live = begin();
  press(live, "pagedown y 1 return pagedown");
  EXPECT_TRUE(live.takeStillRequest());
  clock_.advance(std::chrono::seconds(3));
  live.poll();
  EXPECT_THAT(live.takeFailure().value_or(""), HasSubstr("gives no picture"));
  EXPECT_EQ(live.status().step, "shoot");
  live.putStill(picture());  // late
  live.finish();
  EXPECT_EQ(live.status().step, "shoot");
  press(live, "pagedown");
  EXPECT_TRUE(live.takeStillRequest());
  live.putStill(picture());
  live.finish();
  EXPECT_EQ(live.status().step, "end");
}

TEST_F(LiveProcedureTest, AStillOfAStepThatWasLeftIsNoneOfTheNext) {
  LiveProcedure live = begin();
  EXPECT_TRUE(live.obey({.kind = procedure::StepCommandKind::kPhoto}, "pedal"));
  EXPECT_TRUE(live.takeStillRequest());
  press(live, "pagedown");
  EXPECT_EQ(live.status().step, "look");
  live.putStill(picture());  // asked for at the step before
  live.finish();
  const auto reading = record::checkRecordFile(live.status().record);
  for (const auto& entry : reading->entries) {
    EXPECT_FALSE(std::holds_alternative<record::StillTaken>(entry.event));
  }
}

TEST_F(LiveProcedureTest, APoseOfAFrameThatIsLongPastIsNotRecorded) {
  LiveProcedure live = begin();
  const auto sourceOfLast = [&] {
    const auto reading = record::checkRecordFile(live.status().record);
    return std::get<record::StepDone>(reading->entries.back().event).pose->source;
  };
  live.locate(record::PoseQuality{.source = "seen"});
  press(live, "pagedown");
  EXPECT_EQ(sourceOfLast(), "seen");
  clock_.advance(std::chrono::seconds(2));  // the camera is gone
  press(live, "y");
  EXPECT_EQ(sourceOfLast(), "none");
}

TEST_F(LiveProcedureTest, PointsAtNothingOnceItIsSignedOff) {
  LiveProcedure live = begin();
  EXPECT_EQ(live.shown().step, 0U);
  pressAbort(live);
  live.finish();
  EXPECT_EQ(live.shown().step, procedure::kEnd);
  EXPECT_TRUE(live.shown().isAborted);
}

TEST_F(LiveProcedureTest, OnePressAbortsNothing) {
  LiveProcedure live = begin();
  const hal::KeyPressed abort{.name = "x", .shift = true};
  EXPECT_TRUE(live.press(abort));
  EXPECT_THAT(live.takeNotice().value_or(""), HasSubstr("once more within five seconds"));
  EXPECT_TRUE(live.press({.name = "x", .shift = true, .isRepeat = true})) << "a key that is held";
  clock_.advance(std::chrono::seconds(6));
  EXPECT_TRUE(live.press(abort));
  live.finish();
  EXPECT_FALSE(live.status().isSignedOff) << "too late";
  clock_.advance(std::chrono::seconds(4));
  EXPECT_TRUE(live.press(abort));
  live.finish();
  EXPECT_TRUE(live.status().isSignedOff);
  std::string last;
  while (const auto notice = live.takeNotice()) last = *notice;
  EXPECT_THAT(last, HasSubstr("aborted; final hash "));
}

TEST_F(LiveProcedureTest, ADiskThatIsFullAtAStillKeepsTheStepUntilThereIsSpace) {
  LiveProcedure live = begin();
  press(live, "pagedown y 1 return pagedown");
  const std::size_t lines = record::checkRecordFile(live.status().record)->entries.size();
  {
    const support::FileSizeLimit full(512);  // less than the picture needs
    hal::Image noise({.pixelFormat = hal::PixelFormat::kRgb8, .size = {64, 64}});
    for (std::size_t i = 0; i < noise.plane(0).size(); ++i) {
      noise.plane(0)[i] = static_cast<std::uint8_t>(i * i / 7);
    }
    live.putStill(noise);
    live.finish();
    EXPECT_THAT(live.takeFailure().value_or(""), HasSubstr("too large"));
    EXPECT_EQ(live.status().step, "shoot");
  }
  EXPECT_EQ(record::checkRecordFile(live.status().record)->entries.size(), lines);
  press(live, "pagedown");
  live.putStill(picture());
  live.finish();
  EXPECT_EQ(live.status().step, "end");
  press(live, "return");
  EXPECT_TRUE(record::checkRecordFile(live.status().record)->findings.empty());
}

TEST_F(LiveProcedureTest, OperatorsWhoTakeOverAreInTheRecord) {
  {
    LiveProcedure live = begin();
    press(live, "pagedown");
  }
  LiveProcedure live(
      {.folder = procedure(), .records = records(), .operatorName = "Kim", .program = "1"}, clock_);
  clock_.advance(std::chrono::seconds(1));
  EXPECT_TRUE(
      live.obey({.kind = procedure::StepCommandKind::kOperator, .operatorName = "Li"}, "a card"));
  live.finish();
  press(live, "y");
  pressAbort(live);
  live.finish();
  const auto reading = record::checkRecordFile(live.status().record);
  std::vector<std::string> names;
  for (const auto& entry : reading->entries) {
    if (const auto* changed = std::get_if<record::OperatorChanged>(&entry.event)) {
      names.push_back(changed->operatorName);
    }
  }
  EXPECT_THAT(names, testing::ElementsAre("Kim", "Li"));
}

TEST_F(LiveProcedureTest, LinesAreInTheOrderInWhichTheyWereGiven) {
  LiveProcedure live = begin();
  constexpr int kStills = 5;
  for (int i = 0; i < kStills; ++i) {
    EXPECT_TRUE(live.obey({.kind = procedure::StepCommandKind::kPhoto}, "pedal"));
    EXPECT_TRUE(live.takeStillRequest());
    // The first ones take longer to be coded.
    const int side = 512 >> i;
    live.putStill(hal::Image({.pixelFormat = hal::PixelFormat::kRgb8, .size = {side, side}}));
  }
  EXPECT_TRUE(live.press({.name = "pagedown"}));
  live.finish();
  std::vector<std::uint64_t> sizes;
  const auto reading = record::checkRecordFile(live.status().record);
  for (const auto& entry : reading->entries) {
    const auto* still = std::get_if<record::StillTaken>(&entry.event);
    if (still != nullptr) sizes.push_back(still->bytes);
  }
  EXPECT_EQ(sizes.size(), std::size_t{kStills});
  EXPECT_TRUE(std::ranges::is_sorted(sizes, std::ranges::greater()));
  EXPECT_TRUE(std::holds_alternative<record::StepDone>(reading->entries.back().event))
      << "the answer came after the stills";
}

TEST_F(LiveProcedureTest, WhatWasAnsweredIsInTheRecordWhenTheProgramEnds) {
  {
    LiveProcedure live = begin();
    EXPECT_TRUE(live.press({.name = "pagedown"}));
  }
  EXPECT_EQ(begin().status().step, "look");
}

TEST_F(LiveProcedureTest, NoticesAreInTheProceduresLanguage) {
  std::string toml = textOf(procedure() / "procedure.toml");
  toml.replace(toml.find("[\"en\"]"), 6, "[\"de\"]");
  write(procedure() / "procedure.toml", toml);
  fs::rename(procedure() / "en.md", procedure() / "de.md");
  LiveProcedure live = begin();
  press(live, "pagedown pagedown");
  EXPECT_EQ(live.takeNotice(), "dieser Schritt stellt eine Frage: y (ja) oder n (nein)");
  press(live, "n");
  EXPECT_EQ(live.takeNotice(), "nein: diesen Schritt noch einmal");
  pressAbort(live);
  live.finish();
  EXPECT_THAT(live.takeNotice().value_or(""), HasSubstr("noch einmal"));
  EXPECT_THAT(live.takeNotice().value_or(""), HasSubstr("abgebrochen; letzte Prüfsumme "));
}

TEST_F(LiveProcedureTest, SaysWhatIsWrongAtTheStart) {
  write(procedure() / "procedure.toml", "name = 3");
  EXPECT_THROW(begin(), config::ConfigError);
  SetUp();
  EXPECT_THROW(LiveProcedure({.folder = procedure(), .language = "fr"}, clock_), hal::Failure);
}

}  // namespace
}  // namespace pleinair::app
