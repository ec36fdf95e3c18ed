#pragma once

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "pipeline/record/work_session.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/procedure/procedure_texts.h"

namespace pleinair::record {

inline std::string contentOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline void writeContent(const std::filesystem::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

/// A procedure of six steps with each kind of check, and a clock that moves a second a look.
class SessionFixture : public testing::Test {
 protected:
  static std::shared_ptr<const procedure::Procedure> procedureOf(const std::string& more = {}) {
    auto reading = procedure::readSteps(
        "[[step]]\nid = \"a\"\nremoves = [\"cover\"]\n"
        "[[step]]\nid = \"b\"\ncheck = \"yes_no\"\ngoto = { no = \"a2\" }\n"
        "[[step]]\nid = \"c\"\ncheck = { kind = \"value\", unit = \"mm\", min = 1, max = 2 }\n"
        "[[step]]\nid = \"d\"\ncheck = \"photo\"\n"
        "[[step]]\nid = \"e\"\nfits = [\"cover\"]\nnext = \"end\"\n"
        "[[step]]\nid = \"a2\"\nnext = \"b\"\n" +
            more,
        {"a", "b", "c", "d", "e", "a2"}, "? Sure?");
    // The steps without a check have a question in the text that they share; it does no harm here.
    reading.procedure.hash = std::string(64, 'a');
    return std::make_shared<const procedure::Procedure>(std::move(reading.procedure));
  }

  MomentSource clock() {
    return [this] {
      now_ += std::chrono::seconds(1);
      return Moment{
          .wall = WallTime(std::chrono::milliseconds(1'790'000'000'000)) + now_ + wallError_,
          .monotonic = now_,
          .isClockTrusted = true,
          .boot = "boot-1"};
    };
  }

  hal::Result<WorkSession> begin(RecordSystem system = RecordSystem::real()) {
    return WorkSession::begin(procedureOf(), path(),
                              {.program = "1.0",
                               .operatorName = "J. \"Jo\" Müller",
                               .workOrder = "4711",
                               .language = "en"},
                              clock(), std::move(system));
  }
  hal::Result<WorkSession> resume(RecordSystem system = RecordSystem::real()) {
    return WorkSession::resume(procedureOf(), path(), "1.1", clock(), std::move(system));
  }

  /// Goes through all steps, with a check that fails, a way round and a step back, and signs off.
  static void work(WorkSession& session) {
    using procedure::Done;
    using procedure::MeasuredValue;
    using procedure::PhotoTaken;
    using procedure::YesNo;
    ASSERT_EQ(session.answer(Done{}).value(), Advance::kMoved);
    ASSERT_EQ(session.answer(YesNo{false}).value(), Advance::kMoved);
    ASSERT_EQ(session.answer(Done{}).value(), Advance::kMoved);
    ASSERT_EQ(session.answer(YesNo{true}, PoseQuality{"seen", 0.31, 0.8}).value(), Advance::kMoved);
    ASSERT_EQ(session.answer(MeasuredValue{2.5}).value(), Advance::kStayed);
    ASSERT_EQ(session.answer(MeasuredValue{1.5}).value(), Advance::kMoved);
    ASSERT_TRUE(session.addStill("check", std::vector<std::uint8_t>{1, 2, 3}));
    ASSERT_EQ(session.answer(PhotoTaken{}).value(), Advance::kMoved);
    ASSERT_EQ(session.back().value(), Advance::kMoved);
    ASSERT_TRUE(session.changeOperator("K. Öz"));
    ASSERT_EQ(session.answer(PhotoTaken{}).value(), Advance::kMoved);
    ASSERT_EQ(session.answer(Done{}).value(), Advance::kMoved);
    ASSERT_TRUE(session.stepper().isFinished());
    ASSERT_TRUE(session.signOff("all well"));
  }

  std::filesystem::path path() const { return folder_.path() / "work.jsonl"; }

  support::TemporaryFolder folder_;
  std::chrono::milliseconds now_{0};
  std::chrono::milliseconds wallError_{0};
};

}  // namespace pleinair::record
