#include "firmware_app/repair_station/step_worker.h"

#include <stdexcept>

#include <gmock/gmock.h>

#include "pipeline/procedure/procedure_file.h"
#include "tests/unit/firmware_app/repair_station/live_procedure_fixture.h"

namespace pleinair::app {
namespace {

class StepWorkerTest : public LiveProcedureTest {};

TEST_F(StepWorkerTest, AJobThatThrowsIsSaidAndTheNextOneIsDone) {
  auto loaded = std::make_shared<const procedure::Procedure>(procedure::loadProcedure(procedure()));
  StepWorker worker(StepSession::open(std::move(loaded), {}).value());
  std::string problem;
  const auto failed = [&](const std::string& text) { problem = text; };
  worker.give([](StepSession&) -> StepWorker::Then { throw std::runtime_error("no memory"); },
              failed);
  bool isDone = false;
  worker.give(
      [&](StepSession& session) -> StepWorker::Then {
        EXPECT_TRUE(session.answer(procedure::Done{}, {}, {}));
        return [&] { isDone = true; };
      },
      failed);
  worker.finish();
  EXPECT_EQ(problem, "no memory");
  EXPECT_TRUE(isDone);
  EXPECT_EQ(worker.view().stepper.current(), 1U);
}

}  // namespace
}  // namespace pleinair::app
