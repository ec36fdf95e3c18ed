#include "pipeline/record/record_file.h"

#include <cerrno>
#include <csignal>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/resource.h>

#include "tests/unit/record/session_fixture.h"

namespace pleinair::record {
namespace {

using RecordFileTest = SessionFixture;

TEST_F(RecordFileTest, IsNeverOverwrittenAndWrittenByOneAtATime) {
  auto first = RecordFile::create(path());
  ASSERT_TRUE(first);
  ASSERT_TRUE(first->append("line\n"));
  EXPECT_EQ(RecordFile::create(path()).error().kind, hal::ErrorKind::kInvalidArgument);
  EXPECT_EQ(RecordFile::open(path()).error().kind, hal::ErrorKind::kBusy);
  EXPECT_EQ(contentOf(path()), "line\n");
  EXPECT_EQ(RecordFile::create(folder_.path() / "none" / "x").error().kind,
            hal::ErrorKind::kNotFound);
  EXPECT_EQ(RecordFile::open(folder_.path() / "none").error().kind, hal::ErrorKind::kNotFound);
  EXPECT_EQ(RecordFile::open("/dev/full").error().kind, hal::ErrorKind::kInvalidArgument);
}

TEST_F(RecordFileTest, GoesOnWhereItIsCut) {
  writeContent(path(), "one\ntw");
  auto file = RecordFile::open(path());
  ASSERT_TRUE(file);
  ASSERT_TRUE(file->cutAfter(4));
  ASSERT_TRUE(file->append("two\n"));
  EXPECT_EQ(contentOf(path()), "one\ntwo\n");
  EXPECT_EQ(file->size(), 8U);
}

TEST_F(RecordFileTest, EachLineIsSynced) {
  int syncs = 0;
  RecordSystem system = RecordSystem::real();
  system.sync = [&](int) { return ++syncs, 0; };
  auto file = RecordFile::create(path(), system);
  ASSERT_TRUE(file->append("a\n"));
  ASSERT_TRUE(file->append("b\n"));
  EXPECT_EQ(syncs, 2);
}

TEST_F(RecordFileTest, AfterAFailedSyncNothingIsWrittenAnyMore) {
  bool fails = false;
  RecordSystem system = RecordSystem::real();
  system.sync = [&](int) { return fails ? -EIO : 0; };
  auto file = RecordFile::create(path(), system);
  ASSERT_TRUE(file->append("a\n"));
  fails = true;
  EXPECT_EQ(file->append("b\n").error().kind, hal::ErrorKind::kIo);
  fails = false;
  EXPECT_THAT(file->append("c\n").error().problem, testing::HasSubstr("the disk failed earlier"));
}

/// The kernel's limit of a file's size: what is beyond it is refused, as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

TEST_F(RecordFileTest, AFullDiskKeepsStepAndRecordUntilThereIsSpace) {
  auto session = begin();
  ASSERT_TRUE(session);
  ASSERT_TRUE(session->answer(procedure::Done{}));
  const std::string before = contentOf(path());
  {
    const FileSizeLimit limit(before.size() + 100);  // less than a line
    const auto full = session->answer(procedure::YesNo{true});
    ASSERT_FALSE(full);
    EXPECT_EQ(full.error().kind, hal::ErrorKind::kNoSpace);
    EXPECT_THAT(full.error().remedy, testing::HasSubstr("free space"));
    EXPECT_EQ(session->stepper().step().id, "b") << "not done";
    EXPECT_EQ(contentOf(path()), before) << "no part of the line stays";
    EXPECT_FALSE(session->addStill("before", std::vector<std::uint8_t>(9000, 1)));
    EXPECT_EQ(contentOf(path()), before);
    EXPECT_FALSE(session->back());
    EXPECT_EQ(session->stepper().step().id, "b");
  }
  EXPECT_EQ(session->answer(procedure::YesNo{true}).value(), Advance::kMoved) << "there is space";
  ASSERT_TRUE(session->signOff());
  EXPECT_TRUE(checkRecordFile(path())->findings.empty());
}

TEST_F(RecordFileTest, AFullDiskAtTheBeginningLeavesNoRecord) {
  {
    const FileSizeLimit limit(10);
    EXPECT_EQ(begin().error().kind, hal::ErrorKind::kNoSpace);
  }
  EXPECT_FALSE(std::filesystem::exists(path()));
  EXPECT_TRUE(begin());
}

TEST_F(RecordFileTest, DevFullIsAFullDisk) {
  // The lines go to /dev/full, whose every write is refused by the kernel.
  const hal::FileDescriptor full(open("/dev/full", O_WRONLY | O_CLOEXEC));
  RecordSystem system = RecordSystem::real();
  bool isFull = false;
  system.write = [&](int fd, std::string_view bytes) {
    return RecordSystem::real().write(isFull ? full.get() : fd, bytes);
  };
  auto session = begin(system);
  ASSERT_TRUE(session);
  isFull = true;
  EXPECT_EQ(session->answer(procedure::Done{}).error().kind, hal::ErrorKind::kNoSpace);
  EXPECT_EQ(session->stepper().step().id, "a");
  isFull = false;
  EXPECT_EQ(session->answer(procedure::Done{}).value(), Advance::kMoved);
}

}  // namespace
}  // namespace pleinair::record
