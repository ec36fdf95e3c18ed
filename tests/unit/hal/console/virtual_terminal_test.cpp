#include "hal/console/virtual_terminal.h"

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/fake_terminals.h"

namespace pleinair::hal {
namespace {

class VirtualTerminalTest : public testing::Test {
 protected:
  void open() {
    auto opened = VirtualTerminal::open(
        terminals_, {.leave =
                         [this] {
                           EXPECT_EQ(terminals_.inFront == terminals_.own, terminal_ != nullptr)
                               << "displays are let go of before the other is in front";
                           calls_ += 'l';
                         },
                     .enter = [this] { calls_ += 'e'; }});
    ASSERT_TRUE(opened.has_value());
    terminal_ = *std::move(opened);
  }

  support::FakeTerminals terminals_;
  std::string calls_;
  std::unique_ptr<VirtualTerminal> terminal_;
};

TEST_F(VirtualTerminalTest, LetsGoBeforeAnotherComesToTheFrontAndTakesBackAfterwards) {
  open();
  EXPECT_TRUE(terminals_.isTaken);
  EXPECT_FALSE(terminal_->follow());
  terminals_.bringToFront(2);
  EXPECT_EQ(terminals_.inFront, 1) << "the kernel waits";
  EXPECT_TRUE(terminal_->follow());
  EXPECT_FALSE(terminal_->isInFront());
  EXPECT_EQ(terminals_.inFront, 2);
  EXPECT_EQ(calls_, "l");
  EXPECT_FALSE(terminal_->follow());
  terminals_.bringToFront(1);
  EXPECT_TRUE(terminal_->follow());
  EXPECT_TRUE(terminal_->isInFront());
  EXPECT_EQ(calls_, "le");
  EXPECT_EQ(terminals_.acknowledged, 1);
}

TEST_F(VirtualTerminalTest, AStormOfSwitchesIsFollowedOneByOne) {
  open();
  for (int i = 0; i < 1000; ++i) {
    terminals_.bringToFront(i % 2 == 0 ? 2 : 1);
    EXPECT_TRUE(terminal_->follow());
  }
  EXPECT_TRUE(terminal_->isInFront());
  EXPECT_EQ(terminals_.allowed, 500);
  EXPECT_EQ(calls_.size(), 1000u);
}

TEST_F(VirtualTerminalTest, OneThatIsAskedTwiceLetsGoOnce) {
  open();
  terminals_.bringToFront(2);
  terminals_.requests.push_back(Terminals::Request::kLeave);
  EXPECT_TRUE(terminal_->follow());
  EXPECT_TRUE(terminal_->follow());
  EXPECT_EQ(calls_, "l");
  EXPECT_EQ(terminals_.allowed, 2) << "the kernel waits for each answer";
}

TEST_F(VirtualTerminalTest, OneThatIsBehindAtTheStartComesToTheFront) {
  terminals_.own = 7;
  open();
  EXPECT_FALSE(terminal_->isInFront());
  EXPECT_EQ(calls_, "l");
  EXPECT_TRUE(terminal_->follow());
  EXPECT_TRUE(terminal_->isInFront());
  EXPECT_EQ(terminals_.inFront, 7);
  EXPECT_EQ(calls_, "le");
}

TEST_F(VirtualTerminalTest, IsLetGoAtTheEndAlsoBehindAnother) {
  open();
  terminals_.bringToFront(2);
  terminal_->follow();
  terminal_.reset();
  EXPECT_FALSE(terminals_.isTaken);
  EXPECT_EQ(calls_, "le") << "later displays of the process are not refused";
}

TEST_F(VirtualTerminalTest, ADesktopsIsLeftAlone) {
  terminals_.refusal = Error{.kind = ErrorKind::kBusy, .subject = "console 1"};
  const auto opened = VirtualTerminal::open(terminals_, {});
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(opened.error().kind, ErrorKind::kBusy);
}

}  // namespace
}  // namespace pleinair::hal
