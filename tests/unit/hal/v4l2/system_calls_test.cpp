// Tests the kernel's implementation of the system calls, on files that every system has.
#include "hal/v4l2/system_calls.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>
#include <sys/mman.h>
#include <sys/time.h>
#include <unistd.h>

#include "hal/file_descriptor.h"
#include "hal/v4l2/capability.h"

namespace pleinair::hal::v4l2 {
namespace {

TEST(KernelCalls, AnswerWithNegativeErrno) {
  SystemCalls& calls = kernelCalls();
  EXPECT_EQ(calls.open("/no-such-folder/video0", O_RDWR), -ENOENT);
  EXPECT_EQ(calls.close(-1), -EBADF);
  EXPECT_EQ(calls.ioctl(-1, VIDIOC_QUERYCAP, nullptr), -EBADF);
  void* address = nullptr;
  EXPECT_EQ(calls.map(-1, 4096, 0, address), -EBADF);
  EXPECT_EQ(address, nullptr);
  EXPECT_EQ(calls.unmap(&address, 0), -EINVAL);
  EXPECT_EQ(calls.write(-1, {}), -EBADF);
}

TEST(KernelCalls, OpenFilesThatNoChildInherits) {
  const FileDescriptor zero(kernelCalls().open("/dev/zero", O_RDONLY), kernelCalls());
  ASSERT_TRUE(zero);
  EXPECT_NE(::fcntl(zero.get(), F_GETFD) & FD_CLOEXEC, 0);
}

TEST(KernelCalls, SayThatAFileIsNoV4l2Device) {
  const FileDescriptor zero(kernelCalls().open("/dev/zero", O_RDONLY), kernelCalls());
  const Result<Capability> capability = queryCapability(kernelCalls(), zero.get(), "/dev/zero");
  ASSERT_FALSE(capability);
  EXPECT_EQ(capability.error().kind, ErrorKind::kUnsupported);
  EXPECT_EQ(capability.error().message(),
            "/dev/zero: not a V4L2 device; give a node such as /dev/video0");
}

TEST(KernelCalls, MapShared) {
  const FileDescriptor file(::memfd_create("frame", MFD_CLOEXEC), kernelCalls());
  ASSERT_EQ(::ftruncate(file.get(), 4096), 0);
  void* address = nullptr;
  ASSERT_EQ(kernelCalls().map(file.get(), 4096, 0, address), 0);
  const std::array<std::uint8_t, 3> bytes{1, 2, 3};
  EXPECT_EQ(kernelCalls().write(file.get(), bytes), 3);
  EXPECT_EQ(std::memcmp(address, bytes.data(), bytes.size()), 0);
  EXPECT_EQ(kernelCalls().unmap(address, 4096), 0);
}

TEST(KernelCalls, PollUntilReadyOrTheTimeoutIsOver) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe2(ends.data(), O_CLOEXEC), 0);
  const FileDescriptor read(ends[0], kernelCalls());
  const FileDescriptor write(ends[1], kernelCalls());
  pollfd waitFor{.fd = read.get(), .events = POLLIN, .revents = 0};
  EXPECT_EQ(kernelCalls().poll({&waitFor, 1}, Duration::zero()), 0);
  const std::array<std::uint8_t, 1> byte{7};
  ASSERT_EQ(kernelCalls().write(write.get(), byte), 1);
  EXPECT_EQ(kernelCalls().poll({&waitFor, 1}, std::nullopt), 1);
  EXPECT_EQ(waitFor.revents, POLLIN);
}

volatile std::sig_atomic_t interruptions = 0;
volatile int wokenByThird = -1;

/// Interrupts this process every millisecond during its life; the third time, it writes a byte.
class Interruptions {
 public:
  explicit Interruptions(int fd) {
    wokenByThird = fd;
    struct sigaction action {};
    action.sa_handler = [](int) {
      interruptions = interruptions + 1;
      if (interruptions == 3 && ::write(wokenByThird, "!", 1) != 1) std::abort();
    };  // without SA_RESTART: calls end with EINTR
    ::sigaction(SIGALRM, &action, &before_);
    const itimerval every{.it_interval = {.tv_sec = 0, .tv_usec = 1000},
                          .it_value = {.tv_sec = 0, .tv_usec = 1000}};
    ::setitimer(ITIMER_REAL, &every, nullptr);
  }
  ~Interruptions() {
    const itimerval never{};
    ::setitimer(ITIMER_REAL, &never, nullptr);
    ::sigaction(SIGALRM, &before_, nullptr);
  }
  Interruptions(const Interruptions&) = delete;
  Interruptions& operator=(const Interruptions&) = delete;

 private:
  struct sigaction before_ {};
};

TEST(KernelCalls, GoOnAfterSignals) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe2(ends.data(), O_CLOEXEC), 0);
  const FileDescriptor read(ends[0], kernelCalls());
  const FileDescriptor write(ends[1], kernelCalls());
  pollfd waitFor{.fd = read.get(), .events = POLLIN, .revents = 0};
  const Interruptions interrupting(write.get());
  EXPECT_EQ(kernelCalls().poll({&waitFor, 1}, std::nullopt), 1);
  EXPECT_GE(interruptions, 3);
}

}  // namespace
}  // namespace pleinair::hal::v4l2
