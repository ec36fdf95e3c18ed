#include "hal/cameras/libcamera/host_channel.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>

#include <poll.h>
#include <sys/socket.h>

#include "hal/cameras/libcamera/host_message.h"

namespace pleinair::hal::libcamera {
namespace {

/// The kernel's limit of descriptors in a message (SCM_MAX_FD).
constexpr std::size_t kMostDescriptors = 253;

/// Room for the descriptors of a message, aligned as the kernel wants it.
struct ControlData {
  alignas(cmsghdr) std::array<std::uint8_t, CMSG_SPACE(kMostDescriptors * sizeof(int))> bytes;
};

/// Whether something can be read, or the other end is closed, in time.
bool isReadable(int socket, std::optional<Duration> timeout) {
  using Steady = std::chrono::steady_clock;
  const Steady::time_point until = Steady::now() + timeout.value_or(Duration::zero());
  for (;;) {
    int wait = -1;
    if (timeout) {
      const auto rest = std::chrono::ceil<std::chrono::milliseconds>(until - Steady::now());
      wait = static_cast<int>(std::clamp<std::int64_t>(rest.count(), 0, 1'000'000));
    }
    pollfd polled{.fd = socket, .events = POLLIN, .revents = 0};
    const int ready = ::poll(&polled, 1, wait);
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR && errno != EAGAIN) return true;  // receiving tells why
    if (timeout && Steady::now() >= until) return false;
  }
}

std::vector<FileDescriptor> descriptorsIn(msghdr& header) {
  std::vector<FileDescriptor> descriptors;
  for (cmsghdr* each = CMSG_FIRSTHDR(&header); each != nullptr; each = CMSG_NXTHDR(&header, each)) {
    if (each->cmsg_level != SOL_SOCKET || each->cmsg_type != SCM_RIGHTS) continue;
    const std::size_t count = (each->cmsg_len - CMSG_LEN(0)) / sizeof(int);
    for (std::size_t i = 0; i < count; ++i) {
      int fd = -1;
      std::memcpy(&fd, CMSG_DATA(each) + i * sizeof fd, sizeof fd);
      descriptors.emplace_back(fd);
    }
  }
  return descriptors;
}

}  // namespace

Result<std::array<FileDescriptor, 2>> HostChannel::pair() {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) < 0) {
    return tl::unexpected(errnoError("libcamera", "cannot make a socket", errno));
  }
  return std::array{FileDescriptor(ends[0]), FileDescriptor(ends[1])};
}

bool HostChannel::send(std::span<const std::uint8_t> bytes,
                       std::span<const int> descriptors) const {
  if (!socket_ || bytes.size() > kLongestMessage || descriptors.size() > kMostDescriptors) {
    return false;
  }
  iovec part{.iov_base = const_cast<std::uint8_t*>(bytes.data()), .iov_len = bytes.size()};
  ControlData control{};
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  if (!descriptors.empty()) {
    header.msg_control = control.bytes.data();
    header.msg_controllen = CMSG_SPACE(descriptors.size_bytes());
    cmsghdr* const rights = CMSG_FIRSTHDR(&header);
    rights->cmsg_level = SOL_SOCKET;
    rights->cmsg_type = SCM_RIGHTS;
    rights->cmsg_len = CMSG_LEN(descriptors.size_bytes());
    std::memcpy(CMSG_DATA(rights), descriptors.data(), descriptors.size_bytes());
  }
  for (;;) {
    if (::sendmsg(socket_.get(), &header, MSG_NOSIGNAL | MSG_DONTWAIT) >= 0) return true;
    if (errno != EINTR) return false;
  }
}

HostChannel::Reception HostChannel::receive(HostMessage& message,
                                            std::optional<Duration> timeout) const {
  message.descriptors.clear();
  message.bytes.clear();
  if (!socket_) return Reception::kClosed;
  if (!isReadable(socket_.get(), timeout)) return Reception::kTimeout;
  message.bytes.resize(kLongestMessage);
  iovec part{.iov_base = message.bytes.data(), .iov_len = message.bytes.size()};
  ControlData control;
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  header.msg_control = control.bytes.data();
  header.msg_controllen = control.bytes.size();
  ssize_t length = -1;
  do {
    length = ::recvmsg(socket_.get(), &header, MSG_CMSG_CLOEXEC);
  } while (length < 0 && errno == EINTR);
  message.bytes.resize(length > 0 ? static_cast<std::size_t>(length) : 0);
  if (length <= 0) return Reception::kClosed;
  message.descriptors = descriptorsIn(header);
  if ((header.msg_flags & (MSG_TRUNC | MSG_CTRUNC)) != 0) return Reception::kClosed;
  return Reception::kMessage;
}

}  // namespace pleinair::hal::libcamera
