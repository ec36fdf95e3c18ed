#include "firmware_app/repair_station/input_learning.h"

#include <gmock/gmock.h>
#include <linux/input-event-codes.h>

#include "tests/support/fake_keyboards.h"

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;
using procedure::StepCommandKind;
using testing::ElementsAre;
using testing::HasSubstr;

class InputLearningTest : public testing::Test {
 protected:
  static procedure::StepCommand command(StepCommandKind kind) {
    return {.kind = kind, .operatorName = {}};
  }
  std::vector<std::string> press(support::FakeKeyboard& device, unsigned code) {
    device.events.push_back({code, 1});
    device.events.push_back({code, 0});
    return learning_.poll();
  }

  hal::SteppedClock clock_{hal::TimePoint(100s)};
  support::FakeKeyboards devices_;
  support::FakeKeyboard& pedal_{devices_.add(
      {.node = "/dev/input/event4", .name = "Foot Switch", .hasKeys = false, .id = "05f3:00ff"})};
  support::FakeKeyboard& keyboard_{
      devices_.add({.node = "/dev/input/event5", .name = "Keyboard", .isKeyboard = true})};
  InputLearning learning_{{command(StepCommandKind::kNext), command(StepCommandKind::kBack),
                           command(StepCommandKind::kPhoto)},
                          devices_,
                          clock_};
};

TEST_F(InputLearningTest, AsksForOneCommandAfterTheOther) {
  EXPECT_THAT(press(pedal_, BTN_LEFT), ElementsAre(HasSubstr("press the button for \"next\"")))
      << "what was pressed before it was asked does not count";
  EXPECT_THAT(press(pedal_, BTN_RIGHT),
              ElementsAre(HasSubstr("of Foot Switch: next"), HasSubstr("for \"back\"")));
  EXPECT_THAT(press(pedal_, BTN_RIGHT), ElementsAre(HasSubstr("has a meaning already")));
  EXPECT_THAT(press(pedal_, BTN_TOUCH), testing::IsEmpty());
  clock_.advance(10s);
  EXPECT_THAT(learning_.poll(),
              ElementsAre(HasSubstr("no button for back"), HasSubstr("for \"photo\"")));
  press(keyboard_, KEY_F5);
  EXPECT_TRUE(learning_.isDone());
  const InputMap& map = learning_.map();
  ASSERT_EQ(map.devices.size(), 2U);
  EXPECT_EQ(map.devices[0].device, "05f3:00ff");
  EXPECT_TRUE(map.devices[0].grabs);
  EXPECT_EQ(map.devices[0].buttons.size(), 1U);
  EXPECT_EQ(map.devices[0].buttons.at(BTN_RIGHT).kind, StepCommandKind::kNext);
  EXPECT_EQ(map.devices[1].device, "Keyboard") << "it has no id";
  EXPECT_FALSE(map.devices[1].grabs) << "it writes elsewhere, too";
  EXPECT_EQ(map.devices[1].buttons.at(KEY_F5).kind, StepCommandKind::kPhoto);
}

}  // namespace
}  // namespace pleinair::app
