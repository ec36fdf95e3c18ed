#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/media/picture_file.h"
#include "hal/outputs/frames/frames_output.h"
#include "hal/outputs/movie/movie_output.h"
#include "tests/support/failing_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_pictures.h"

namespace pleinair::hal {
namespace {

/// Writes images of noise, which compress badly, until a write fails.
Result<void> writeUntilItFails(MemoryOutput& output) {
  const Result<OutputFormat> format = output.start({.size = {320, 240}});
  if (!format) return tl::unexpected(format.error());
  Image picture(format->frame);
  std::uint32_t state = 1;
  for (int i = 0; i < 60; ++i) {
    for (std::uint8_t& byte : picture.plane(0)) {
      state = state * 1664525u + 1013904223u;
      byte = static_cast<std::uint8_t>(state >> 24);
    }
    const Result<void> written = output.write(picture.view(), i * std::chrono::milliseconds(40));
    if (!written) return written;
  }
  return output.finish();
}

class FullDisk : public testing::TestWithParam<std::string> {};

TEST_P(FullDisk, IsReportedAndLeavesNoPartialMovie) {
  // From an empty disk to one that is nearly large enough: the failure comes in the header, in the
  // middle, and at the end.
  for (const std::int64_t freeBytes : {0, 100, 5'000, 300'000, 1'000'000}) {
    SCOPED_TRACE(freeBytes);
    const support::TemporaryFolder folder;
    support::FailingFiles files(freeBytes);
    {
      const auto output = openMovieOutput(folder.path() / GetParam(), files);
      const Result<void> result = writeUntilItFails(*output);
      ASSERT_FALSE(result);
      EXPECT_EQ(result.error().kind, ErrorKind::kNoSpace) << result.error().message();
      EXPECT_THAT(result.error().message(),
                  testing::HasSubstr(GetParam() + ": cannot write: No sp"));
    }
    EXPECT_EQ(folder.entryCount(), 0u);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, FullDisk, testing::Values("a.mp4", "a.mkv", "a.y4m"),
                         [](const auto& kind) { return kind.param.substr(2); });

TEST(FullDiskOfFrames, KeepsTheWholeOnesOnly) {
  const support::TemporaryFolder folder;
  support::FailingFiles files(600'000);
  {
    const auto output = openFramesOutput(folder.path() / "%d.png", files);
    const Result<void> result = writeUntilItFails(*output);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().kind, ErrorKind::kNoSpace);
  }
  ASSERT_GT(folder.entryCount(), 0u);
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    EXPECT_TRUE(readPicture(entry.path())) << entry.path();
  }
}

}  // namespace
}  // namespace pleinair::hal
