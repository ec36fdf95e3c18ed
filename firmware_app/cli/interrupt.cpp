#include "firmware_app/cli/interrupt.h"

#include <atomic>
#include <cstddef>

namespace pleinair::app {
namespace {

std::atomic<int> receivedSignal = 0;
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may not wait");

void onSignal(int signal) {
  receivedSignal.store(signal);
}

bool isIgnored(const struct sigaction& action) {
  return (action.sa_flags & SA_SIGINFO) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

Interrupt::Interrupt() {
  receivedSignal.store(0);
  struct sigaction once = {};
  once.sa_handler = onSignal;
  once.sa_flags = static_cast<int>(SA_RESETHAND);
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    sigaction(kSignals.at(i), nullptr, &former_.at(i));
    if (!isIgnored(former_.at(i))) sigaction(kSignals.at(i), &once, nullptr);
  }
}

Interrupt::~Interrupt() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    sigaction(kSignals.at(i), &former_.at(i), nullptr);
  }
}

int Interrupt::received() {
  return receivedSignal.load();
}

std::string_view signalName(int signal) {
  switch (signal) {
    case SIGINT:
      return "SIGINT";
    case SIGTERM:
      return "SIGTERM";
    case SIGHUP:
      return "SIGHUP";
    default:
      return "a signal";
  }
}

}  // namespace pleinair::app
