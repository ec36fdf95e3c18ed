// The commands of the documents that print something: what they print fits on the paper, and is
// the board that the documents' calibrations look for.
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware_app/command_line.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;

/// README.md and the guides.
std::string documents() {
  const fs::path root = fs::path(PLEINAIR_TESTS_DIR) / "..";
  std::vector<fs::path> paths{root / "README.md"};
  for (const fs::directory_entry& each : fs::directory_iterator(root / "docs")) {
    if (each.path().extension() == ".md") paths.push_back(each.path());
  }
  std::string text;
  for (const fs::path& path : paths) {
    std::ifstream file(path);
    EXPECT_TRUE(file) << path;
    text.append(std::istreambuf_iterator<char>(file), {});
    text += '\n';
  }
  return text;
}

std::vector<std::string> matchesIn(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), regex), end; at != end; ++at) {
    found.push_back((*at)[1].str());
  }
  return found;
}

std::string errorOf(const std::string& command) {
  std::istringstream words(command);
  std::vector<std::string> arguments{"pleinair"};
  for (std::string word; words >> word;) arguments.push_back(word);
  std::vector<const char*> pointers;
  pointers.reserve(arguments.size());
  for (const std::string& argument : arguments) pointers.push_back(argument.c_str());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int status = runCommandLine(static_cast<int>(pointers.size()), pointers.data());
  testing::internal::GetCapturedStdout();
  const std::string error = testing::internal::GetCapturedStderr();
  return status == 0 ? "" : error;
}

TEST(DocumentedCommands, PrintTags) {
  const support::TemporaryFolder folder;
  const auto sheets = matchesIn(documents(), "pleinair tags --sheet ([^`\n]+)");
  EXPECT_GE(sheets.size(), 5U);
  for (const std::string& sheet : sheets) {
    EXPECT_EQ(errorOf("tags --sheet " + (folder.path() / sheet).string()), "") << sheet;
  }
}

TEST(DocumentedCommands, PrintTheBoardsThatCalibrationsLookFor) {
  const support::TemporaryFolder folder;
  const auto boards =
      matchesIn(documents(), "(--board\\s+\\w+:\\d+x\\d+\\s+--(?:square|tag-edge)\\s+\\d+\\.\\d+)");
  EXPECT_GE(boards.size(), 5U);
  for (const std::string& board : boards) {
    const std::string sheet = (folder.path() / "board.pdf").string();
    EXPECT_EQ(errorOf("tags --sheet " + sheet + " " + board), "") << board;
  }
}

TEST(DocumentedCommands, ABoardThatDoesNotFitIsRefusedWithTheSizeThatDoes) {
  const support::TemporaryFolder folder;
  const std::string tags = "tags --sheet " + (folder.path() / "board.pdf").string() + " ";
  for (const auto& [board, option, largest, more] :
       {std::array<std::string, 4>{"checkerboard:9x6", "--square ", "0.023", "0.024"},
        std::array<std::string, 4>{"aprilgrid:6x6", "--tag-edge ", "0.02", "0.021"}}) {
    const std::string command = tags + "--board " + board + " " + option;
    EXPECT_THAT(errorOf(command + more),
                testing::HasSubstr("give " + option + largest + " or less, or a larger --paper"));
    EXPECT_EQ(errorOf(command + largest), "");
  }
}

}  // namespace
}  // namespace pleinair::app
