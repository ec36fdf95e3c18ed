#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware_app/devices/inventory.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

TEST(Displays, AreReadFromTheKernelsFiles) {
  const support::TemporaryFolder folder;
  const auto add = [&](const std::string& name, const std::string& status,
                       const std::string& modes) {
    std::filesystem::create_directory(folder.path() / name);
    std::ofstream(folder.path() / name / "status") << status;
    std::ofstream(folder.path() / name / "modes") << modes;
  };
  add("card0-HDMI-A-1", "connected\n", "1920x1080\n1920x1080\n1280x720\n1920x1080\n");
  add("card0-DP-1", "disconnected\n", "");
  std::filesystem::create_directory(folder.path() / "card0");
  std::ofstream(folder.path() / "version") << "drm 1.1.0 20060810\n";
  const std::vector<Display> displays = listDisplays(folder.path());
  ASSERT_EQ(displays.size(), 2u);
  EXPECT_EQ(displays[0].name, "card0-DP-1");
  EXPECT_FALSE(displays[0].isConnected);
  EXPECT_EQ(displays[1].name, "card0-HDMI-A-1");
  EXPECT_TRUE(displays[1].isConnected);
  EXPECT_THAT(displays[1].modes, testing::ElementsAre("1920x1080", "1280x720"));
}

TEST(Displays, AreNoneWithoutAFolder) {
  EXPECT_THAT(listDisplays("/nowhere/drm"), testing::IsEmpty());
}

}  // namespace
}  // namespace pleinair::app
