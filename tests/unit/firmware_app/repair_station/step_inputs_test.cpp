// Pedals, cards and commands from elsewhere, down to the step and the record.
#include "firmware_app/repair_station/step_inputs.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <linux/input-event-codes.h>

#include "pipeline/record/record_check.h"
#include "tests/support/fake_keyboards.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;
using procedure::StepCommandKind;
using testing::HasSubstr;

class StepInputsTest : public testing::Test {
 protected:
  StepInputsTest() {
    std::filesystem::create_directories(folder_.path() / "records");
    std::ofstream(folder_.path() / "procedure.toml")
        << "name = \"service\"\nversion = \"1\"\nlanguages = [\"en\"]\n"
           "step = [{ id = \"a\", removes = [\"oil_plug\"] },"
           "{ id = \"b\", check = \"yes_no\" },"
           "{ id = \"c\", check = { kind = \"value\", unit = \"mm\", max = 2 } },"
           "{ id = \"d\", check = \"photo\" }]\n[model]\nsource = \"builtin:gearbox\"\n";
    std::ofstream(folder_.path() / "en.md")
        << "# S\n## a: A\n## b: B\n? Clean?\n## c: C\n? Gap\n## d: D\n";
    procedure_.emplace(LiveProcedureOptions{.folder = folder_.path(),
                                            .records = folder_.path() / "records",
                                            .operatorName = "Jo",
                                            .program = "1"},
                       clock_);
    inputs_.emplace(
        InputMap{.devices = {{.device = "05f3:00ff",
                              .label = "the pedal",
                              .buttons = {{BTN_LEFT, of(StepCommandKind::kBack)},
                                          {BTN_RIGHT, of(StepCommandKind::kNext)}}},
                             {.device = "Gamepad",
                              .label = "the gamepad",
                              .buttons = {{BTN_SOUTH, of(StepCommandKind::kNext)},
                                          {BTN_EAST, of(StepCommandKind::kYes)},
                                          {BTN_NORTH, of(StepCommandKind::kRaw)},
                                          {BTN_WEST, of(StepCommandKind::kPhoto)}}}},
                 .cards = {{570, of(StepCommandKind::kNext)},
                           {571, {.kind = StepCommandKind::kOperator, .operatorName = "K. Öz"}}}},
        devices_, *procedure_, &queue_, clock_);
    inputs_->poll();
  }

  static procedure::StepCommand of(StepCommandKind kind) {
    return {.kind = kind, .operatorName = {}};
  }
  StepInputs::Taken press(support::FakeKeyboard& device, unsigned code) {
    device.events.push_back({code, 1});
    device.events.push_back({code, 0});
    return inputs_->poll();
  }
  /// Once what was answered is on the disk.
  runtime::ProcedureStatus status() {
    procedure_->finish();
    return procedure_->status();
  }
  std::string step() { return status().step; }
  std::string notice() {
    procedure_->finish();
    return procedure_->takeNotice().value_or("");
  }
  /// Long enough that what follows is no second input at once.
  void settle() {
    procedure_->finish();
    clock_.advance(1s);
  }

  support::TemporaryFolder folder_;
  hal::SteppedClock clock_{hal::TimePoint(100s)};
  support::FakeKeyboards devices_;
  support::FakeKeyboard& pedal_{devices_.add(
      {.node = "/dev/input/event4", .name = "Foot Switch", .hasKeys = false, .id = "05f3:00ff"})};
  support::FakeKeyboard& gamepad_{
      devices_.add({.node = "/dev/input/event5", .name = "Gamepad", .hasKeys = false})};
  std::optional<LiveProcedure> procedure_;
  StepCommandQueue queue_;
  std::optional<StepInputs> inputs_;
};

TEST_F(StepInputsTest, APressIsAChangedStep) {
  EXPECT_TRUE(press(pedal_, BTN_RIGHT).any);
  EXPECT_EQ(step(), "b");
  settle();
  press(pedal_, BTN_RIGHT);
  EXPECT_EQ(step(), "b") << "a pedal answers no question";
  EXPECT_THAT(notice(), HasSubstr("y or n"));
  press(gamepad_, BTN_EAST);
  EXPECT_EQ(step(), "c");
  settle();
  press(pedal_, BTN_LEFT);
  EXPECT_EQ(step(), "b");
}

TEST_F(StepInputsTest, OfTwoInputsAtOnceOneCounts) {
  pedal_.events = {{BTN_RIGHT, 1}};
  gamepad_.events = {{BTN_EAST, 1}};
  inputs_->poll();
  EXPECT_EQ(step(), "b") << "the yes was not for the question that nobody has seen yet";
  EXPECT_THAT(notice(), HasSubstr("the pedal counted, the gamepad did not"));
  procedure_->press({.name = "y"});
  EXPECT_EQ(step(), "b") << "nor is a key";
  settle();
  procedure_->press({.name = "y"});
  EXPECT_EQ(step(), "c");
  press(pedal_, BTN_LEFT);
  EXPECT_EQ(step(), "c") << "a key counted";
}

TEST_F(StepInputsTest, AContactThatBouncesCountsOnce) {
  ASSERT_TRUE(press(gamepad_, BTN_SOUTH).any);
  clock_.advance(30ms);
  press(gamepad_, BTN_EAST);
  EXPECT_EQ(step(), "b");
  clock_.advance(60ms);
  press(gamepad_, BTN_EAST);
  EXPECT_EQ(step(), "c") << "a quick press of the same hand counts";
}

TEST_F(StepInputsTest, APedalThatIsUnpluggedIsSaidAndWorksWhenItIsBack) {
  pedal_.isGone = true;
  EXPECT_THAT(inputs_->poll().notices, testing::ElementsAre("the pedal is gone: plug it in"));
  pedal_.isGone = false;
  pedal_.events.clear();
  inputs_->devicesChanged();
  EXPECT_THAT(inputs_->poll().notices, testing::ElementsAre("the pedal is ready"));
  press(pedal_, BTN_RIGHT);
  EXPECT_EQ(step(), "b");
}

TEST_F(StepInputsTest, CommandsFromElsewhereAreObeyedAndBounded) {
  ASSERT_TRUE(queue_.put(of(StepCommandKind::kNext)));
  EXPECT_TRUE(inputs_->poll().any);
  EXPECT_EQ(step(), "b");
  // A program answers as soon as it has seen the next step: that is no contact that bounces.
  ASSERT_TRUE(queue_.put(of(StepCommandKind::kYes)));
  inputs_->poll();
  EXPECT_EQ(step(), "c");
  ASSERT_TRUE(queue_.put({.kind = StepCommandKind::kValue, .value = 1.5, .operatorName = {}}));
  inputs_->poll();
  EXPECT_EQ(step(), "d");
  for (std::size_t i = 0; i < StepCommandQueue::kMaxWaiting; ++i) {
    ASSERT_TRUE(queue_.put(of(StepCommandKind::kRaw)));
  }
  EXPECT_EQ(queue_.put(of(StepCommandKind::kRaw)).error().kind, hal::ErrorKind::kBusy);
  EXPECT_FALSE(inputs_->poll().togglesRaw) << "an even number of times";
}

TEST_F(StepInputsTest, CommandsThatAreSentTogetherAreObeyedOneAfterTheOther) {
  ASSERT_TRUE(queue_.put(of(StepCommandKind::kNext)));
  ASSERT_TRUE(queue_.put(of(StepCommandKind::kYes)));
  ASSERT_TRUE(queue_.put({.kind = StepCommandKind::kValue, .value = 1.5, .operatorName = {}}));
  for (const char* next : {"b", "c", "d"}) {
    inputs_->poll();
    EXPECT_EQ(step(), next);
  }
}

TEST_F(StepInputsTest, RawIsThePaintingsAndEndsNoStep) {
  EXPECT_TRUE(press(gamepad_, BTN_NORTH).togglesRaw);
  EXPECT_EQ(step(), "a");
}

TEST_F(StepInputsTest, ACardChangesTheOperatorAndTheRecordSaysSo) {
  const auto show = [&](std::vector<ShownTag> tags, hal::Duration time) {
    const hal::TimePoint end = clock_.now() + time;
    for (; clock_.now() < end; clock_.advance(50ms)) inputs_->see(tags, clock_.now());
  };
  show({}, 2s);
  show({{.id = 571, .edgeShare = 0.2}}, 5s);
  EXPECT_EQ(notice(), "now works: K. Öz");
  show({}, 2s);
  show({{.id = 570, .edgeShare = 0.2}}, 5s);
  EXPECT_EQ(step(), "b");
  settle();
  ASSERT_TRUE(queue_.put(of(StepCommandKind::kAbort)));
  inputs_->poll();
  const auto reading = record::checkRecordFile(status().record);
  ASSERT_TRUE(reading);
  ASSERT_TRUE(reading->isSignedOff());
  EXPECT_EQ(std::get<record::SignedOff>(reading->entries.back().event).operatorName, "K. Öz");
}

TEST_F(StepInputsTest, SignOffIsForTheEndAndAbortForBefore) {
  ASSERT_TRUE(queue_.put(of(StepCommandKind::kSignOff)));
  inputs_->poll();
  EXPECT_FALSE(status().isSignedOff);
  EXPECT_THAT(notice(), HasSubstr("there are steps left"));
  press(pedal_, BTN_RIGHT);
  settle();
  press(gamepad_, BTN_EAST);
  settle();
  procedure_->obey({.kind = StepCommandKind::kValue, .value = 1, .operatorName = {}}, "voice");
  settle();
  press(gamepad_, BTN_WEST);
  ASSERT_TRUE(procedure_->takeStillRequest());
  procedure_->putStill(hal::Image({.pixelFormat = hal::PixelFormat::kRgb8, .size = {8, 8}}));
  EXPECT_EQ(step(), "end");
  settle();
  press(pedal_, BTN_RIGHT);
  EXPECT_FALSE(status().isSignedOff) << "a pedal does not sign off by accident";
  ASSERT_TRUE(queue_.put(of(StepCommandKind::kSignOff)));
  inputs_->poll();
  EXPECT_TRUE(status().isSignedOff);
}

}  // namespace
}  // namespace pleinair::app
