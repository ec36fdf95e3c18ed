// A power cut at any byte loses no completed step.
#include <cerrno>
#include <random>

#include <gmock/gmock.h>

#include "tests/unit/record/session_fixture.h"

namespace pleinair::record {
namespace {

/// A machine whose power goes after some bytes were written: from then on nothing is written any
/// more. A file system may also leave zeros where a line's bytes were to be.
class PowerCut {
 public:
  PowerCut(std::size_t bytes, bool leavesZeros) : left_(bytes), leavesZeros_(leavesZeros) {}

  RecordSystem system() {
    return {.write = [this](int fd, std::string_view bytes) -> ssize_t {
              if (isOff_) return -EIO;
              if (bytes.size() <= left_) {
                left_ -= bytes.size();
                return RecordSystem::real().write(fd, bytes);
              }
              isOff_ = true;
              const std::string torn = leavesZeros_ ? std::string(bytes.size() - 1, '\0') + "\n"
                                                    : std::string(bytes.substr(0, left_));
              if (!torn.empty()) RecordSystem::real().write(fd, torn);
              return -EIO;
            },
            .sync = [this](int) { return isOff_ ? -EIO : 0; },
            .truncate =
                [this](int fd, off_t size) {
                  return isOff_ ? -EIO : RecordSystem::real().truncate(fd, size);
                }};
  }
  bool isOff() const { return isOff_; }

 private:
  std::size_t left_;
  bool leavesZeros_;
  bool isOff_ = false;
};

class PowerCutTest : public SessionFixture {
 protected:
  /// Answers the current step in the way that leads on.
  static hal::Result<Advance> answerStep(WorkSession& session) {
    using procedure::CheckKind;
    const auto kind = session.stepper().step().checkKind();
    if (!kind) return session.answer(procedure::Done{});
    if (*kind == CheckKind::kYesNo) return session.answer(procedure::YesNo{true});
    if (*kind == CheckKind::kValue) return session.answer(procedure::MeasuredValue{1.5});
    return session.answer(procedure::PhotoTaken{});
  }

  /// Works until the end, or until the power goes; the ids of the steps whose answer was taken.
  static std::vector<std::string> workOn(WorkSession& session) {
    std::vector<std::string> done;
    while (!session.stepper().isFinished()) {
      const std::string id = session.stepper().step().id;
      if (!answerStep(session)) return done;
      done.push_back(id);
    }
    session.signOff();
    return done;
  }
};

TEST_F(PowerCutTest, LosesNoCompletedStepAndGoesOnAtTheVeryStep) {
  std::size_t whole = 0;
  {
    auto session = begin();
    ASSERT_TRUE(session);
    workOn(*session);
    whole = contentOf(path()).size();
  }
  std::mt19937 random(21);
  int torn = 0;
  for (int cutNumber = 0; cutNumber < 50; ++cutNumber) {
    SCOPED_TRACE(cutNumber);
    std::filesystem::remove(path());
    PowerCut cut(std::uniform_int_distribution<std::size_t>(0, whole - 1)(random),
                 cutNumber % 5 == 4);
    std::vector<std::string> done;
    {
      auto session = begin(cut.system());
      if (!session) {  // before the first line was complete
        EXPECT_TRUE(cut.isOff());
        continue;
      }
      done = workOn(*session);
    }
    ASSERT_TRUE(cut.isOff());
    auto session = resume();
    ASSERT_TRUE(session) << session.error().message();
    const auto& past = session->stepper().past();
    ASSERT_EQ(past.size(), done.size());
    for (std::size_t i = 0; i < done.size(); ++i) {
      EXPECT_EQ(session->stepper().procedure().steps[past[i].step].id, done[i]);
    }
    const RecordEntry& last = session->record().entries().back();
    torn += std::get<Resumed>(last.event).cutBytes > 0 ? 1 : 0;
    if (session->stepper().isFinished()) {
      ASSERT_TRUE(session->signOff());
    } else {
      workOn(*session);
    }
    EXPECT_TRUE(session->stepper().isFinished());
    const RecordReading reading = checkRecordFile(path()).value();
    EXPECT_TRUE(reading.findings.empty())
        << (reading.findings.empty() ? "" : reading.findings[0].problem);
  }
  EXPECT_GT(torn, 30) << "most cuts fall within a line";
}

TEST_F(PowerCutTest, ACutAtEveryByteOfALineIsRecognised) {
  std::string content;
  {
    auto session = begin();
    ASSERT_TRUE(session->answer(procedure::Done{}));
    content = contentOf(path());
  }
  const std::size_t first = content.find('\n') + 1;
  for (std::size_t size = first; size < content.size(); ++size) {
    writeContent(path(), content.substr(0, size));
    auto session = resume();
    ASSERT_TRUE(session) << size << ' ' << session.error().message();
    EXPECT_EQ(session->stepper().step().id, "a");
    EXPECT_EQ(std::get<Resumed>(session->record().entries().back().event).cutBytes, size - first);
  }
  writeContent(path(), content);
  EXPECT_EQ(resume()->stepper().step().id, "b") << "the whole line counts";
}

TEST_F(PowerCutTest, AtTheSignOffLeavesAnUnsignedRecordThatIsSignedOffAgain) {
  std::size_t before = 0;
  std::size_t whole = 0;
  {
    auto session = begin();
    while (!session->stepper().isFinished()) ASSERT_TRUE(answerStep(*session));
    before = contentOf(path()).size();
    ASSERT_TRUE(session->signOff());
    whole = contentOf(path()).size();
  }
  for (std::size_t bytes = before; bytes < whole; bytes += 7) {
    for (const bool leavesZeros : {false, true}) {
      std::filesystem::remove(path());
      now_ = {};
      PowerCut cut(bytes, leavesZeros);
      {
        auto session = begin(cut.system());
        while (!session->stepper().isFinished()) ASSERT_TRUE(answerStep(*session));
        ASSERT_FALSE(session->signOff()) << bytes;
      }
      EXPECT_FALSE(checkRecordFile(path())->isSignedOff());
      auto session = resume();
      ASSERT_TRUE(session) << session.error().message();
      EXPECT_TRUE(session->stepper().isFinished());
      ASSERT_TRUE(session->signOff());
      EXPECT_TRUE(checkRecordFile(path())->findings.empty());
    }
  }
}

TEST_F(PowerCutTest, AChangedLineIsNotTakenForATornOne) {
  {
    auto session = begin();
    ASSERT_TRUE(session->answer(procedure::Done{}));
  }
  std::string content = contentOf(path());
  content[content.size() - 100] ^= 1;
  writeContent(path(), content);
  const auto session = resume();
  ASSERT_FALSE(session);
  EXPECT_THAT(session.error().problem, testing::HasSubstr("line 2 was changed"));
  EXPECT_EQ(contentOf(path()), content) << "nothing was cut off";
}

}  // namespace
}  // namespace pleinair::record
