#include "firmware_app/config/input_map.h"

#include <fstream>
#include <string>

#include <gmock/gmock.h>

#include "config/config_error.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

using procedure::StepCommandKind;
using testing::HasSubstr;

class InputMapTest : public testing::Test {
 protected:
  InputMap read(const std::string& text) {
    std::ofstream(path(), std::ios::binary) << text;
    return readInputMap(path());
  }
  std::string faultOf(const std::string& text) {
    try {
      read(text);
      return "none";
    } catch (const config::ConfigError& error) {
      return error.what();
    }
  }
  std::filesystem::path path() const { return folder_.path() / "inputs.toml"; }
  support::TemporaryFolder folder_;
};

TEST_F(InputMapTest, IsReadAsItIsWritten) {
  InputMap map = read(
      "[[device]]\ndevice = \"05f3:00ff\"\nlabel = \"Ped\\\"al\"\n"
      "buttons = { 272 = \"back\", 273 = \"next\" }\n"
      "[[device]]\ndevice = \"/dev/input/by-id/x\"\ngrab = false\n"
      "[device.buttons]\n109 = \"photo\"\n"
      "[cards]\n570 = \"next\"\n571 = \"operator J. Müller\"\n");
  for (int round = 0; round < 2; ++round) {
    ASSERT_EQ(map.devices.size(), 2U);
    EXPECT_EQ(map.devices[0].device, "05f3:00ff");
    EXPECT_EQ(map.devices[0].label, "Ped\"al");
    EXPECT_TRUE(map.devices[0].grabs);
    EXPECT_EQ(map.devices[0].buttons.at(273).kind, StepCommandKind::kNext);
    EXPECT_FALSE(map.devices[1].grabs);
    EXPECT_EQ(map.cards.at(571).operatorName, "J. Müller");
    map = read(inputMapText(map));
  }
}

TEST_F(InputMapTest, MistakesAreSaidWithFileAndLine) {
  const std::string device = "[[device]]\ndevice = \"a\"\n";
  EXPECT_THAT(faultOf(device + "buttons = { 272 = \"nxt\" }"),
              testing::AllOf(HasSubstr("inputs.toml:3"), HasSubstr("did you mean \"next\"")));
  EXPECT_THAT(faultOf(device + "buttons = { LEFT = \"next\" }"), HasSubstr("is no button"));
  EXPECT_THAT(faultOf(device + "buttons = {}"), HasSubstr("has no button"));
  EXPECT_THAT(
      faultOf(device + "buttons = { 1 = \"next\" }\n" + device + "buttons = { 2 = \"next\" }"),
      HasSubstr("is there twice"));
  EXPECT_THAT(faultOf("[cards]\nx = \"next\"\n"), HasSubstr("is no tag's id"));
  EXPECT_THAT(faultOf("[card]\n1 = \"next\"\n"), HasSubstr("card"));
  EXPECT_THAT(faultOf(""), HasSubstr("[[device]], [cards]"));
}

}  // namespace
}  // namespace pleinair::app
