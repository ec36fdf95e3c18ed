// Every broken file of the shared collection gives valid frames or one clear line, without a crash,
// a hang or unbounded memory.
#include <chrono>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "hal/media/picture_file.h"
#include "tests/support/media_files.h"

namespace pleinair::hal {
namespace {

namespace fs = std::filesystem;

long peakMemoryMebibytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

bool mustLoad(const fs::path& file) {
  return file.filename().string().find("valid") != std::string::npos;
}

void expectOneClearLine(const Error& error, const fs::path& file) {
  EXPECT_THAT(error.message(), testing::StartsWith(file.string() + ": "));
  EXPECT_THAT(error.message(), testing::Not(testing::HasSubstr("\n")));
  EXPECT_GT(error.message().size(), file.string().size() + 10);
  EXPECT_THAT(error.kind, testing::AnyOf(ErrorKind::kInvalidInput, ErrorKind::kUnsupported));
}

void playEverything(const fs::path& folder, int atLeastFiles) {
  if (!fs::is_directory(folder)) GTEST_SKIP() << "test data is not here: " << folder;
  int files = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const fs::path& file = entry.path();
    if (file.extension() == ".LICENSE") continue;
    SCOPED_TRACE(file.filename());
    ++files;
    const long memoryBefore = peakMemoryMebibytes();
    const auto before = std::chrono::steady_clock::now();
    const Result<support::Played> played = support::play(file);
    EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(10));
    EXPECT_LT(peakMemoryMebibytes() - memoryBefore, 300);
    if (!played) {
      EXPECT_FALSE(mustLoad(file)) << played.error().message();
      expectOneClearLine(played.error(), file);
      continue;
    }
    ASSERT_FALSE(played->frames.empty());
    for (const CapturedFrame& frame : played->frames) EXPECT_TRUE(frame.image.isComplete());
    const auto* end = std::get_if<EndOfStream>(&played->ending);
    ASSERT_NE(end, nullptr);
    if (end->truncated) expectOneClearLine(*end->truncated, file);
    EXPECT_FALSE(mustLoad(file) && (end->truncated || played->dropped > 0));
  }
  EXPECT_GE(files, atLeastFiles);
}

const fs::path kMalformed = fs::path(PLEINAIR_SHARED_DATA) / "malformed";

TEST(Malformed, Videos) {
  playEverything(kMalformed / "video", 20);
}

TEST(Malformed, Pictures) {
  playEverything(kMalformed / "images", 20);
}

TEST(Malformed, PngSuiteIsRefusedWhole) {
  const fs::path folder = kMalformed / "png";
  if (!fs::is_directory(folder)) GTEST_SKIP() << "test data is not here: " << folder;
  playEverything(folder, 10);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".png") continue;
    const Result<Image> picture = readPicture(entry.path());
    ASSERT_FALSE(picture) << entry.path();
    EXPECT_EQ(picture.error().kind, ErrorKind::kInvalidInput) << picture.error().message();
  }
}

TEST(Malformed, TruncatedPicturesAreRefused) {
  const fs::path folder = kMalformed / "images";
  if (!fs::is_directory(folder)) GTEST_SKIP() << "test data is not here: " << folder;
  for (const char* name :
       {"trunc_10.jpg", "trunc_50.jpg", "trunc_95.jpg", "dim_0x0.jpg", "empty.png", "sig_only.png",
        "palette_missing.png", "bad_bitdepth.png"}) {
    const Result<Image> picture = readPicture(folder / name);
    ASSERT_FALSE(picture) << name;
    EXPECT_EQ(picture.error().kind, ErrorKind::kInvalidInput) << picture.error().message();
  }
  for (const char* name : {"dim_2g_x_2g.png", "dim_65535sq_shortdata.png"}) {
    const Result<Image> picture = readPicture(folder / name);
    ASSERT_FALSE(picture) << name;
    EXPECT_EQ(picture.error().kind, ErrorKind::kUnsupported) << picture.error().message();
  }
}

}  // namespace
}  // namespace pleinair::hal
