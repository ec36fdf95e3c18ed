#include "pipeline/procedure/stepper.h"

#include <limits>

#include <gmock/gmock.h>

#include "tests/unit/procedure/procedure_texts.h"

namespace pleinair::procedure {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::shared_ptr<const Procedure> procedureOf(const std::string& steps,
                                             const std::vector<std::string>& ids) {
  return std::make_shared<const Procedure>(readSteps(steps, ids).procedure);
}

std::shared_ptr<const Procedure> branching() {
  return procedureOf(
      "[[step]]\nid = \"open\"\nremoves = [\"cover\", \"plug\"]\n"
      "[[step]]\nid = \"look\"\ncheck = \"yes_no\"\ngoto = { no = \"mend\" }\n"
      "[[step]]\nid = \"gap\"\ncheck = { kind = \"value\", unit = \"mm\", min = 1, max = 2 }\n"
      "goto = { high = \"end\" }\n"
      "[[step]]\nid = \"close\"\nfits = [\"cover\"]\nnext = \"end\"\n"
      "[[step]]\nid = \"mend\"\nnext = \"look\"\n",
      {"open", "look", "gap", "close", "mend"});
}

TEST(Stepper, FollowsBranchesAndKnowsWhatIsOff) {
  Stepper stepper(branching());
  EXPECT_THAT(stepper.partsOff(), IsEmpty());
  EXPECT_TRUE(stepper.advance(Outcome::kDone));
  EXPECT_THAT(stepper.partsOff(), ElementsAre(0, 1));
  EXPECT_TRUE(stepper.advance(Outcome::kNo));
  EXPECT_EQ(stepper.step().id, "mend");
  EXPECT_TRUE(stepper.advance(Outcome::kDone));
  EXPECT_TRUE(stepper.advance(Outcome::kYes));
  EXPECT_FALSE(stepper.advance(Outcome::kLow)) << "an outcome without goto keeps the step";
  EXPECT_EQ(stepper.step().id, "gap");
  EXPECT_TRUE(stepper.advance(Outcome::kOk));
  EXPECT_TRUE(stepper.advance(Outcome::kDone));
  EXPECT_TRUE(stepper.isFinished());
  EXPECT_THAT(stepper.partsOff(), ElementsAre(0)) << "the plug was forgotten";
  EXPECT_EQ(stepName(stepper.procedure(), stepper.current()), "end");
}

TEST(Stepper, GoesBackTheWayThatWasTaken) {
  Stepper stepper(branching());
  EXPECT_FALSE(stepper.back());
  stepper.advance(Outcome::kDone);
  stepper.advance(Outcome::kNo);
  stepper.advance(Outcome::kDone);
  EXPECT_EQ(stepper.step().id, "look");
  EXPECT_TRUE(stepper.back());
  EXPECT_EQ(stepper.step().id, "mend") << "not the step before it in the file";
  EXPECT_TRUE(stepper.back());
  EXPECT_TRUE(stepper.back());
  EXPECT_EQ(stepper.step().id, "open");
  EXPECT_THAT(stepper.partsOff(), IsEmpty());
}

TEST(Stepper, GoesBackFromTheEnd) {
  Stepper stepper(branching());
  for (const Outcome each : {Outcome::kDone, Outcome::kYes, Outcome::kHigh}) stepper.advance(each);
  ASSERT_TRUE(stepper.isFinished());
  EXPECT_TRUE(stepper.back());
  EXPECT_EQ(stepper.step().id, "gap");
}

TEST(Stepper, AnswersHaveTheKindOfTheCheck) {
  const auto procedure = branching();
  const Step& open = procedure->steps[0];
  const Step& look = procedure->steps[1];
  const Step& gap = procedure->steps[2];
  EXPECT_EQ(outcomeOf(open, Done{}), Outcome::kDone);
  EXPECT_EQ(outcomeOf(open, YesNo{true}), std::nullopt);
  EXPECT_EQ(outcomeOf(look, Done{}), std::nullopt) << "a check is not passed by going on";
  EXPECT_EQ(outcomeOf(look, YesNo{false}), Outcome::kNo);
  EXPECT_EQ(outcomeOf(gap, MeasuredValue{0.999}), Outcome::kLow);
  EXPECT_EQ(outcomeOf(gap, MeasuredValue{1.0}), Outcome::kOk) << "limits are within";
  EXPECT_EQ(outcomeOf(gap, MeasuredValue{2.0}), Outcome::kOk);
  EXPECT_EQ(outcomeOf(gap, MeasuredValue{2.001}), Outcome::kHigh);
  EXPECT_EQ(outcomeOf(gap, MeasuredValue{std::numeric_limits<double>::quiet_NaN()}), std::nullopt);
  EXPECT_EQ(outcomeOf(gap, PhotoTaken{}), std::nullopt);
  Step compare = look;
  compare.check->kind = CheckKind::kCompare;
  EXPECT_EQ(outcomeOf(compare, Comparison::kUncertain), Outcome::kUncertain);
  EXPECT_EQ(outcomeOf(compare, YesNo{true}), std::nullopt);
}

TEST(Stepper, MovesToAnotherVersionByIds) {
  Stepper stepper(branching());
  stepper.advance(Outcome::kDone);
  stepper.advance(Outcome::kYes);
  const auto reordered = procedureOf(
      "[[step]]\nid = \"open\"\nremoves = [\"cover\"]\nnext = \"look\"\n"
      "[[step]]\nid = \"gap\"\ncheck = { kind = \"value\", unit = \"mm\", min = 1 }\nnext = "
      "\"end\"\n"
      "[[step]]\nid = \"look\"\ncheck = \"yes_no\"\nnext = \"gap\"\n",
      {"open", "look", "gap"});
  const auto moved = stepper.movedTo(reordered);
  ASSERT_TRUE(moved) << moved.error().message();
  EXPECT_EQ(moved->current(), 1U);
  EXPECT_EQ(moved->step().id, "gap");
  EXPECT_THAT(moved->partsOff(), ElementsAre(1));
  const auto without =
      procedureOf("[[step]]\nid = \"open\"\n[[step]]\nid = \"gap\"\n", {"open", "gap"});
  EXPECT_EQ(stepper.movedTo(without).error().kind, hal::ErrorKind::kInvalidInput);
}

}  // namespace
}  // namespace pleinair::procedure
