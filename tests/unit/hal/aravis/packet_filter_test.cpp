#include "hal/cameras/aravis/packet_filter.h"

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include "hal/file_descriptor.h"

namespace pleinair::hal::aravis {
namespace {

constexpr std::uint32_t kCamera = 0x7F000001;
constexpr std::uint8_t kLeader = 1, kTrailer = 2, kPart = 3, kAllIn = 4, kLong = 0x80;
// Room for 10 packets of 1464 bytes with short ids, and 11 of 1452 with long ones.
constexpr StreamPackets kPackets{.camera = kCamera, .bufferBytes = 14'640, .packetBytes = 1500};

/// A datagram of GVSP. `type`: of a leader's payload.
std::vector<std::uint8_t> packet(std::uint8_t format, std::uint32_t number,
                                 std::uint16_t type = 1) {
  std::vector<std::uint8_t> bytes(64);
  bytes[4] = format;
  const bool isLong = (format & kLong) != 0;
  const std::size_t at = isLong ? 16 : 4;
  if (isLong) bytes[at] = static_cast<std::uint8_t>(number >> 24U);
  bytes[at + 1] = static_cast<std::uint8_t>(number >> 16U);
  bytes[at + 2] = static_cast<std::uint8_t>(number >> 8U);
  bytes[at + 3] = static_cast<std::uint8_t>(number);
  const std::size_t content = isLong ? 20 : 8;
  bytes[content + 2] = static_cast<std::uint8_t>(type >> 8U);
  bytes[content + 3] = static_cast<std::uint8_t>(type);
  return bytes;
}

class PacketFilterTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(receiver_);
    ASSERT_TRUE(sender_);
    sockaddr_in own{
        .sin_family = AF_INET, .sin_port = 0, .sin_addr = {htonl(kCamera)}, .sin_zero = {}};
    ASSERT_EQ(::bind(receiver_.get(), address(own), sizeof own), 0);
    socklen_t size = sizeof own;
    ASSERT_EQ(::getsockname(receiver_.get(), address(own), &size), 0);
    port_ = ntohs(own.sin_port);
    ASSERT_EQ(::connect(sender_.get(), address(own), sizeof own), 0);
  }

  static sockaddr* address(sockaddr_in& of) {
    return reinterpret_cast<sockaddr*>(&of);  // NOLINT(*-cast)
  }

  bool passes(const std::vector<std::uint8_t>& bytes) {
    EXPECT_EQ(::send(sender_.get(), bytes.data(), bytes.size(), 0),
              static_cast<ssize_t>(bytes.size()));
    std::vector<std::uint8_t> received(2000);
    // Loopback delivers before send() returns.
    return ::recv(receiver_.get(), received.data(), received.size(), MSG_DONTWAIT) ==
           static_cast<ssize_t>(bytes.size());
  }

  FileDescriptor receiver_{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  FileDescriptor sender_{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  std::uint16_t port_ = 0;
};

TEST_F(PacketFilterTest, TakesWhatACameraSends) {
  ASSERT_TRUE(filterPackets(kCamera, port_, kPackets));
  EXPECT_TRUE(passes(packet(kLeader, 0)));
  EXPECT_TRUE(passes(packet(kLeader, 0, 0x4001)));  // with chunk data
  EXPECT_TRUE(passes(packet(kLeader, 0, 5)));       // extended chunk data
  EXPECT_TRUE(passes(packet(kPart, 1)));
  EXPECT_TRUE(passes(packet(kPart, 10)));
  EXPECT_TRUE(passes(packet(kTrailer, 11)));
  EXPECT_TRUE(passes(packet(kTrailer, 2)));  // of a frame that is shorter than announced
  EXPECT_TRUE(passes(packet(kLong | kLeader, 0)));
  EXPECT_TRUE(passes(packet(kLong | kPart, 11)));
  EXPECT_TRUE(passes(packet(kLong | kTrailer, 12)));
}

TEST_F(PacketFilterTest, DropsWhatWouldLieBesideTheBuffer) {
  ASSERT_TRUE(filterPackets(kCamera, port_, kPackets));
  EXPECT_FALSE(passes(packet(kPart, 0)));
  EXPECT_FALSE(passes(packet(kPart, 11)));
  EXPECT_FALSE(passes(packet(kTrailer, 12)));
  EXPECT_FALSE(passes(packet(kLeader, 1)));
  EXPECT_FALSE(passes(packet(kLong | kPart, 0)));
  EXPECT_FALSE(passes(packet(kLong | kPart, 12)));
  EXPECT_FALSE(passes(packet(kLong | kTrailer, 13)));
  // Numbers of more than 24 bits.
  EXPECT_FALSE(passes(packet(kLong | kPart, 0x0100'0001)));
  EXPECT_FALSE(passes(packet(kLong | kTrailer, 0x0100'0002)));
  EXPECT_FALSE(passes(packet(kLong | kLeader, 0x0100'0000)));
}

TEST_F(PacketFilterTest, DropsOtherFormatsAndPartsOfFrames) {
  ASSERT_TRUE(filterPackets(kCamera, port_, kPackets));
  EXPECT_FALSE(passes(packet(0, 1)));
  EXPECT_FALSE(passes(packet(kAllIn, 1)));
  EXPECT_FALSE(passes(packet(kLong | kAllIn, 1)));
  EXPECT_FALSE(passes(packet(kLeader, 0, 10)));  // several parts
  EXPECT_FALSE(passes(packet(kLong | kLeader, 0, 10)));
  for (std::size_t length = 1; length < 8; ++length) {
    std::vector<std::uint8_t> cut = packet(kPart, 1);
    cut.resize(length);
    EXPECT_FALSE(passes(cut)) << length;
  }
  std::vector<std::uint8_t> cut = packet(kLong | kPart, 1);
  cut.resize(19);
  EXPECT_FALSE(passes(cut));
  cut = packet(kLeader, 0);
  cut.resize(10);  // ends before the type
  EXPECT_FALSE(passes(cut));
}

TEST_F(PacketFilterTest, DropsWhatComesFromElsewhere) {
  StreamPackets elsewhere = kPackets;
  elsewhere.camera = 0x7F000002;
  ASSERT_TRUE(filterPackets(kCamera, port_, elsewhere));
  EXPECT_FALSE(passes(packet(kPart, 1)));
}

TEST_F(PacketFilterTest, FindsTheSocketByItsInterface) {
  EXPECT_FALSE(filterPackets(0x7F000002, port_, kPackets));
  EXPECT_TRUE(filterPackets(0, port_, kPackets));
}

TEST(PacketFilter, IsNoneWherePacketsHaveNoRoom) {
  EXPECT_TRUE(packetFilter({.camera = kCamera, .bufferBytes = 1000, .packetBytes = 48}).empty());
  EXPECT_FALSE(packetFilter({.camera = kCamera, .bufferBytes = 1000, .packetBytes = 49}).empty());
}

}  // namespace
}  // namespace pleinair::hal::aravis
