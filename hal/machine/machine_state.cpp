#include "hal/machine/machine_state.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

#include <sys/sysinfo.h>
#include <sys/timex.h>
#include <unistd.h>

#include "hal/machine/local_time.h"

namespace pleinair::hal {
namespace {

namespace fs = std::filesystem;

constexpr double kBelowCritical = 15.0;
constexpr Duration kJump = std::chrono::seconds(2);

/// The first bytes of a small file, without white space at its end; empty where there is none.
std::string textOf(const fs::path& path) {
  constexpr std::size_t kMost = 4096;
  std::ifstream file(path);
  std::string text(kMost, '\0');
  if (!file) return {};
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  text.erase(text.find_last_not_of(" \t\r\n") + 1);
  return text;
}

template <class Number>
std::optional<Number> numberIn(std::string_view text) {
  Number number = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  return read.ec == std::errc() ? std::optional(number) : std::nullopt;
}

/// Of a file in thousandths of a degree; values that no working sensor has are none.
std::optional<double> celsiusIn(const fs::path& file) {
  constexpr double kColdest = -40.0;
  constexpr double kHottest = 150.0;
  const auto milli = numberIn<long>(textOf(file));
  if (!milli) return std::nullopt;
  const double celsius = static_cast<double>(*milli) / 1000.0;
  if (celsius < kColdest || celsius > kHottest) return std::nullopt;
  return celsius;
}

double limitOf(const fs::path& zone) {
  std::optional<double> slowing;
  std::optional<double> critical;
  for (int i = 0;; ++i) {
    const std::string trip = "trip_point_" + std::to_string(i);
    const std::string type = textOf(zone / (trip + "_type"));
    if (type.empty()) break;
    const auto celsius = celsiusIn(zone / (trip + "_temp"));
    if (!celsius || *celsius <= 0.0) continue;
    if (type == "passive" || type == "hot")
      slowing = std::min(slowing.value_or(*celsius), *celsius);
    if (type == "critical") critical = std::min(critical.value_or(*celsius), *celsius);
  }
  if (slowing) return *slowing;
  const double usual = ThermalZone::kUsualLimit;
  return critical ? std::min(usual, *critical - kBelowCritical) : usual;
}

/// "MemAvailable:    1234 kB", in bytes.
std::optional<std::uint64_t> meminfoValue(std::string_view text, std::string_view name) {
  const std::size_t found = text.find(name);
  if (found == std::string_view::npos) return std::nullopt;
  text.remove_prefix(found + name.size());
  text.remove_prefix(std::min(text.find_first_of("0123456789"), text.size()));
  const auto kilobytes = numberIn<std::uint64_t>(text);
  return kilobytes ? std::optional(*kilobytes * 1024) : std::nullopt;
}

std::optional<std::uint64_t> residentBytes(const fs::path& process) {
  // "total resident shared …", in pages
  const std::string text = textOf(process / "statm");
  const std::size_t space = text.find(' ');
  if (space == std::string::npos) return std::nullopt;
  const auto pages = numberIn<std::uint64_t>(std::string_view(text).substr(space + 1));
  const long page = ::sysconf(_SC_PAGESIZE);
  return pages ? std::optional(*pages * static_cast<std::uint64_t>(page)) : std::nullopt;
}

/// What the service's limit leaves; nothing where there is none.
std::optional<std::uint64_t> leftOfLimit(const fs::path& cgroups, const fs::path& process) {
  const std::string text = textOf(process / "cgroup");
  const std::size_t found = text.find("0::/");  // of version 2
  if (found == std::string::npos) return std::nullopt;
  const std::size_t begin = found + 4;
  const fs::path group = cgroups / text.substr(begin, text.find('\n', begin) - begin);
  const auto most = numberIn<std::uint64_t>(textOf(group / "memory.max"));
  const auto now = numberIn<std::uint64_t>(textOf(group / "memory.current"));
  if (!most || !now) return std::nullopt;
  return *most > *now ? *most - *now : 0;
}

/// Of a machine whose /proc/meminfo is hidden from the service (ProcSubset=).
std::optional<std::uint64_t> freeBytes() {
  struct sysinfo info {};
  if (::sysinfo(&info) != 0) return std::nullopt;
  return static_cast<std::uint64_t>(info.freeram + info.bufferram) * info.mem_unit;
}

ClockTrust trustIn(std::chrono::system_clock::time_point time, const fs::path& synchronized) {
  if (!isPlausible(time)) return ClockTrust::kWrong;
  std::error_code ignored;
  if (fs::exists(synchronized, ignored)) return ClockTrust::kSynchronized;
  struct timex state {};  // only asked; a service may be forbidden to
  const int answer = ::adjtimex(&state);
  const bool isSynchronized = answer >= 0 && answer != TIME_ERROR;
  return isSynchronized ? ClockTrust::kSynchronized : ClockTrust::kUnconfirmed;
}

}  // namespace

std::optional<ThermalZone> MachineWatch::hottest() const {
  std::optional<ThermalZone> hottest;
  std::error_code failure;
  for (fs::directory_iterator each(places_.thermal, failure), end; !failure && each != end;
       each.increment(failure)) {
    const fs::path& path = each->path();
    if (!path.filename().string().starts_with("thermal_zone")) continue;
    const auto celsius = celsiusIn(path / "temp");
    if (!celsius) continue;
    ThermalZone zone{
        .name = textOf(path / "type"), .celsius = *celsius, .limitCelsius = limitOf(path)};
    if (!hottest || zone.marginCelsius() < hottest->marginCelsius()) hottest = std::move(zone);
  }
  return hottest;
}

std::optional<std::uint64_t> MachineWatch::availableBytes() const {
  auto available = meminfoValue(textOf(places_.memory), "MemAvailable:");
  if (!available) available = freeBytes();
  const auto left = leftOfLimit(places_.cgroups, places_.process);
  if (!left) return available;
  return available ? std::min(*available, *left) : left;
}

void MachineWatch::followClock(std::chrono::system_clock::time_point time, Duration sinceBoot) {
  const Duration bootTime =
      std::chrono::duration_cast<Duration>(time.time_since_epoch()) - sinceBoot;
  // Against the time before: one that is set slowly does not jump.
  const auto before = std::exchange(bootTime_, bootTime);
  if (before && std::chrono::abs(bootTime - *before) >= kJump) ++clockJumps_;
}

MachineState MachineWatch::read(std::chrono::system_clock::time_point time, Duration sinceBoot) {
  followClock(time, sinceBoot);
  MachineState state{.hottest = hottest(),
                     .usedBytes = residentBytes(places_.process),
                     .availableBytes = availableBytes(),
                     .diskFreeBytes = {},
                     .clock = trustIn(time, places_.synchronized),
                     .clockJumps = clockJumps_};
  std::error_code failure;
  if (!places_.state.empty()) {
    const fs::space_info space = fs::space(places_.state, failure);
    if (!failure) state.diskFreeBytes = space.available;
  }
  return state;
}

MachineState MachineWatch::read() {
  timespec sinceBoot{};
  ::clock_gettime(CLOCK_BOOTTIME, &sinceBoot);
  return read(std::chrono::system_clock::now(),
              std::chrono::seconds(sinceBoot.tv_sec) + std::chrono::nanoseconds(sinceBoot.tv_nsec));
}

}  // namespace pleinair::hal
