#include "firmware_app/live/screens/last_painting.h"

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "hal/media/png_file.h"
#include "tests/support/environment.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

constexpr hal::TimePoint kStart{100s};

hal::Image painting(hal::FrameSize size = {64, 48}, std::uint8_t level = 90) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = size, .encoding = {}});
  for (std::uint8_t& byte : image.plane(0)) byte = level;
  return image;
}

class LastPaintingTest : public testing::Test {
 protected:
  fs::path folder() const { return folder_.path() / "state"; }
  fs::path file() const { return folder() / "last-painting.png"; }
  void write(const std::string& content) const {
    fs::create_directories(folder());
    std::ofstream(file(), std::ios::binary) << content;
  }

  support::TemporaryFolder folder_;
};

TEST_F(LastPaintingTest, IsReadByTheNextRun) {
  LastPainting first(folder());
  EXPECT_FALSE(first.read().value().has_value()) << "there is none before the first run";
  first.save(painting(), kStart);
  EXPECT_FALSE(first.takeFailure(true).has_value());
  const auto kept = LastPainting(folder()).read();
  ASSERT_TRUE(kept.has_value()) << kept.error().message();
  ASSERT_TRUE(kept->has_value());
  EXPECT_EQ((*kept)->size(), (hal::FrameSize{64, 48}));
  EXPECT_EQ((*kept)->view().row(0, 20)[30], 90);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder()), fs::directory_iterator()), 1)
      << "nothing else is left behind";
}

TEST_F(LastPaintingTest, IsKeptAtMostOnceAMinute) {
  LastPainting kept(folder());
  int saves = 0;
  for (hal::TimePoint now = kStart; now < kStart + 10min; now += 50ms) {
    if (!kept.isDue(now)) continue;
    kept.save(painting(), now);
    EXPECT_FALSE(kept.takeFailure(true).has_value());
    ++saves;
  }
  EXPECT_EQ(saves, 9) << "after one minute, two …";
  EXPECT_FALSE(kept.isDueAtEnd(kStart + 9min + 59s));
  EXPECT_TRUE(kept.isDueAtEnd(kStart + 10min));
}

TEST_F(LastPaintingTest, OfAShortRunIsKeptAtItsEnd) {
  LastPainting kept(folder());
  EXPECT_FALSE(kept.isDue(kStart));
  EXPECT_FALSE(kept.isDue(kStart + 59s));
  EXPECT_TRUE(kept.isDueAtEnd(kStart + 59s));
}

TEST_F(LastPaintingTest, IsNoLargerThanItNeedBe) {
  LastPainting kept(folder());
  kept.save(painting({3840, 2160}), kStart);
  EXPECT_FALSE(kept.takeFailure(true).has_value());
  EXPECT_EQ(kept.read().value()->size(), (hal::FrameSize{1280, 720}));
}

TEST_F(LastPaintingTest, RefusesWhatItDidNotWrite) {
  const LastPainting kept(folder());
  for (const std::string& content :
       {std::string(), std::string("no picture"), std::string(9U << 20U, 'x')}) {
    write(content);
    EXPECT_FALSE(kept.read().has_value()) << content.size() << " bytes";
  }
  // One that breaks off.
  LastPainting writer(folder());
  writer.save(painting({640, 480}), kStart);
  EXPECT_FALSE(writer.takeFailure(true).has_value());
  EXPECT_TRUE(kept.read().has_value()) << "a control";
  fs::resize_file(file(), fs::file_size(file()) / 2);
  EXPECT_FALSE(kept.read().has_value());
  // Larger than any that is written.
  ASSERT_TRUE(hal::writePng(file(), painting({1400, 10}).view()).has_value());
  EXPECT_FALSE(kept.read().has_value());
  fs::remove(file());
  fs::create_directory(file());
  EXPECT_FALSE(kept.read().has_value());
}

TEST_F(LastPaintingTest, SaysWhyItCannotBeKept) {
  std::ofstream(folder_.path() / "file") << "in the way";
  LastPainting kept(folder_.path() / "file");
  kept.save(painting(), kStart);
  const auto failure = kept.takeFailure(true);
  ASSERT_TRUE(failure.has_value());
  EXPECT_NE(failure->message().find("keep_last_painting"), std::string::npos);
  EXPECT_FALSE(kept.takeFailure(true).has_value()) << "once";
}

TEST_F(LastPaintingTest, IsKeptNowhereWithoutAFolder) {
  LastPainting kept{fs::path()};
  EXPECT_FALSE(kept.read().value().has_value());
  EXPECT_FALSE(kept.isDue(kStart));
  EXPECT_FALSE(kept.isDue(kStart + 2min));
  EXPECT_FALSE(kept.isDueAtEnd(kStart + 2min));
}

TEST(StateFolder, IsTheServicesElseTheUsers) {
  support::setVariable("STATE_DIRECTORY", "/var/lib/one:/var/lib/two");
  support::setVariable("XDG_STATE_HOME", "/home/me/state");
  support::setVariable("HOME", "/home/me");
  EXPECT_EQ(stateFolder(), "/var/lib/one");
  support::setVariable("STATE_DIRECTORY", nullptr);
  EXPECT_EQ(stateFolder(), "/home/me/state/pleinair");
  support::setVariable("XDG_STATE_HOME", "relative");
  EXPECT_EQ(stateFolder(), "/home/me/.local/state/pleinair");
  support::setVariable("HOME", nullptr);
  EXPECT_TRUE(stateFolder().empty());
}

TEST(RuntimeFolder, IsTheFirstOfTheServices) {
  support::setVariable("RUNTIME_DIRECTORY", "/run/one:/run/two");
  EXPECT_EQ(runtimeFolder(), "/run/one");
  support::setVariable("RUNTIME_DIRECTORY", "/run/one");
  EXPECT_EQ(runtimeFolder(), "/run/one");
  support::setVariable("RUNTIME_DIRECTORY", nullptr);
  EXPECT_TRUE(runtimeFolder().empty());
}

}  // namespace
}  // namespace pleinair::app
