#include "hal/v4l2/system_calls.h"

#include <algorithm>
#include <cerrno>
#include <ctime>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace pleinair::hal::v4l2 {
namespace {

/// Gives call()'s answer, or −errno; retries after EINTR.
template <class Call>
auto untilDone(Call call) {
  for (;;) {
    const auto answer = call();
    if (answer >= 0) return answer;
    if (errno != EINTR) return static_cast<decltype(call())>(-errno);
  }
}

timespec toTimespec(Duration duration) {
  const auto seconds = std::chrono::floor<std::chrono::seconds>(duration);
  return {.tv_sec = static_cast<std::time_t>(seconds.count()),
          .tv_nsec = static_cast<long>((duration - seconds).count())};
}

class KernelCalls final : public SystemCalls {
 public:
  int open(const char* path, int flags) override {
    return untilDone([&] { return ::open(path, flags | O_CLOEXEC); });
  }

  int close(int fd) override { return systemCloser().close(fd); }

  int ioctl(int fd, unsigned long request, void* argument) override {
    return untilDone([&] { return ::ioctl(fd, request, argument); });
  }

  int map(int fd, std::size_t length, std::int64_t offset, void*& address) override {
    void* mapped = ::mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_SHARED, fd, offset);
    if (mapped == MAP_FAILED) return -errno;
    address = mapped;
    return 0;
  }

  int unmap(void* address, std::size_t length) override {
    return ::munmap(address, length) == 0 ? 0 : -errno;
  }

  int poll(std::span<pollfd> waitFor, std::optional<Duration> timeout) override {
    const SteadyClock clock;
    const TimePoint start = clock.now();
    return untilDone([&] {
      timespec left{};
      // After EINTR, waits only for the rest of the time.
      if (timeout) left = toTimespec(std::max(*timeout - (clock.now() - start), Duration::zero()));
      return ::ppoll(waitFor.data(), waitFor.size(), timeout ? &left : nullptr, nullptr);
    });
  }

  std::int64_t write(int fd, std::span<const std::uint8_t> bytes) override {
    return untilDone(
        [&] { return static_cast<std::int64_t>(::write(fd, bytes.data(), bytes.size())); });
  }
};

}  // namespace

SystemCalls& kernelCalls() {
  static KernelCalls calls;
  return calls;
}

}  // namespace pleinair::hal::v4l2
