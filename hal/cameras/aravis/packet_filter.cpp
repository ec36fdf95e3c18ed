#include "hal/cameras/aravis/packet_filter.h"

#include <charconv>
#include <filesystem>
#include <string>
#include <system_error>

#include <netinet/in.h>
#include <sys/socket.h>

#include "hal/cameras/aravis/missing_packets.h"

namespace pleinair::hal::aravis {
namespace {

// From the UDP header on (8 bytes): status 2, number of the frame 2, format 1, number of the packet
// 3; with long ids (bit 7 of the format): flags 2 in place of the frame's number, which follows
// with 8 bytes, and then the packet's with 4 (GigE Vision 2.0, 24.3). A leader goes on with 2 bytes
// and the type of its payload, 2.
constexpr std::uint32_t kFormat = 12;
constexpr std::uint32_t kIsLong = 0x80;
constexpr std::uint32_t kLeader = 1, kTrailer = 2, kPayload = 3;
constexpr std::uint32_t kHasChunks = 0x4000;
constexpr std::uint32_t kMultizone = 9;  // types above it have parts with places of their own

struct Ids {
  bool isLong;
  std::uint32_t header;  ///< UDP's and GVSP's
  std::uint32_t number;  ///< the place of the packet's
};
constexpr Ids kHeaderOfShort{false, 16, 12}, kHeaderOfLong{true, 28, 24};

constexpr std::uint8_t kDrop = 0xFF, kTake = 0xFE, kToLong = 0xFD;  // targets of jumps, until known

constexpr sock_filter load(std::uint16_t size, std::uint32_t at) {
  return BPF_STMT(static_cast<std::uint16_t>(BPF_LD | size | BPF_ABS), at);
}
constexpr sock_filter loadLength() {
  return BPF_STMT(BPF_LD | BPF_W | BPF_LEN, 0);
}
constexpr sock_filter mask(std::uint32_t bits) {
  return BPF_STMT(BPF_ALU | BPF_AND | BPF_K, bits);
}
/// Compares what was loaded. 0: goes on with the next instruction.
constexpr sock_filter compare(std::uint16_t how, std::uint32_t with, std::uint8_t ifTrue,
                              std::uint8_t ifFalse) {
  return BPF_JUMP(static_cast<std::uint16_t>(BPF_JMP | how | BPF_K), with, ifTrue, ifFalse);
}

/// `parts`: packets of payload that the buffer has room for.
std::vector<sock_filter> branchOf(const Ids& ids, std::uint32_t parts) {
  const sock_filter number = load(BPF_W, ids.number);
  const sock_filter masked = mask(ids.isLong ? 0xFFFFFFFF : 0xFFFFFF);
  const std::uint32_t type = ids.header + 2;
  return {loadLength(), compare(BPF_JGE, ids.header, 0, kDrop), load(BPF_B, kFormat),
          mask(~kIsLong), compare(BPF_JEQ, kPayload, 9, 0), compare(BPF_JEQ, kTrailer, 12, 0),
          compare(BPF_JEQ, kLeader, 0, kDrop),
          // A leader.
          number, masked, compare(BPF_JEQ, 0, 0, kDrop),
          load(BPF_H, type),  // beyond the end: dropped
          mask(~kHasChunks), compare(BPF_JGT, kMultizone, kDrop, kTake),
          BPF_STMT(BPF_RET | BPF_K, 0),  // not reached
          // A packet of payload.
          number, masked, compare(BPF_JEQ, 0, kDrop, 0), compare(BPF_JGT, parts, kDrop, kTake),
          // A trailer.
          number, masked, compare(BPF_JGT, parts + 1, kDrop, kTake)};
}

void append(std::vector<sock_filter>& program, const std::vector<sock_filter>& more) {
  program.insert(program.end(), more.begin(), more.end());
}

bool isUdpSocketAt(int fd, std::uint32_t interface, std::uint16_t port) {
  int type = 0;
  socklen_t size = sizeof type;
  if (::getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type != SOCK_DGRAM) return false;
  sockaddr_in own{};
  size = sizeof own;
  // NOLINTNEXTLINE(*-cast)
  if (::getsockname(fd, reinterpret_cast<sockaddr*>(&own), &size) != 0) return false;
  if (own.sin_family != AF_INET || own.sin_port != htons(port)) return false;
  const std::uint32_t address = ntohl(own.sin_addr.s_addr);
  return interface == 0 || address == INADDR_ANY || address == interface;
}

}  // namespace

std::vector<sock_filter> packetFilter(const StreamPackets& packets) {
  const std::uint64_t partsOfShort = partsOf(packets.bufferBytes, packets.packetBytes, false);
  const std::uint64_t partsOfLong = partsOf(packets.bufferBytes, packets.packetBytes, true);
  constexpr std::uint64_t kMost = 0xFFFFFF;  // of short ids
  if (partsOfShort == 0 || partsOfLong == 0 || partsOfLong >= kMost) return {};
  std::vector<sock_filter> program{load(BPF_W, static_cast<std::uint32_t>(SKF_NET_OFF) + 12),
                                   compare(BPF_JEQ, packets.camera, 0, kDrop), load(BPF_B, kFormat),
                                   compare(BPF_JSET, kIsLong, kToLong, 0)};
  append(program, branchOf(kHeaderOfShort, static_cast<std::uint32_t>(partsOfShort)));
  const std::size_t longBranch = program.size();
  append(program, branchOf(kHeaderOfLong, static_cast<std::uint32_t>(partsOfLong)));
  const std::size_t drop = program.size();
  append(program, {BPF_STMT(BPF_RET | BPF_K, 0), BPF_STMT(BPF_RET | BPF_K, 0xFFFFFFFF)});
  for (std::size_t at = 0; at < program.size(); ++at) {
    if (BPF_CLASS(program[at].code) != BPF_JMP) continue;
    for (std::uint8_t* each : {&program[at].jt, &program[at].jf}) {
      const std::size_t target = *each == kDrop     ? drop
                                 : *each == kTake   ? drop + 1
                                 : *each == kToLong ? longBranch
                                                    : at + 1 + *each;
      *each = static_cast<std::uint8_t>(target - at - 1);
    }
  }
  return program;
}

bool filterPackets(std::uint32_t interface, std::uint16_t port, const StreamPackets& packets) {
  std::vector<sock_filter> program = packetFilter(packets);
  if (program.empty()) return false;
  const sock_fprog attached{.len = static_cast<unsigned short>(program.size()),
                            .filter = program.data()};
  std::error_code error;
  for (std::filesystem::directory_iterator each("/proc/self/fd", error), end; !error && each != end;
       each.increment(error)) {
    const std::string name = each->path().filename().string();
    int fd = -1;
    std::from_chars(name.data(), name.data() + name.size(), fd);
    if (!isUdpSocketAt(fd, interface, port)) continue;
    return ::setsockopt(fd, SOL_SOCKET, SO_ATTACH_FILTER, &attached, sizeof attached) == 0;
  }
  return false;
}

}  // namespace pleinair::hal::aravis
