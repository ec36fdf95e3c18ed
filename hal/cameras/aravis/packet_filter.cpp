#include "hal/cameras/aravis/packet_filter.h"

#include <charconv>
#include <cstddef>
#include <filesystem>
#include <string>
#include <system_error>

#include <netinet/in.h>
#include <sys/socket.h>

namespace pleinair::hal::aravis {
namespace {

// From the UDP header on (8 bytes): status 2, number of the frame 2, format 1, number of the packet
// 3; with long ids (bit 7 of the format): flags 2 in place of the frame's number, which follows
// with 8 bytes, and then the packet's with 4 (GigE Vision 2.0, 24.3).
constexpr std::uint32_t kFormat = 12;
constexpr std::uint32_t kHeader = 16, kLongHeader = 28;
constexpr std::uint32_t kLongPacketNumber = 24;
constexpr std::uint32_t kIsLong = 0x80;
constexpr std::uint32_t kLeader = 1, kPayload = 3;  // a trailer is 2

constexpr sock_filter load(std::uint16_t size, std::uint32_t at) {
  return BPF_STMT(static_cast<std::uint16_t>(BPF_LD | size | BPF_ABS), at);
}

}  // namespace

std::vector<sock_filter> packetFilter(const StreamPackets& packets) {
  constexpr auto kNetwork = static_cast<std::uint32_t>(SKF_NET_OFF);
  constexpr std::uint32_t kSource = kNetwork + 12;
  const std::uint32_t most = packets.perFrame - 1;
  // Jumps are relative to the next instruction; the last but one drops, the last takes.
  std::vector<sock_filter> program{
      /* 0 */ load(BPF_W, kSource),
      /* 1 */ BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, packets.camera, 0, 15),
      /* 2 */ BPF_STMT(BPF_LD | BPF_W | BPF_LEN, 0),
      /* 3 */ BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, kHeader, 0, 13),
      /* 4 */ load(BPF_B, kFormat),
      /* 5 */ BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, kIsLong, 4, 0),
      /* 6 */ BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, kLeader, 0, 10),
      /* 7 */ BPF_JUMP(BPF_JMP | BPF_JGT | BPF_K, kPayload, 9, 0),
      /* 8 */ load(BPF_W, kFormat),
      /* 9 */ BPF_JUMP(BPF_JMP | BPF_JA, 5, 0, 0),
      /* 10 */ BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, kIsLong | kLeader, 0, 6),
      /* 11 */ BPF_JUMP(BPF_JMP | BPF_JGT | BPF_K, kIsLong | kPayload, 5, 0),
      /* 12 */ BPF_STMT(BPF_LD | BPF_W | BPF_LEN, 0),
      /* 13 */ BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, kLongHeader, 0, 3),
      /* 14 */ load(BPF_W, kLongPacketNumber),
      /* 15 */ BPF_STMT(BPF_ALU | BPF_AND | BPF_K, 0xFFFFFF),
      /* 16 */ BPF_JUMP(BPF_JMP | BPF_JGT | BPF_K, most, 0, 1),
      /* 17 */ BPF_STMT(BPF_RET | BPF_K, 0),
      /* 18 */ BPF_STMT(BPF_RET | BPF_K, 0xFFFFFFFF)};
  return program;
}

bool filterPackets(std::uint16_t port, const StreamPackets& packets) {
  std::vector<sock_filter> program = packetFilter(packets);
  const sock_fprog attached{.len = static_cast<unsigned short>(program.size()),
                            .filter = program.data()};
  std::error_code error;
  for (std::filesystem::directory_iterator each("/proc/self/fd", error), end; !error && each != end;
       each.increment(error)) {
    const std::string name = each->path().filename().string();
    int fd = -1;
    std::from_chars(name.data(), name.data() + name.size(), fd);
    int type = 0;
    socklen_t size = sizeof type;
    if (::getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type != SOCK_DGRAM) continue;
    sockaddr_in own{};
    size = sizeof own;
    if (::getsockname(fd, reinterpret_cast<sockaddr*>(&own), &size) != 0)
      continue;  // NOLINT(*-cast)
    if (own.sin_family != AF_INET || own.sin_port != htons(port)) continue;
    return ::setsockopt(fd, SOL_SOCKET, SO_ATTACH_FILTER, &attached, sizeof attached) == 0;
  }
  return false;
}

}  // namespace pleinair::hal::aravis
