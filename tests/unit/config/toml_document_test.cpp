#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "config/toml_nesting.h"
#include "config/toml_reader.h"
#include "tests/unit/config/thrown_error.h"

namespace pleinair::config {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class TomlFile : public testing::Test {
 protected:
  TomlFile() {
    std::string pattern = testing::TempDir() + "toml_file_XXXXXX";
    folder_ = mkdtemp(pattern.data());
  }
  ~TomlFile() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  static std::string refusal(const std::filesystem::path& path) {
    return thrownBy([&] { TomlDocument::parseFile(path); });
  }

  std::filesystem::path folder_;
};

TEST_F(TomlFile, IsReadWithItsNameInMessages) {
  const auto path = write("scene.toml", "\xEF\xBB\xBFtitle = \"desk\"\r\nedge = 'big'\r\n");
  const TomlTable root = TomlDocument::parseFile(path).root();
  EXPECT_EQ(root.string("title"), "desk");
  EXPECT_EQ(thrownBy([&] { root.number("edge"); }),
            path.string() + ":2: edge: found \"big\" (string), allowed: a number");
}

TEST_F(TomlFile, MustBeARegularFile) {
  const std::string allowed = ", allowed: a TOML file of at most 1 MiB";
  EXPECT_EQ(
      refusal(folder_ / "none.toml"),
      (folder_ / "none.toml").string() + ": cannot open: No such file or directory" + allowed);
  EXPECT_EQ(refusal(folder_), folder_.string() + ": is a directory" + allowed);
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(refusal(folder_ / "pipe"),
            (folder_ / "pipe").string() + ": is not a regular file" + allowed);
}

TEST_F(TomlFile, MustBeReadable) {
  const auto path = write("secret.toml", "a = 1\n");
  std::filesystem::permissions(path, std::filesystem::perms::none);
  if (std::ifstream(path)) GTEST_SKIP() << "this user (root?) may read every file";
  EXPECT_THAT(refusal(path), HasSubstr("cannot open: Permission denied"));
}

TEST_F(TomlFile, MustNotBeLargerThanItsLimit) {
  const std::string line = "# a comment ...\n";
  std::string text;
  while (text.size() < (std::size_t{1} << 20)) text += line;
  EXPECT_EQ(refusal(write("large.toml", text)), "(nothing thrown)");
  EXPECT_THAT(refusal(write("larger.toml", text + "#")),
              HasSubstr("larger.toml: too large, allow"));
}

std::string refusalOf(const std::string& text) {
  return thrownBy([&] { TomlDocument::parseText(text, "t.toml"); });
}

TEST(TomlDocument, NamesTheLineOfBrokenSyntax) {
  EXPECT_THAT(refusalOf("a = 1\nb = \n"), StartsWith("t.toml:2: not TOML: "));
  EXPECT_THAT(refusalOf("a = 1\n\na = 2\n"), StartsWith("t.toml:3: not TOML: "));
  EXPECT_THAT(refusalOf("a = \"\xFF\"\n"), StartsWith("t.toml:1: not TOML: "));
  EXPECT_THAT(refusalOf(std::string("a\0b = 1\n", 8)), StartsWith("t.toml:1: not TOML: "));
  EXPECT_THAT(refusalOf("a = [1,\n"), StartsWith("t.toml:"));
  EXPECT_EQ(refusalOf(""), "(nothing thrown)");
}

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

TEST(TomlDocument, BoundsNesting) {
  const std::string message = "t.toml:2: nested too deeply, allowed: 16 levels";
  EXPECT_EQ(refusalOf("\n" + repeated("a.", 200'000) + "a = 1\n"), message);
  EXPECT_EQ(refusalOf("\n[" + repeated("\"x.\" . ", 100'000) + "a]\n"), message);
  EXPECT_EQ(refusalOf("\na = " + repeated("[", 500'000)), message);
  EXPECT_EQ(refusalOf("\na = " + repeated("{a=", 300'000)), message);
  EXPECT_EQ(refusalOf(repeated("a.", 15) + "a = " + repeated("[", 16) + repeated("]", 16)),
            "(nothing thrown)");
}

TEST(TomlDocument, IsNotDeepForWhatStringsAndCommentsHold) {
  const std::string deep = repeated("[a.", 30);
  EXPECT_EQ(refusalOf("# " + deep + "\n"), "(nothing thrown)");
  EXPECT_EQ(refusalOf("a = \"\\\" " + deep + "\"\n"), "(nothing thrown)");
  EXPECT_EQ(refusalOf("a = '\\'\nb = '" + deep + "'\n"), "(nothing thrown)");
  EXPECT_EQ(refusalOf("a = '''\n" + deep + "\n" + deep + "'''''\nb = 1\n"), "(nothing thrown)");
  EXPECT_EQ(refusalOf("a = [" + repeated("0.5, ", 100) + "]\n"), "(nothing thrown)");
  EXPECT_EQ(lineNestedTooDeep("a = \"\"\"\n\n\"\"\"\nb = [[[", 2), 4);
}

}  // namespace
}  // namespace pleinair::config
