#include "firmware_app/cli/reload_signal.h"

#include <atomic>

namespace pleinair::app {
namespace {

std::atomic<bool> isReloadAsked = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may not wait");

void onHangUp(int) {
  isReloadAsked.store(true);
}

}  // namespace

ReloadSignal::ReloadSignal() {
  isReloadAsked.store(false);
  struct sigaction action = {};
  action.sa_handler = onHangUp;
  action.sa_flags = SA_RESTART;
  sigaction(SIGHUP, &action, &former_);
}

ReloadSignal::~ReloadSignal() {
  sigaction(SIGHUP, &former_, nullptr);
}

bool ReloadSignal::take() {
  return isReloadAsked.exchange(false);
}

}  // namespace pleinair::app
