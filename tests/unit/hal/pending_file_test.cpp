#include "hal/pending_file.h"

#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/failing_files.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::hal {
namespace {

namespace fs = std::filesystem;

std::string contentOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Result<void> writeText(PendingFile& file, const std::string& text) {
  return file.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

TEST(PendingFile, StandsUnderItsNameOnlyWhenPublished) {
  const support::TemporaryFolder folder;
  Result<PendingFile> file = PendingFile::create(folder.path() / "a");
  ASSERT_TRUE(file);
  ASSERT_TRUE(writeText(*file, "text"));
  EXPECT_FALSE(fs::exists(folder.path() / "a"));
  EXPECT_TRUE(fs::exists(folder.path() / ".a.part"));
  ASSERT_TRUE(file->publish());
  EXPECT_EQ(contentOf(folder.path() / "a"), "text");
  EXPECT_EQ(folder.entryCount(), 1u);
}

TEST(PendingFile, FindsWhatKilledProcessesLeft) {
  const support::TemporaryFolder folder;
  for (const char* name : {".a.mp4.part", ".b.png.2.part", "c.part", ".part", ".d"}) {
    std::ofstream(folder.path() / name) << "left";
  }
  fs::create_directory(folder.path() / ".e.part");
  const Result<PendingFile> inUse = PendingFile::create(folder.path() / "f");
  ASSERT_TRUE(inUse);
  EXPECT_THAT(stalePartsIn(folder.path()),
              testing::ElementsAre(folder.path() / ".a.mp4.part", folder.path() / ".b.png.2.part"));
  EXPECT_TRUE(stalePartsIn(folder.path() / "nowhere").empty());
}

TEST(PendingFile, NamesWhatAPartWouldHaveBecome) {
  EXPECT_EQ(finalNameOf(".out.mp4.part"), "out.mp4");
  EXPECT_EQ(finalNameOf("folder/.out.mp4.12.part"), "out.mp4");
  EXPECT_EQ(finalNameOf("out.mp4.part"), "");
  EXPECT_EQ(finalNameOf(".part"), "");
}

TEST(PendingFile, TwoUnderOneNameDoNotMix) {
  const support::TemporaryFolder folder;
  {
    Result<PendingFile> first = PendingFile::create(folder.path() / "a");
    Result<PendingFile> second = PendingFile::create(folder.path() / "a");
    Result<PendingFile> third = PendingFile::create(folder.path() / "a");
    ASSERT_TRUE(first && second && third);
    ASSERT_TRUE(writeText(*first, "the first one's"));
    ASSERT_TRUE(writeText(*second, "second"));
    ASSERT_TRUE(writeText(*third, "is dropped"));
    ASSERT_TRUE(first->publish());
    EXPECT_EQ(contentOf(folder.path() / "a"), "the first one's");
    ASSERT_TRUE(second->publish());
    EXPECT_EQ(contentOf(folder.path() / "a"), "second");
  }
  EXPECT_EQ(folder.entryCount(), 1u);
}

TEST(PendingFile, ReplacesWhatAKilledProcessLeft) {
  const support::TemporaryFolder folder;
  std::ofstream(folder.path() / ".a.part") << "a long text that nobody finished";
  Result<PendingFile> file = PendingFile::create(folder.path() / "a");
  ASSERT_TRUE(file);
  ASSERT_TRUE(writeText(*file, "text"));
  ASSERT_TRUE(file->publish());
  EXPECT_EQ(contentOf(folder.path() / "a"), "text");
  EXPECT_EQ(folder.entryCount(), 1u);
}

TEST(PendingFile, LeavesStrangersUnderItsTemporaryNameAlone) {
  const support::TemporaryFolder folder;
  std::ofstream(folder.path() / "stranger") << "mine";
  fs::create_symlink("stranger", folder.path() / ".a.part");
  ASSERT_EQ(mkfifo((folder.path() / ".a.2.part").c_str(), 0600), 0);
  fs::create_directory(folder.path() / ".a.3.part");
  Result<PendingFile> file = PendingFile::create(folder.path() / "a");
  ASSERT_TRUE(file) << file.error().message();
  ASSERT_TRUE(file->publish());
  EXPECT_EQ(contentOf(folder.path() / "stranger"), "mine");
  EXPECT_EQ(folder.entryCount(), 5u);
}

TEST(PendingFile, RefusesWhatIsNoRegularFile) {
  const support::TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  fs::create_symlink("/dev/null", folder.path() / "link");
  fs::create_symlink("nothing", folder.path() / "dangling");
  for (const fs::path& path :
       {pipe, fs::path("/dev/null"), folder.path() / "link", folder.path() / "dangling"}) {
    const Result<PendingFile> file = PendingFile::create(path);
    ASSERT_FALSE(file) << path;
    EXPECT_EQ(file.error().kind, ErrorKind::kInvalidArgument);
    EXPECT_THAT(file.error().message(),
                testing::HasSubstr(path.string() + ": cannot write: it is"));
  }
  EXPECT_THAT(PendingFile::create(pipe).error().message(),
              testing::HasSubstr("is not a regular file"));
  EXPECT_EQ(folder.entryCount(), 3u);
}

TEST(PendingFile, WritesWhereALinkLeadsTo) {
  const support::TemporaryFolder folder;
  fs::create_directory(folder.path() / "elsewhere");
  std::ofstream(folder.path() / "elsewhere" / "a") << "old";
  fs::create_symlink("elsewhere/a", folder.path() / "link");
  Result<PendingFile> file = PendingFile::create(folder.path() / "link");
  ASSERT_TRUE(file);
  ASSERT_TRUE(writeText(*file, "new"));
  ASSERT_TRUE(file->publish());
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
  EXPECT_EQ(contentOf(folder.path() / "elsewhere" / "a"), "new");
}

TEST(PendingFile, ReportsWhatOnlySyncOrRenameSays) {
  for (const bool atSync : {true, false}) {
    const support::TemporaryFolder folder;
    support::FailingFiles files(1'000'000);
    (atSync ? files.syncAnswer : files.renameAnswer) = atSync ? -EDQUOT : -EACCES;
    Result<PendingFile> file = PendingFile::create(folder.path() / "a", files);
    ASSERT_TRUE(file);
    const Result<void> published = file->publish();
    ASSERT_FALSE(published);
    EXPECT_EQ(published.error().kind, atSync ? ErrorKind::kNoSpace : ErrorKind::kPermissionDenied);
    EXPECT_EQ(folder.entryCount(), 0u);
  }
}

TEST(PendingFile, SaysWhatWouldBeRight) {
  const support::TemporaryFolder folder;
  const Result<PendingFile> noFolder = PendingFile::create(folder.path() / "missing" / "a");
  ASSERT_FALSE(noFolder);
  EXPECT_EQ(noFolder.error().kind, ErrorKind::kNotFound);
  const Result<PendingFile> isFolder = PendingFile::create(folder.path());
  ASSERT_FALSE(isFolder);
  EXPECT_EQ(isFolder.error().kind, ErrorKind::kInvalidArgument);
}

}  // namespace
}  // namespace pleinair::hal
