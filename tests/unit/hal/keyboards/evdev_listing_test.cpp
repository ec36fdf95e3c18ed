#include "hal/keyboards/evdev_listing.h"

#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace pleinair::hal {
namespace {

class EvdevListing : public testing::Test {
 protected:
  void add(const std::string& entry, const std::string& name, const std::string& keys,
           const std::string& vendor = "0000") {
    const auto device = folder_.path() / entry / "device";
    std::filesystem::create_directories(device / "capabilities");
    std::filesystem::create_directories(device / "id");
    std::ofstream(device / "id" / "vendor") << vendor << "\n";
    std::ofstream(device / "id" / "product") << "e026\n";
    std::ofstream(device / "name") << name << "\n";
    std::ofstream(device / "capabilities" / "key") << keys << "\n";
  }
  support::TemporaryFolder folder_;
};

TEST_F(EvdevListing, TellsKeyboardsFromPedalsAndThoseFromMice) {
  // As the kernel of a laptop lists them.
  add("event10", "Integrated Camera", "100000 0 0 0");
  add("event2", "AT Translated Set 2 keyboard",
      "402000000 3803078f800d001 feffffdfffefffff fffffffffffffffe");
  add("event0", "Power Button", "10000000000000 0");
  add("event3", "USB Optical Mouse", "1f0000 0 0 0 0");
  add("event4", "PCsensor FootSwitch", "40000000", "3553");
  add("event5", "Lid Switch", "0");
  add("mouse0", "USB Optical Mouse", "1f0000 0 0 0 0");
  const auto listed = listEvdevKeyboards(folder_.path());
  ASSERT_EQ(listed.size(), 5u);
  EXPECT_EQ(listed[0].name, "Power Button");
  EXPECT_FALSE(listed[0].isKeyboard);
  EXPECT_EQ(listed[1].node, "/dev/input/event2");
  EXPECT_EQ(listed[1].name, "AT Translated Set 2 keyboard");
  EXPECT_TRUE(listed[1].isKeyboard);
  EXPECT_EQ(listed[1].id, "") << "no vendor";
  EXPECT_EQ(listed[2].name, "USB Optical Mouse");
  EXPECT_FALSE(listed[2].hasKeys);
  EXPECT_EQ(listed[3].name, "PCsensor FootSwitch");
  EXPECT_FALSE(listed[3].isKeyboard);
  EXPECT_TRUE(listed[3].hasKeys);
  EXPECT_EQ(listed[3].id, "3553:e026");
  EXPECT_EQ(listed[4].name, "Integrated Camera");
}

TEST_F(EvdevListing, IsEmptyWhereThereIsNoSuchFolder) {
  EXPECT_TRUE(listEvdevKeyboards(folder_.path() / "none").empty());
}

}  // namespace
}  // namespace pleinair::hal
