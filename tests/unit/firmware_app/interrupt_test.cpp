#include "firmware_app/cli/interrupt.h"

#include <csignal>

#include <gtest/gtest.h>

namespace pleinair::app {
namespace {

using Handler = void (*)(int);

Handler handlerOf(int signal) {
  struct sigaction action = {};
  sigaction(signal, nullptr, &action);
  return action.sa_handler;
}

void ours(int) {}

TEST(Interrupt, RemembersTheSignal) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const Interrupt interrupt;
    EXPECT_EQ(Interrupt::received(), 0);
    std::raise(signal);
    EXPECT_EQ(Interrupt::received(), signal);
  }
}

TEST(Interrupt, LetsASecondSignalEndTheProcess) {
  const Interrupt interrupt;
  std::raise(SIGTERM);
  EXPECT_EQ(handlerOf(SIGTERM), SIG_DFL);
}

TEST(Interrupt, PutsTheFormerActionsBack) {
  const Handler before = std::signal(SIGINT, ours);
  {
    const Interrupt interrupt;
    EXPECT_NE(handlerOf(SIGINT), ours);
  }
  EXPECT_EQ(handlerOf(SIGINT), ours);
  std::signal(SIGINT, before);
}

TEST(Interrupt, LeavesIgnoredSignalsIgnored) {
  const Handler before = std::signal(SIGHUP, SIG_IGN);
  {
    const Interrupt interrupt;
    std::raise(SIGHUP);
    EXPECT_EQ(Interrupt::received(), 0);
  }
  EXPECT_EQ(handlerOf(SIGHUP), SIG_IGN);
  std::signal(SIGHUP, before);
}

TEST(SignalName, IsTheUsualOne) {
  EXPECT_EQ(signalName(SIGINT), "SIGINT");
  EXPECT_EQ(signalName(SIGTERM), "SIGTERM");
  EXPECT_EQ(signalName(SIGHUP), "SIGHUP");
}

}  // namespace
}  // namespace pleinair::app
