#include "pipeline/record/zip_file.h"

#include <memory>

#include <archive.h>
#include <archive_entry.h>
#include <gmock/gmock.h>

#include "tests/support/file_size_limit.h"
#include "tests/unit/record/session_fixture.h"

namespace pleinair::record {
namespace {

constexpr WallTime kTime{std::chrono::milliseconds(1'790'000'000'000)};

/// Names and contents, in order.
std::vector<std::pair<std::string, std::string>> entriesOf(const std::filesystem::path& path) {
  std::vector<std::pair<std::string, std::string>> entries;
  const std::unique_ptr<archive, int (*)(archive*)> zip(archive_read_new(), archive_read_free);
  archive_read_support_format_zip(zip.get());
  EXPECT_EQ(archive_read_open_filename(zip.get(), path.c_str(), 4096), ARCHIVE_OK);
  for (archive_entry* entry = nullptr; archive_read_next_header(zip.get(), &entry) == ARCHIVE_OK;) {
    std::string content(static_cast<std::size_t>(archive_entry_size(entry)), '\0');
    EXPECT_EQ(archive_read_data(zip.get(), content.data(), content.size()),
              static_cast<la_ssize_t>(content.size()));
    entries.emplace_back(archive_entry_pathname(entry), content);
  }
  return entries;
}

class ZipFileTest : public SessionFixture {
 protected:
  void writeTo(const std::filesystem::path& path) const {
    auto zip = ZipFile::create(path);
    ASSERT_TRUE(zip);
    ASSERT_TRUE(zip->add("arbeit/Prüfung.html", std::string(5000, 'x'), kTime));
    ASSERT_TRUE(zip->add("arbeit/a.png", std::string("\0\1\2", 3), kTime));
    ASSERT_TRUE(zip->add("arbeit/empty", "", kTime));
    ASSERT_TRUE(zip->publish());
  }
};

TEST_F(ZipFileTest, HoldsItsFiles) {
  const auto zip = folder_.path() / "a.zip";
  writeTo(zip);
  EXPECT_THAT(entriesOf(zip),
              testing::ElementsAre(testing::Pair("arbeit/Prüfung.html", std::string(5000, 'x')),
                                   testing::Pair("arbeit/a.png", std::string("\0\1\2", 3)),
                                   testing::Pair("arbeit/empty", "")));
  EXPECT_LT(std::filesystem::file_size(zip), 2000U) << "text is compressed";
}

TEST_F(ZipFileTest, EqualFilesGiveEqualBytes) {
  writeTo(folder_.path() / "a.zip");
  writeTo(folder_.path() / "b.zip");
  EXPECT_EQ(contentOf(folder_.path() / "a.zip"), contentOf(folder_.path() / "b.zip"));
}

TEST_F(ZipFileTest, AFullDiskLeavesNoArchive) {
  const auto path = folder_.path() / "full.zip";
  {
    const support::FileSizeLimit full(512);
    auto zip = ZipFile::create(path);
    ASSERT_TRUE(zip);
    auto added = zip->add("a.png", std::string(100'000, 'x'), kTime);
    if (added) added = zip->publish();
    ASSERT_FALSE(added);
    EXPECT_THAT(added.error().message(), testing::HasSubstr("full.zip"));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path())) << "nor a part of one";
}

}  // namespace
}  // namespace pleinair::record
