#include "firmware_app/cli/reload_signal.h"

#include <csignal>

#include <gtest/gtest.h>

#include "firmware_app/cli/interrupt.h"

namespace pleinair::app {
namespace {

TEST(ReloadSignal, TakesTheHangUpFromInterrupt) {
  const Interrupt interrupt;
  {
    const ReloadSignal reload;
    EXPECT_FALSE(ReloadSignal::take());
    std::raise(SIGHUP);
    std::raise(SIGHUP);  // again and again, unlike an interrupt
    EXPECT_EQ(Interrupt::received(), 0);
    EXPECT_TRUE(ReloadSignal::take());
    EXPECT_FALSE(ReloadSignal::take());
  }
  std::raise(SIGHUP);
  EXPECT_EQ(Interrupt::received(), SIGHUP) << "which has it back";
}

}  // namespace
}  // namespace pleinair::app
