// Every broken file of the shared collection through the program itself: a painting, or one clear
// line; within the memory and the time of a sound file.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/program/program.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::support {
namespace {

namespace fs = std::filesystem;

constexpr long kMaxMebibytes = 250;  // sound pictures of these sizes take up to 180
const ProgramLimits kLimits{.addressSpaceBytes = 3UL << 30U, .time = std::chrono::seconds(60)};

class MalformedRender : public testing::TestWithParam<const char*> {
 protected:
  /// A sound picture in, so out; its first frame is looked at.
  void expectPainting(const ProgramRun& run, const fs::path& output, bool isSound) const {
    const auto played = play(output);
    ASSERT_TRUE(played) << played.error().message();
    EXPECT_FALSE(played->frames.empty());
    for (std::size_t at = 0; at < run.error.size(); at = run.error.find('\n', at) + 1) {
      const std::string line = run.error.substr(at, run.error.find('\n', at) - at);
      // A movie that becomes larger by a column or a row says so, whatever the input.
      if (line.find(": movies have even sides: ") != std::string::npos) continue;
      EXPECT_FALSE(isSound) << line;
      EXPECT_THAT(line, testing::StartsWith("pleinair: warning: "));
    }
  }

  void expectOneClearLine(const ProgramRun& run, const fs::path& input) const {
    EXPECT_EQ(run.status, 2);
    EXPECT_THAT(run.error, testing::StartsWith("pleinair: " + input.string() + ": "));
    EXPECT_EQ(std::ranges::count(run.error, '\n'), 1) << run.error;
    EXPECT_TRUE(std::ranges::all_of(run.error, [](char c) { return c == '\n' || c >= ' '; }));
    EXPECT_EQ(folder_.entryCount(), 0u) << "something was left behind";
  }

  void render(const fs::path& input) const {
    const bool isSound = input.filename().string().find("valid") != std::string::npos;
    const fs::path output = folder_.path() / "out.mp4";
    const ProgramRun run =
        runProgram({"render", "--input", input.string(), "--output", output.string()}, kLimits);
    if (!isSanitized()) {
      EXPECT_LT(run.peakMemoryMebibytes, kMaxMebibytes);
    }
    if (run.status == 0) {
      expectPainting(run, output, isSound);
    } else {
      EXPECT_FALSE(isSound) << run.error;
      expectOneClearLine(run, input);
    }
    fs::remove(output);
  }

  TemporaryFolder folder_;
};

TEST_P(MalformedRender, PaintsOrSaysWhyNot) {
  const fs::path folder = fs::path(PLEINAIR_SHARED_DATA) / "malformed" / GetParam();
  if (!fs::is_directory(folder)) GTEST_SKIP() << "test data is not here: " << folder;
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".LICENSE") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  EXPECT_GE(files.size(), 10u);
  for (const fs::path& file : files) {
    SCOPED_TRACE(file.filename());
    render(file);
  }
}

INSTANTIATE_TEST_SUITE_P(Shared, MalformedRender, testing::Values("images", "png", "video"),
                         [](const auto& folder) { return std::string(folder.param); });

}  // namespace
}  // namespace pleinair::support
