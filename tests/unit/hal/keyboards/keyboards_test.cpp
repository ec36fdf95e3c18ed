#include "hal/keyboards/keyboards.h"

#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include "hal/keyboards/key_codes.h"
#include "tests/support/fake_keyboards.h"

namespace pleinair::hal {
namespace {

using namespace std::chrono_literals;
using support::FakeKeyboard;
using testing::ElementsAre;
using testing::IsEmpty;

KeyPressed plain(const std::string& name) {
  return {.name = name};
}

class KeyboardsTest : public testing::Test {
 protected:
  FakeKeyboard& plug(int number = 0, bool isKeyboard = true, const std::string& name = "keyboard") {
    return devices_.add({.node = "/dev/input/event" + std::to_string(number),
                         .name = name,
                         .isKeyboard = isKeyboard});
  }
  void begin(KeyboardChoice choice = {}) { keyboards_.emplace(choice, devices_, clock_); }
  static void press(FakeKeyboard& keyboard, unsigned code) {
    keyboard.events.push_back({code, 1});
    keyboard.events.push_back({code, 0});
  }
  std::vector<KeyPressed> taken() {
    std::vector<KeyPressed> keys;
    keyboards_->takeKeys(keys);
    return keys;
  }
  std::vector<Error> problems() {
    std::vector<Error> problems;
    keyboards_->takeProblems(problems);
    return problems;
  }

  SteppedClock clock_{TimePoint(100s)};
  support::FakeKeyboards devices_;
  std::optional<Keyboards> keyboards_;
};

TEST_F(KeyboardsTest, GivesTheKeysOfAWindow) {
  FakeKeyboard& keyboard = plug();
  begin();
  for (const unsigned code : {KEY_Q, KEY_ESC, KEY_TAB, KEY_RIGHT, KEY_BACKSPACE, KEY_SPACE, KEY_F1,
                              KEY_0, KEY_7, KEY_M, KEY_F12}) {
    press(keyboard, code);
  }
  EXPECT_THAT(taken(), ElementsAre(plain("q"), plain("escape"), plain("tab"), plain("right"),
                                   plain("backspace"), plain("space"), plain("f1"), plain("0"),
                                   plain("7"), plain("m"), plain("f12")));
  EXPECT_THAT(taken(), IsEmpty());
}

TEST_F(KeyboardsTest, AHeldKeyRepeats) {
  FakeKeyboard& keyboard = plug();
  begin();
  keyboard.events = {{KEY_RIGHT, 1}, {KEY_RIGHT, 2}, {KEY_RIGHT, 2}, {KEY_RIGHT, 0}};
  const KeyPressed repeat{.name = "right", .isRepeat = true};
  EXPECT_THAT(taken(), ElementsAre(plain("right"), repeat, repeat));
}

TEST_F(KeyboardsTest, ShiftOfAnyKeyboardCounts) {
  FakeKeyboard& one = plug(0);
  FakeKeyboard& other = plug(1);
  begin();
  one.events = {{KEY_LEFTSHIFT, 1}};
  EXPECT_THAT(taken(), IsEmpty());
  press(other, KEY_V);
  press(one, KEY_SLASH);
  EXPECT_THAT(taken(), ElementsAre(KeyPressed{.name = "?", .shift = true},
                                   KeyPressed{.name = "v", .shift = true}));
  one.events = {{KEY_LEFTSHIFT, 0}};
  taken();
  press(other, KEY_V);
  EXPECT_THAT(taken(), ElementsAre(plain("v")));
}

TEST_F(KeyboardsTest, KeysWithControlOrAltAreTheConsoles) {
  FakeKeyboard& keyboard = plug();
  begin();
  for (const unsigned modifier : {KEY_LEFTCTRL, KEY_RIGHTALT, KEY_LEFTMETA}) {
    keyboard.events = {{modifier, 1}, {KEY_F2, 1}, {KEY_F2, 0},
                       {KEY_Q, 1},    {KEY_Q, 0},  {modifier, 0}};
    EXPECT_THAT(taken(), IsEmpty()) << modifier;
  }
  press(keyboard, KEY_Q);
  EXPECT_THAT(taken(), ElementsAre(plain("q")));
}

TEST_F(KeyboardsTest, AKeyboardThatIsPulledOutLeavesNoModifierHeldAndIsFoundAgain) {
  FakeKeyboard& keyboard = plug();
  FakeKeyboard& other = plug(1);
  begin();
  keyboard.events = {{KEY_LEFTCTRL, 1}};
  taken();
  EXPECT_EQ(keyboards_->count(), 2u);
  keyboard.isGone = true;
  press(other, KEY_H);
  taken();
  press(other, KEY_H);
  EXPECT_THAT(taken(), ElementsAre(plain("h")));
  EXPECT_EQ(keyboard.opened, 0);
  EXPECT_EQ(keyboards_->count(), 1u);
  EXPECT_THAT(problems(), IsEmpty());

  keyboard.isGone = false;
  keyboard.events.clear();
  press(keyboard, KEY_S);
  EXPECT_THAT(taken(), IsEmpty()) << "nobody has said so";
  keyboards_->devicesChanged();
  EXPECT_THAT(taken(), ElementsAre(plain("s")));
}

TEST_F(KeyboardsTest, OneThatComesWithoutAnEventIsFoundWithinFiveSeconds) {
  begin();
  EXPECT_THAT(taken(), IsEmpty());
  press(plug(), KEY_Q);
  clock_.advance(4900ms);
  EXPECT_THAT(taken(), IsEmpty());
  clock_.advance(100ms);
  EXPECT_THAT(taken(), ElementsAre(plain("q")));
}

TEST_F(KeyboardsTest, AFloodHoldsNobodyAndIsCut) {
  FakeKeyboard& keyboard = plug();
  begin();
  for (int i = 0; i < 100'000; ++i) keyboard.events.push_back({KEY_SPACE, 2});
  const std::vector<KeyPressed> keys = taken();
  EXPECT_EQ(keys.size(), Keyboards::kMaxKeys);
  EXPECT_GT(keyboard.events.size(), 99'000u);
}

// After an overrun (SYN_DROPPED) a device tells the differences: here that Control is up, and that
// a key is down whose going down was lost.
TEST_F(KeyboardsTest, AnOverrunLeavesNoModifierHeld) {
  FakeKeyboard& keyboard = plug();
  begin();
  keyboard.events = {{KEY_LEFTCTRL, 1}};
  taken();
  keyboard.events = {{KEY_LEFTCTRL, 0}, {KEY_Q, 1}};
  EXPECT_THAT(taken(), ElementsAre(plain("q")));
}

TEST_F(KeyboardsTest, OneWithoutPermissionIsToldOnceAndTheOthersAreRead) {
  FakeKeyboard& refused = plug(0);
  refused.refusal = ErrorKind::kPermissionDenied;
  FakeKeyboard& other = plug(1);
  begin();
  press(other, KEY_Q);
  EXPECT_THAT(taken(), ElementsAre(plain("q")));
  ASSERT_EQ(problems().size(), 1u);
  clock_.advance(5s);
  taken();
  EXPECT_EQ(refused.opens, 2);
  EXPECT_THAT(problems(), IsEmpty());
  // udev has set its permissions meanwhile.
  refused.refusal.reset();
  keyboards_->devicesChanged();
  press(refused, KEY_H);
  EXPECT_THAT(taken(), ElementsAre(plain("h")));
}

TEST_F(KeyboardsTest, OnlyKeyboardsAreReadUnlessOthersAreNamed) {
  FakeKeyboard& keyboard = plug(0);
  FakeKeyboard& pedal = plug(1, false, "USB Foot Switch");
  FakeKeyboard& button = plug(2, false, "Power Button");
  begin();
  taken();
  EXPECT_EQ(keyboard.opens, 1);
  EXPECT_EQ(pedal.opens, 0);
  begin({.all = false, .named = {"USB Foot Switch"}});
  taken();
  EXPECT_EQ(pedal.opened, 1);
  EXPECT_EQ(keyboard.opened, 0);
  devices_.links["/dev/input/by-id/power"] = "/dev/input/event2";
  begin({.all = false, .named = {"/dev/input/by-id/power", "/dev/input/event0"}});
  taken();
  EXPECT_EQ(button.opened, 1);
  EXPECT_EQ(keyboard.opened, 1);
  EXPECT_EQ(pedal.opened, 0);
  begin({.all = false});
  taken();
  EXPECT_EQ(button.opened + keyboard.opened + pedal.opened, 0);
}

TEST_F(KeyboardsTest, GrabsThemWhileItsOwnConsoleIsInFront) {
  FakeKeyboard& keyboard = plug();
  begin({.grabs = true});
  taken();
  EXPECT_TRUE(keyboard.isGrabbed);
  keyboards_->setPaused(true);
  EXPECT_FALSE(keyboard.isGrabbed);
  FakeKeyboard& late = plug(1);
  keyboards_->devicesChanged();
  taken();
  EXPECT_FALSE(late.isGrabbed);
  keyboards_->setPaused(false);
  EXPECT_TRUE(keyboard.isGrabbed);
  EXPECT_TRUE(late.isGrabbed);
}

TEST_F(KeyboardsTest, OneThatAnotherProgramHasGrabbedIsTold) {
  plug().isGrabbedByAnother = true;
  begin({.grabs = true});
  taken();
  EXPECT_EQ(problems().size(), 1u);
  EXPECT_EQ(keyboards_->count(), 1u);
}

TEST_F(KeyboardsTest, KeysOfAnotherConsoleAreDropped) {
  FakeKeyboard& keyboard = plug();
  begin();
  // As the kernel's Ctrl+Alt+F2 and back looks from here.
  keyboard.events = {{KEY_LEFTCTRL, 1}, {KEY_LEFTALT, 1}, {KEY_F2, 1}};
  taken();
  keyboards_->setPaused(true);
  keyboard.events = {{KEY_F2, 0}, {KEY_LEFTALT, 0}, {KEY_LEFTCTRL, 0}};
  press(keyboard, KEY_Q);
  EXPECT_THAT(taken(), IsEmpty());
  keyboards_->setPaused(false);
  press(keyboard, KEY_H);
  EXPECT_THAT(taken(), ElementsAre(plain("h")));
}

TEST(KeyboardChoice, IsAWordOrNames) {
  EXPECT_TRUE(KeyboardChoice::parsed("auto")->all);
  EXPECT_FALSE(KeyboardChoice::parsed("none")->all);
  EXPECT_THAT(KeyboardChoice::parsed("none")->named, IsEmpty());
  const auto named = KeyboardChoice::parsed("USB Foot Switch, /dev/input/event3");
  EXPECT_FALSE(named->all);
  EXPECT_THAT(named->named, ElementsAre("USB Foot Switch", "/dev/input/event3"));
  for (const char* wrong : {"", ",", "a,", " ", "a,,b"}) {
    EXPECT_FALSE(KeyboardChoice::parsed(wrong).has_value()) << wrong;
  }
}

TEST(KeyCodes, HaveTheNamesOfAWindowsKeys) {
  EXPECT_EQ(keyboards::keyNameOf(KEY_Z, false), "z");
  EXPECT_EQ(keyboards::keyNameOf(KEY_P, true), "p");
  EXPECT_EQ(keyboards::keyNameOf(KEY_9, false), "9");
  EXPECT_EQ(keyboards::keyNameOf(KEY_F10, false), "f10");
  EXPECT_EQ(keyboards::keyNameOf(KEY_SLASH, false), "/");
  EXPECT_EQ(keyboards::keyNameOf(KEY_POWER, false), "");
  EXPECT_EQ(keyboards::keyNameOf(KEY_ENTER, false), "return");
}

}  // namespace
}  // namespace pleinair::hal
