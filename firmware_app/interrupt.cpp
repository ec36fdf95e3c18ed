#include "firmware_app/interrupt.h"

#include <csignal>

namespace pleinair::app {
namespace {

volatile std::sig_atomic_t receivedSignal = 0;

void onSignal(int signal) {
  receivedSignal = signal;
}

void install(int signal, void (*handler)(int), int flags) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigaction(signal, &action, nullptr);
}

}  // namespace

Interrupt::Interrupt() {
  receivedSignal = 0;
  const int once = static_cast<int>(SA_RESETHAND);
  install(SIGINT, onSignal, once);
  install(SIGTERM, onSignal, once);
}

Interrupt::~Interrupt() {
  install(SIGINT, SIG_DFL, 0);
  install(SIGTERM, SIG_DFL, 0);
}

int Interrupt::received() {
  return receivedSignal;
}

}  // namespace pleinair::app
