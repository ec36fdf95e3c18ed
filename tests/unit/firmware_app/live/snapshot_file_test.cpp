#include <algorithm>
#include <ctime>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "firmware_app/live/snapshot_saver.h"
#include "hal/media/picture_file.h"
#include "tests/support/environment.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_pictures.h"

namespace pleinair::app {
namespace {

constexpr hal::FrameFormat kRgb{.pixelFormat = hal::PixelFormat::kRgb8, .size = {20, 10}};
constexpr std::time_t kTime = 1'750'000'000;  // 2025-06-15 15:06:40 UTC

class SnapshotFile : public testing::Test {
 protected:
  SnapshotFile() {
    support::setVariable("TZ", "UTC");
    tzset();
  }
  support::TemporaryFolder folder_;
};

TEST_F(SnapshotFile, IsNamedForItsTimeAndHoldsThePicture) {
  hal::Image picture = support::testPicture(kRgb, 3);
  const auto path = saveSnapshot(folder_.path(), picture.view(), kTime);
  ASSERT_TRUE(path) << path.error().message();
  EXPECT_EQ(*path, folder_.path() / "pleinair-20250615-150640.png");
  auto saved = hal::readPictureRgb(*path);
  ASSERT_TRUE(saved);
  EXPECT_EQ(saved->size(), picture.size());
  EXPECT_TRUE(std::ranges::equal(saved->plane(0), picture.plane(0)));
  EXPECT_EQ(folder_.entryCount(), 1u);
}

TEST_F(SnapshotFile, OfALookIsText) {
  for (const char* name : {"pleinair-20250615-150640.toml", "pleinair-20250615-150640-2.toml"}) {
    const auto path = saveLook(folder_.path(), "[painting]\n", kTime);
    ASSERT_TRUE(path) << path.error().message();
    EXPECT_EQ(*path, folder_.path() / name);
    std::ifstream file(*path);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "[painting]\n");
  }
  EXPECT_EQ(folder_.entryCount(), 2u);
  EXPECT_FALSE(saveLook(folder_.path() / "absent", "", kTime));
}

TEST_F(SnapshotFile, NeverReplacesAnything) {
  const hal::Image picture = support::testPicture(kRgb, 3);
  std::ofstream(folder_.path() / "pleinair-20250615-150640.png") << "old";
  EXPECT_EQ(*saveSnapshot(folder_.path(), picture.view(), kTime),
            folder_.path() / "pleinair-20250615-150640-2.png");
  EXPECT_EQ(*saveSnapshot(folder_.path(), picture.view(), kTime),
            folder_.path() / "pleinair-20250615-150640-3.png");
  EXPECT_EQ(std::filesystem::file_size(folder_.path() / "pleinair-20250615-150640.png"), 3u);
  EXPECT_EQ(folder_.entryCount(), 3u);
}

TEST_F(SnapshotFile, SaysWhatIsWrong) {
  const hal::Image picture = support::testPicture(kRgb, 3);
  const auto path = saveSnapshot(folder_.path() / "none", picture.view(), kTime);
  ASSERT_FALSE(path);
  EXPECT_EQ(path.error().kind, hal::ErrorKind::kNotFound);
  EXPECT_EQ(folder_.entryCount(), 0u);
}

}  // namespace
}  // namespace pleinair::app
