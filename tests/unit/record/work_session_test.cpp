#include "pipeline/record/work_session.h"

#include <gmock/gmock.h>

#include "tests/unit/record/session_fixture.h"

namespace pleinair::record {
namespace {

using procedure::Done;
using procedure::MeasuredValue;
using procedure::YesNo;
using testing::HasSubstr;

using WorkSessionTest = SessionFixture;

TEST_F(WorkSessionTest, RecordsWhatWasDone) {
  auto session = begin();
  ASSERT_TRUE(session);
  work(*session);
  const std::vector<RecordEntry>& entries = session->record().entries();
  const auto& begun = std::get<Begun>(entries.front().event);
  EXPECT_EQ(begun.procedure, "p");
  EXPECT_EQ(begun.hash, std::string(64, 'a'));
  EXPECT_EQ(begun.step, "a");
  const auto& failed = std::get<StepDone>(entries[5].event);
  EXPECT_EQ(failed.outcome, procedure::Outcome::kHigh);
  EXPECT_EQ(failed.value, 2.5);
  EXPECT_EQ(failed.next, "c") << "it keeps the step";
  EXPECT_GT(failed.took.count(), 0);
  const auto& signedOff = std::get<SignedOff>(entries.back().event);
  EXPECT_EQ(signedOff.result, SignOff::kCompleted);
  EXPECT_EQ(signedOff.operatorName, "K. Öz");
  EXPECT_TRUE(checkRecordFile(path())->findings.empty());
}

TEST_F(WorkSessionTest, AnAnswerOfAnotherKindIsRefusedAndNotRecorded) {
  auto session = begin();
  const std::string before = contentOf(path());
  EXPECT_EQ(session->answer(YesNo{true}).value(), Advance::kRefused);
  EXPECT_EQ(contentOf(path()), before);
  EXPECT_EQ(session->stepper().step().id, "a");
  EXPECT_EQ(session->back().value(), Advance::kStayed) << "at the first step";
}

TEST_F(WorkSessionTest, IsAbortedBeforeTheEnd) {
  {
    auto session = begin();
    ASSERT_TRUE(session->signOff("no spare part"));
    EXPECT_EQ(std::get<SignedOff>(session->record().entries().back().event).result,
              SignOff::kAborted);
  }
  EXPECT_THAT(resume().error().problem, HasSubstr("is signed off"));
}

TEST_F(WorkSessionTest, GoesOnAfterAStepBackAndADetour) {
  {
    auto session = begin();
    ASSERT_TRUE(session->answer(Done{}));
    ASSERT_TRUE(session->answer(YesNo{false}));
    ASSERT_TRUE(session->answer(Done{}));
    ASSERT_TRUE(session->answer(YesNo{true}));
    ASSERT_TRUE(session->answer(MeasuredValue{9.0}));
    ASSERT_EQ(session->back().value(), Advance::kMoved);
    ASSERT_TRUE(session->changeOperator("Second"));
  }
  auto session = resume();
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(session->stepper().step().id, "b");
  EXPECT_EQ(session->stepper().past().size(), 3U);
  EXPECT_EQ(session->stepper().partsOff().size(), 1U) << "the cover";
  ASSERT_TRUE(session->signOff());
  EXPECT_EQ(std::get<SignedOff>(session->record().entries().back().event).operatorName, "Second");
}

TEST_F(WorkSessionTest, AnEditedProcedureIsTakenWhereTheWayIsStillPossible) {
  auto session = begin();
  ASSERT_TRUE(session->answer(Done{}));
  auto edited = std::make_shared<procedure::Procedure>(*procedureOf());
  edited->version = "2";
  edited->hash = std::string(64, 'b');
  edited->steps[2].check->max = 3.0;
  ASSERT_TRUE(session->changeProcedure(edited));
  ASSERT_TRUE(session->answer(YesNo{true}));
  EXPECT_EQ(session->answer(MeasuredValue{2.5}).value(), Advance::kMoved) << "the new limit";
  auto shorter = std::make_shared<procedure::Procedure>(*edited);
  shorter->steps[0].next = {{procedure::Outcome::kDone, 2}};
  const auto refused = session->changeProcedure(shorter);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().problem, HasSubstr("the way so far is not possible any more"));
  EXPECT_EQ(session->stepper().procedure().version, "2") << "the version before stays in force";
}

TEST_F(WorkSessionTest, GoesOnAfterAnAnswerThatKeptItsStepAndLeadsElsewhereNow) {
  {
    auto session = begin();
    ASSERT_TRUE(session->answer(Done{}));
    ASSERT_TRUE(session->answer(YesNo{true}));
    ASSERT_EQ(session->answer(MeasuredValue{9.0}).value(), Advance::kStayed);
  }
  auto edited = std::make_shared<procedure::Procedure>(*procedureOf());
  edited->hash = std::string(64, 'b');
  edited->steps[2].next[procedure::Outcome::kHigh] = 0;
  const auto session = WorkSession::resume(edited, path(), "1", clock());
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(session->stepper().step().id, "c");
}

TEST_F(WorkSessionTest, GoesOnWithoutAStillThatWasDeletedAndSaysSoInTheEnd) {
  {
    auto session = begin();
    ASSERT_TRUE(session->addStill("before", std::vector<std::uint8_t>{1, 2, 3}));
    ASSERT_TRUE(session->answer(Done{}));
  }
  std::filesystem::remove_all(folder_.path() / "work.stills");
  auto session = resume();
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(session->stepper().step().id, "b");
  ASSERT_TRUE(session->signOff());
  EXPECT_EQ(checkRecordFile(path())->findings.size(), 1U);
}

TEST_F(WorkSessionTest, IsOfOneProgramAtATime) {
  const auto session = begin();
  EXPECT_EQ(resume().error().kind, hal::ErrorKind::kBusy);
}

TEST_F(WorkSessionTest, AResumptionWithAnotherProcedureIsRefusedOrNoted) {
  { ASSERT_TRUE(begin()->answer(Done{})); }
  auto other = std::make_shared<procedure::Procedure>(*procedureOf());
  other->name = "other";
  EXPECT_THAT(WorkSession::resume(other, path(), "1", clock()).error().problem,
              HasSubstr("is of the procedure \"p\""));
  auto edited = std::make_shared<procedure::Procedure>(*procedureOf());
  edited->hash = std::string(64, 'c');
  auto session = WorkSession::resume(edited, path(), "1", clock());
  ASSERT_TRUE(session);
  EXPECT_EQ(std::get<ProcedureChanged>(session->record().entries().back().event).hash,
            edited->hash);
}

}  // namespace
}  // namespace pleinair::record
