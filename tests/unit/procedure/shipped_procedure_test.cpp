// The procedure that comes with the program.
#include <algorithm>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>

#include "tests/unit/procedure/procedure_texts.h"

namespace pleinair::procedure {
namespace {

const std::filesystem::path kFolder =
    std::filesystem::path(PLEINAIR_TESTS_DIR).parent_path() / "config/procedures/gearbox";

TEST(ShippedProcedure, IsSoundAndHasTwentySteps) {
  const ProcedureReading reading = readProcedureFolder(kFolder);
  EXPECT_EQ(messagesOf(reading), "");
  EXPECT_EQ(reading.procedure.steps.size(), 20U);
  EXPECT_THAT(reading.procedure.languages, testing::ElementsAre("en", "de"));
  EXPECT_EQ(reading.procedure.files.size(), 3U);
}

TEST(ShippedProcedure, ShowsAPartInEveryStep) {
  const Procedure procedure = loadProcedure(kFolder);
  for (const Step& step : procedure.steps) EXPECT_FALSE(step.parts.empty()) << step.id;
}

/// Energy is isolated before work, and nobody gets past that by "no".
TEST(ShippedProcedure, BeginsByLockingTheDriveOut) {
  const Procedure procedure = loadProcedure(kFolder);
  const Step& first = procedure.steps.front();
  EXPECT_EQ(first.id, "lock_out");
  ASSERT_EQ(first.checkKind(), CheckKind::kYesNo);
  EXPECT_FALSE(first.next.contains(Outcome::kNo)) << "it keeps the step";
  EXPECT_FALSE(first.tools.empty()) << "the lock";
  ASSERT_EQ(first.warnings.size(), 1U);
  EXPECT_EQ(procedure.warnings[first.warnings.front()].level, WarningLevel::kDanger);
}

TEST(ShippedProcedure, FitsInLessThan150Lines) {
  std::ptrdiff_t lines = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
    std::ifstream file(entry.path());
    lines +=
        std::count(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>(), '\n');
  }
  EXPECT_LT(lines, 150);
}

}  // namespace
}  // namespace pleinair::procedure
