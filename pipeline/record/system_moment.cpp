#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <fstream>

#include <sys/timex.h>
#include <unistd.h>

#include "pipeline/record/record_entry.h"

namespace pleinair::record {
namespace {

std::chrono::milliseconds millisecondsOf(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return std::chrono::duration_cast<std::chrono::milliseconds>(
      std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec));
}

/// NTP or another source has set the clock, and its error is bounded.
bool isSynchronised() {
  timex state{};
  const int answer = adjtimex(&state);
  // Services are kept from the clock's calls; the time daemon's mark is left to them.
  if (answer < 0) return access("/run/systemd/timesync/synchronized", F_OK) == 0;
  return answer != TIME_ERROR && (state.status & STA_UNSYNC) == 0;
}

/// 32 hexadecimal digits. A service that does not see the kernel's has it of its manager (%b).
std::string bootId() {
  std::ifstream file("/proc/sys/kernel/random/boot_id");
  std::string id;
  std::getline(file, id);
  const char* given = std::getenv("BOOT_ID");
  if (id.empty() && given != nullptr) id = given;
  std::erase(id, '-');
  return id;
}

}  // namespace

Moment systemMoment() {
  static const std::string kBoot = bootId();
  return {.wall = WallTime(millisecondsOf(CLOCK_REALTIME)),
          .monotonic = millisecondsOf(CLOCK_BOOTTIME),
          .isClockTrusted = isSynchronised(),
          .boot = kBoot};
}

}  // namespace pleinair::record
