// What the record gets, and when a step is left, of a procedure that is stepped through.
#include <cerrno>
#include <string_view>

#include <gmock/gmock.h>

#include "pipeline/record/record_check.h"
#include "tests/unit/firmware_app/repair_station/gated_disk.h"
#include "tests/unit/firmware_app/repair_station/live_procedure_fixture.h"

namespace pleinair::app {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST_F(LiveProcedureTest, AStepIsLeftOnceItsLineIsOnTheDisk) {
  GatedDisk disk;
  LiveProcedure live = begin(true, disk.system());
  disk.shut();
  EXPECT_TRUE(live.press({.name = "pagedown"}));
  disk.awaitWaiting();
  live.poll();
  EXPECT_EQ(live.status().step, "open") << "its line is not on the disk yet";
  EXPECT_THAT(live.text(), HasSubstr("1/4  Open it"));
  EXPECT_TRUE(live.press({.name = "pagedown"}));
  EXPECT_THAT(live.takeNotice().value_or(""), HasSubstr("being written"));
  disk.open();
  live.finish();
  EXPECT_EQ(live.status().step, "look") << "the second press did not count";
}

TEST_F(LiveProcedureTest, TheEndDoesNotWaitForADiskThatHangs) {
  GatedDisk disk;
  LiveProcedure live = begin(true, disk.system());
  disk.shut();
  EXPECT_TRUE(live.press({.name = "pagedown"}));
  disk.awaitWaiting();
  edit("max = 3");
  live.poll();
  EXPECT_EQ(live.end(std::chrono::milliseconds(1)), LiveProcedure::RecordEnd::kIsWriting);
  disk.open();
  EXPECT_EQ(live.end(std::chrono::hours(1)), LiveProcedure::RecordEnd::kWritten);
  EXPECT_EQ(live.status().step, "look");
  EXPECT_FALSE(live.takeNotice()) << "nothing is read again at the end";
}

TEST_F(LiveProcedureTest, AnAnswerToAVersionThatIsNoLongerInForceIsRefused) {
  LiveProcedure live = begin();
  press(live, "pagedown y");
  edit("max = 3");
  live.poll();  // reads it again, on the record's thread
  for (const char* key : {"2", ".", "5", "return"}) EXPECT_TRUE(live.press({.name = key}));
  live.finish();
  EXPECT_EQ(live.status().step, "gap");
  EXPECT_THAT(live.takeNotice().value_or(""), HasSubstr("was read again"));
  EXPECT_THAT(live.takeNotice().value_or(""), HasSubstr("was edited meanwhile"));
  EXPECT_THAT(live.text(), HasSubstr("Gap: _ (≤ 3 mm)"));
  EXPECT_TRUE(std::holds_alternative<record::ProcedureChanged>(
      record::checkRecordFile(live.status().record)->entries.back().event));
  press(live, "2 . 5 return");
  EXPECT_EQ(live.status().step, "shoot");
}

TEST_F(LiveProcedureTest, ThePhotoOfAVersionThatIsNoLongerInForceIsNoAnswer) {
  LiveProcedure live = begin();
  press(live, "pagedown y 1 return pagedown");
  ASSERT_TRUE(live.takeStillRequest());
  edit("max = 3");
  live.poll();
  live.finish();
  live.putStill(picture());
  live.finish();
  EXPECT_EQ(live.status().step, "shoot");
  EXPECT_THAT(live.takeNotice().value_or(""), HasSubstr("was read again"));
  EXPECT_THAT(live.takeNotice().value_or(""), HasSubstr("was edited meanwhile"));
  press(live, "pagedown");
  live.putStill(picture());
  live.finish();
  EXPECT_EQ(live.status().step, "end");
}

TEST_F(LiveProcedureTest, OperatorsWhoComeTogetherAreAllInTheRecord) {
  LiveProcedure live = begin();
  for (const char* name : {"Kim", "Jo", "Jo"}) {
    EXPECT_TRUE(live.obey({.kind = procedure::StepCommandKind::kOperator, .operatorName = name},
                          "a program"));
  }
  live.finish();
  EXPECT_EQ(live.takeNotice(), "now works: Kim");
  EXPECT_EQ(live.takeNotice(), "now works: Jo");
  EXPECT_EQ(live.takeNotice(), "Jo works already");
  pressAbort(live);
  live.finish();
  const auto reading = record::checkRecordFile(live.status().record);
  EXPECT_EQ(std::get<record::SignedOff>(reading->entries.back().event).operatorName, "Jo");
}

TEST_F(LiveProcedureTest, WhatIsNotRecordedIsSaidAsWhatItIsAndStaysSaid) {
  const auto system = record::RecordSystem::real();
  bool isFull = false;
  LiveProcedure live({.folder = procedure(),
                      .records = records(),
                      .operatorName = "Jo",
                      .program = "1",
                      .system = {.write =
                                     [&](int fd, std::string_view bytes) {
                                       return isFull ? ssize_t{-ENOSPC} : system.write(fd, bytes);
                                     },
                                 .sync = system.sync,
                                 .truncate = system.truncate}},
                     clock_);
  isFull = true;
  EXPECT_TRUE(
      live.obey({.kind = procedure::StepCommandKind::kOperator, .operatorName = "Kim"}, "a card"));
  EXPECT_TRUE(live.press({.name = "pagedown"}));
  EXPECT_TRUE(live.press({.name = "pagedown"}));
  live.finish();
  EXPECT_THAT(live.takeFailure().value_or(""), StartsWith("not recorded: "));
  EXPECT_THAT(live.takeFailure().value_or(""),
              StartsWith("the disk is full: the step is not done"));
  EXPECT_FALSE(live.takeFailure());
  EXPECT_THAT(live.takeNotice().value_or(""), HasSubstr("being written")) << "it hides no failure";
  pressAbort(live);
  live.finish();
  EXPECT_THAT(live.takeFailure().value_or(""), StartsWith("not recorded: "));
  isFull = false;
  press(live, "pagedown");
  EXPECT_EQ(live.status().step, "look");
}

}  // namespace
}  // namespace pleinair::app
