#include "hal/keyboards/buttons.h"

#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <linux/input-event-codes.h>

#include "hal/keyboards/keyboards.h"
#include "tests/support/fake_keyboards.h"

namespace pleinair::hal {
namespace {

using namespace std::chrono_literals;
using support::FakeKeyboard;
using testing::ElementsAre;
using testing::IsEmpty;

class ButtonsTest : public testing::Test {
 protected:
  /// A pedal that is neither keyboard nor mouse: libinput ignores it.
  FakeKeyboard& plugPedal(int number = 4) {
    return devices_.add({.node = "/dev/input/event" + std::to_string(number),
                         .name = "Foot Switch",
                         .isKeyboard = false,
                         .hasKeys = false,
                         .id = "05f3:00ff"});
  }
  static void press(FakeKeyboard& device, unsigned code) {
    device.events.push_back({code, 1});
    device.events.push_back({code, 0});
  }
  std::vector<ButtonPressed> taken() {
    std::vector<ButtonPressed> pressed;
    buttons_->take(pressed);
    return pressed;
  }
  std::vector<std::string> changes() {
    std::vector<InputDevices::Change> changes;
    buttons_->takeChanges(changes);
    std::vector<std::string> texts;
    for (const auto& each : changes) texts.push_back(each.name + (each.isThere ? " +" : " -"));
    return texts;
  }

  SteppedClock clock_{TimePoint(100s)};
  support::FakeKeyboards devices_;
  std::optional<Buttons> buttons_;
};

TEST_F(ButtonsTest, AreThoseOfTheChosenDevices) {
  FakeKeyboard& pedal = plugPedal();
  FakeKeyboard& other = devices_.add({.node = "/dev/input/event5", .name = "Gamepad"});
  for (const char* name : {"05f3:00ff", "Foot Switch", "/dev/input/event4", "/dev/input/by-id/p"}) {
    devices_.links["/dev/input/by-id/p"] = "/dev/input/event4";
    buttons_.emplace(std::vector<ButtonDevice>{{.device = "absent"}, {.device = name}}, devices_,
                     clock_);
    press(pedal, BTN_LEFT);
    press(other, BTN_SOUTH);
    EXPECT_THAT(taken(), ElementsAre(ButtonPressed{1, BTN_LEFT})) << name;
  }
}

TEST_F(ButtonsTest, AHeldPedalDoesNotRepeat) {
  FakeKeyboard& pedal = plugPedal();
  buttons_.emplace(std::vector<ButtonDevice>{{.device = "05f3:00ff"}}, devices_, clock_);
  pedal.events = {{BTN_LEFT, 1}, {BTN_LEFT, 2}, {BTN_LEFT, 2}, {BTN_LEFT, 0}};
  EXPECT_THAT(taken(), ElementsAre(ButtonPressed{0, BTN_LEFT}));
}

TEST_F(ButtonsTest, AreGrabbedAndGivenUpWhilePaused) {
  FakeKeyboard& pedal = plugPedal();
  buttons_.emplace(std::vector<ButtonDevice>{{.device = "05f3:00ff"}}, devices_, clock_);
  taken();
  EXPECT_TRUE(pedal.isGrabbed);
  buttons_->setPaused(true);
  EXPECT_FALSE(pedal.isGrabbed);
  press(pedal, BTN_LEFT);
  EXPECT_THAT(taken(), IsEmpty());
}

TEST_F(ButtonsTest, APedalThatIsUnpluggedAndComesBackWorksAgain) {
  FakeKeyboard& pedal = plugPedal();
  buttons_.emplace(std::vector<ButtonDevice>{{.device = "05f3:00ff"}}, devices_, clock_);
  taken();
  EXPECT_THAT(changes(), ElementsAre("Foot Switch +"));
  pedal.isGone = true;
  EXPECT_THAT(taken(), IsEmpty());
  EXPECT_THAT(changes(), ElementsAre("Foot Switch -"));
  FakeKeyboard& back = plugPedal(9);  // at another node
  press(back, BTN_RIGHT);
  EXPECT_THAT(taken(), IsEmpty()) << "nobody has said so";
  buttons_->devicesChanged();
  EXPECT_THAT(taken(), ElementsAre(ButtonPressed{0, BTN_RIGHT}));
  EXPECT_THAT(changes(), ElementsAre("Foot Switch +"));
}

TEST_F(ButtonsTest, OfAMappedKeyboardAreNoKeys) {
  FakeKeyboard& presenter = devices_.add(
      {.node = "/dev/input/event6", .name = "Presenter", .isKeyboard = true, .id = "046d:c52d"});
  Keyboards keyboards({.except = {"046d:c52d"}}, devices_, clock_);
  std::vector<KeyPressed> keys;
  press(presenter, KEY_PAGEDOWN);
  keyboards.takeKeys(keys);
  EXPECT_THAT(keys, IsEmpty());
  EXPECT_EQ(presenter.opens, 0);
}

TEST(ButtonNames, AreTheKernels) {
  if (buttonName(BTN_LEFT) == std::to_string(BTN_LEFT)) GTEST_SKIP() << "built without libevdev";
  for (const unsigned code : {KEY_PAGEDOWN, BTN_LEFT, BTN_SOUTH, BTN_DPAD_LEFT}) {
    EXPECT_EQ(buttonNamed(buttonName(code)), code) << code;
  }
  EXPECT_EQ(buttonName(KEY_PAGEDOWN), "KEY_PAGEDOWN");
  EXPECT_EQ(buttonNamed("272"), unsigned{BTN_LEFT});
  for (const char* wrong : {"", "PAGEDOWN", "REL_X", "-1", "768", "3x"}) {
    EXPECT_FALSE(buttonNamed(wrong).has_value()) << wrong;
  }
}

}  // namespace
}  // namespace pleinair::hal
