// What the record gets, and when a step is left, of a procedure that is stepped through.
#include <gmock/gmock.h>

#include "pipeline/record/record_check.h"
#include "tests/unit/firmware_app/repair_station/live_procedure_fixture.h"

namespace pleinair::app {
namespace {

using testing::HasSubstr;

TEST_F(LiveProcedureTest, AnAnswerToAVersionThatIsNoLongerInForceIsRefused) {
  LiveProcedure live = begin();
  press(live, "pagedown y");
  edit("max = 3");
  live.poll();  // reads it again, on the record's thread
  for (const char* key : {"2", ".", "5", "return"}) EXPECT_TRUE(live.press({.name = key}));
  live.finish();
  EXPECT_EQ(live.status().step, "gap");
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
  EXPECT_THAT(live.takeNotice().value_or(""), HasSubstr("was edited meanwhile"));
  press(live, "pagedown");
  live.putStill(picture());
  live.finish();
  EXPECT_EQ(live.status().step, "end");
}

}  // namespace
}  // namespace pleinair::app
