// When the machine stood still while another program ran.
//
// usage: standstills FILE      until SIGTERM; writes the table then
#include "tests/system/programs/standstills.h"

#include <csignal>
#include <cstdlib>
#include <span>

#include "hal/clock.h"

int main(int count, char** values) {
  const std::span arguments(values, static_cast<std::size_t>(count));
  if (arguments.size() != 2) return 2;
  sigset_t ending;
  ::sigemptyset(&ending);
  ::sigaddset(&ending, SIGTERM);
  ::pthread_sigmask(SIG_BLOCK, &ending, nullptr);
  pleinair::hal::SteadyClock clock;
  pleinair::Standstills standstills(clock);
  int signal = 0;
  ::sigwait(&ending, &signal);
  standstills.write(arguments[1]);
  return EXIT_SUCCESS;
}
