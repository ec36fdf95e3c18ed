#include "firmware_app/live/interaction/live_keys.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include "config/parameter_table.h"
#include "tests/support/fake_keyboards.h"

namespace pleinair::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct Quill {
  int size = 8;
};

const config::ParameterTable<Quill>& quill() {
  static const config::ParameterTable<Quill> kTable{config::integerParameter(
      "size", &Quill::size, {.min = 4, .max = 64, .unit = "px"}, "Of it.")};
  return kTable;
}

class LiveKeysTest : public testing::Test {
 protected:
  LiveKeysTest()
      : keyboard_(
            devices_.add({.node = "/dev/input/event0", .name = "keyboard", .isKeyboard = true})) {}
  LiveKeys::Taken press(unsigned code, int value = 1) {
    keyboard_.events.push_back({code, value});
    LiveKeys::Taken taken = keys_.take();
    keyboard_.events.push_back({code, 0});
    keys_.take();
    return taken;
  }

  hal::SteppedClock clock_{hal::TimePoint(std::chrono::seconds(100))};
  support::FakeKeyboards devices_;
  support::FakeKeyboard& keyboard_;
  LiveTuning tuning_{{{.name = "brush",
                       .start = {.style = quill().defaults(), .view = {}},
                       .views = {{"cells", ""}},
                       .looks = {}}}};
  LiveKeys keys_{{}, devices_, tuning_, clock_};
};

TEST_F(LiveKeysTest, KeysDoWhatAWindowsDo) {
  EXPECT_TRUE(press(KEY_Q).requests.quit);
  EXPECT_TRUE(press(KEY_ESC).requests.quit);
  EXPECT_TRUE(press(KEY_S).requests.snapshot);
  press(KEY_SPACE);
  EXPECT_TRUE(tuning_.isPaused());
  press(KEY_V);
  EXPECT_EQ(tuning_.parameters().view, "cells");
  const LiveKeys::Taken changed = press(KEY_RIGHT);
  EXPECT_TRUE(changed.requests.tuned);
  EXPECT_THAT(changed.state, ElementsAre(HasSubstr("size 9 px")));
  EXPECT_THAT(press(KEY_H).state, testing::Contains(HasSubstr("next parameter")));
}

TEST_F(LiveKeysTest, AnUnknownKeyIsAKeyAllTheSame) {
  const LiveKeys::Taken taken = press(KEY_Z);
  EXPECT_TRUE(taken.anyKey);
  EXPECT_FALSE(taken.requests.tuned);
  EXPECT_THAT(taken.state, IsEmpty());
  EXPECT_FALSE(keys_.take().anyKey);
}

TEST_F(LiveKeysTest, OfAnotherConsoleNoneIsTaken) {
  keys_.setPaused(true);
  EXPECT_FALSE(press(KEY_Q).requests.quit);
  keys_.setPaused(false);
  EXPECT_TRUE(press(KEY_Q).requests.quit);
}

}  // namespace
}  // namespace pleinair::app
