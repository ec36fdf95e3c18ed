// Whatever is changed in a record is found.
#include <gmock/gmock.h>

#include "tests/unit/record/session_fixture.h"

namespace pleinair::record {
namespace {

using testing::HasSubstr;

class RecordTampering : public SessionFixture {
 protected:
  void SetUp() override {
    auto session = begin();
    ASSERT_TRUE(session) << session.error().message();
    work(*session);
    content_ = contentOf(path());
    for (std::size_t at = 0; at < content_.size();) {
      const std::size_t end = content_.find('\n', at) + 1;
      lines_.push_back(content_.substr(at, end - at));
      at = end;
    }
  }

  static std::string joined(const std::vector<std::string>& lines) {
    std::string all;
    for (const std::string& line : lines) all += line;
    return all;
  }
  static std::string findingOf(const std::string& content) {
    const RecordReading reading = checkRecord(content);
    return reading.findings.empty() ? "" : reading.findings.front().problem;
  }

  std::string content_;
  std::vector<std::string> lines_;
};

TEST_F(RecordTampering, AnUntouchedRecordIsSound) {
  const RecordReading reading = checkRecordFile(path()).value();
  EXPECT_TRUE(reading.findings.empty());
  EXPECT_TRUE(reading.isSignedOff());
  EXPECT_EQ(reading.entries.size(), lines_.size());
  EXPECT_EQ(reading.chainedBytes, content_.size());
}

TEST_F(RecordTampering, EveryChangedByteIsFound) {
  ASSERT_GT(content_.size(), 3000U);
  std::size_t missed = 0;
  for (std::size_t at = 0; at < content_.size(); ++at) {
    for (const int change : {0x01, 0x20, 0x80, 0xFF}) {
      std::string changed = content_;
      changed[at] = static_cast<char>(changed[at] ^ change);
      if (findingOf(changed).empty()) ++missed;
    }
  }
  EXPECT_EQ(missed, 0U) << "of " << 4 * content_.size();
}

TEST_F(RecordTampering, EveryRemovedOrInsertedByteIsFound) {
  for (std::size_t at = 0; at < content_.size(); ++at) {
    std::string shorter = content_;
    shorter.erase(at, 1);
    ASSERT_NE(findingOf(shorter), "") << at;
    std::string longer = content_;
    longer.insert(at, " ");
    ASSERT_NE(findingOf(longer), "") << at;
  }
  EXPECT_NE(findingOf(content_ + "\n"), "");
  EXPECT_NE(findingOf(content_ + lines_.back()), "");
}

TEST_F(RecordTampering, RemovedSwappedAndRepeatedLinesAreFound) {
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    std::vector<std::string> removed = lines_;
    removed.erase(removed.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_NE(findingOf(joined(removed)), "") << i;
    std::vector<std::string> repeated = lines_;
    repeated.insert(repeated.begin() + static_cast<std::ptrdiff_t>(i), lines_[i]);
    EXPECT_NE(findingOf(joined(repeated)), "") << i;
    for (std::size_t j = 0; j < i; ++j) {
      std::vector<std::string> swapped = lines_;
      std::swap(swapped[i], swapped[j]);
      EXPECT_NE(findingOf(joined(swapped)), "") << i << ' ' << j;
    }
    const std::vector<std::string> cut(lines_.begin(),
                                       lines_.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_THAT(findingOf(joined(cut)), HasSubstr("is not signed off")) << i;
  }
}

TEST_F(RecordTampering, LinesOfAnotherRecordAreFound) {
  support::TemporaryFolder other;
  auto session = WorkSession::begin(procedureOf(), other.path() / "other.jsonl",
                                    {.operatorName = "X", .language = "en"}, clock());
  ASSERT_TRUE(session);
  work(*session);
  const std::string theirs = contentOf(other.path() / "other.jsonl");
  const std::string second = theirs.substr(theirs.find('\n') + 1);
  std::vector<std::string> mixed = lines_;
  mixed[1] = second.substr(0, second.find('\n') + 1);
  EXPECT_THAT(findingOf(joined(mixed)), HasSubstr("one of them is of another record"));
}

TEST_F(RecordTampering, AChangedOrMissingStillIsFound) {
  const std::filesystem::path stills = folder_.path() / "work.stills";
  ASSERT_TRUE(std::filesystem::is_directory(stills));
  const std::filesystem::path still = *std::filesystem::directory_iterator(stills);
  writeContent(still, std::string("\x01\x02\x04", 3));
  EXPECT_THAT(checkRecordFile(path())->findings.at(0).problem, HasSubstr("was changed"));
  std::filesystem::remove(still);
  EXPECT_THAT(checkRecordFile(path())->findings.at(0).problem, HasSubstr("No such file"));
}

TEST_F(RecordTampering, AClockThatIsSetBackIsANoteAndNoFinding) {
  std::filesystem::remove(path());
  auto session = begin();
  ASSERT_TRUE(session);
  ASSERT_TRUE(session->answer(procedure::Done{}));
  wallError_ = -std::chrono::hours(2);
  ASSERT_TRUE(session->signOff());
  const RecordReading reading = checkRecordFile(path()).value();
  EXPECT_TRUE(reading.findings.empty());
  ASSERT_EQ(reading.notes.size(), 1U);
  EXPECT_THAT(reading.notes[0], HasSubstr("line 3: the wall clock was set back by 7199.0 s"));
}

TEST_F(RecordTampering, TimeThatGoesBackWithinOneStartOfTheMachineIsFound) {
  std::filesystem::remove(path());
  auto session = begin();
  ASSERT_TRUE(session);
  ASSERT_TRUE(session->answer(procedure::Done{}));
  now_ -= std::chrono::seconds(60);
  ASSERT_TRUE(session->signOff());
  EXPECT_THAT(checkRecordFile(path())->findings.at(0).problem,
              HasSubstr("was written before the line before it"));
}

TEST_F(RecordTampering, AStillIsBesideItsRecord) {
  const auto pathOf = [&](const std::string& file) {
    return pathOfStill({.file = file}, folder_.path());
  };
  EXPECT_TRUE(pathOf("work.stills/0001.png"));
  std::filesystem::create_symlink("/etc", folder_.path() / "link");
  for (const char* file : {"", ".", "..", "../x.png", "work.stills/../../x.png", "/etc/passwd",
                           "link/passwd", "link"}) {
    EXPECT_FALSE(pathOf(file)) << file;
  }
}

}  // namespace
}  // namespace pleinair::record
