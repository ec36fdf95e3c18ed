#include "tests/support/gige_relay.h"

#include <array>
#include <atomic>
#include <cstring>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <random>
#include <set>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include "hal/file_descriptor.h"

namespace pleinair::support {
namespace {

using Bytes = std::vector<std::uint8_t>;
/// A packet of the stream: its frame's number and its own.
using PacketId = std::pair<std::uint32_t, std::uint32_t>;

// GigE Vision's control protocol (GVCP): a header of 8 bytes, then addresses and values of 4.
constexpr std::uint16_t kControlPort = 3956;
constexpr std::size_t kHeader = 8;
constexpr std::uint16_t kResend = 0x0040, kReadRegister = 0x0080, kReadRegisterAnswer = 0x0081,
                        kWriteRegister = 0x0082;
constexpr std::uint32_t kStreamPort = 0x0D00, kCapabilities = 0x0934, kCanResend = 1U << 2;
/// How many of the stream's last packets the camera could send again.
constexpr std::size_t kRemembered = 4000;

std::uint32_t word(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return ntohl(value);
}
void setWord(Bytes& bytes, std::size_t at, std::uint32_t value) {
  value = htonl(value);
  std::memcpy(bytes.data() + at, &value, sizeof value);
}
std::uint16_t halfWord(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

sockaddr_in addressOf(const std::string& text, std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  inet_pton(AF_INET, text.c_str(), &address.sin_addr);
  return address;
}

hal::FileDescriptor boundSocket(const std::string& address, std::uint16_t port) {
  hal::FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const int bytes = 8 << 20;
  if (setsockopt(socket.get(), SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof bytes) != 0) {
    setsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
  }
  const sockaddr_in own = addressOf(address, port);
  if (bind(socket.get(), reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0) return {};
  return socket;
}

std::optional<std::pair<Bytes, sockaddr_in>> received(const hal::FileDescriptor& socket) {
  Bytes bytes(65536);
  sockaddr_in from{};
  socklen_t length = sizeof from;
  const ssize_t count = recvfrom(socket.get(), bytes.data(), bytes.size(), MSG_DONTWAIT,
                                 reinterpret_cast<sockaddr*>(&from), &length);
  if (count < 0) return std::nullopt;
  bytes.resize(static_cast<std::size_t>(count));
  return std::pair(std::move(bytes), from);
}

void send(const hal::FileDescriptor& socket, const Bytes& bytes, const sockaddr_in& to) {
  sendto(socket.get(), bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to),
         sizeof to);
}

}  // namespace

struct GigeRelay::Impl {
  Impl(LinkFaults wanted, const std::string& address)
      : faults(wanted), camera(addressOf(address, kControlPort)), chance(wanted.seed) {
    thread = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }

  void run(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      std::array<pollfd, 3> waits{
          {{control.get(), POLLIN, 0}, {answers.get(), POLLIN, 0}, {stream.get(), POLLIN, 0}}};
      if (poll(waits.data(), waits.size(), 20) <= 0) continue;
      while (auto command = received(control))
        takeCommand(std::move(command->first), command->second);
      while (auto answer = received(answers)) takeAnswer(std::move(answer->first));
      for (int i = 0; i < 64; ++i) {
        auto packet = received(stream);
        if (!packet) break;
        const std::scoped_lock lock(mutex);
        takePacket(std::move(packet->first));
      }
    }
  }

  void takeCommand(Bytes bytes, const sockaddr_in& from) {
    if (isUnplugged || bytes.size() < kHeader) return;
    const std::uint16_t command = halfWord(bytes, 2);
    if (command == kResend && bytes.size() >= kHeader + 12) {
      const std::scoped_lock lock(mutex);
      return sendAgain(word(bytes, kHeader) & 0xFFFF, word(bytes, kHeader + 4) & 0xFFFFFF,
                       word(bytes, kHeader + 8) & 0xFFFFFF);
    }
    host = from;
    if (command == kWriteRegister) {
      for (std::size_t at = kHeader; at + 8 <= bytes.size(); at += 8) {
        if (word(bytes, at) != kStreamPort) continue;
        const std::scoped_lock lock(mutex);
        streamHost = from;
        streamHost.sin_port = htons(static_cast<std::uint16_t>(word(bytes, at + 4)));
        if (word(bytes, at + 4) != 0) setWord(bytes, at + 4, ownStreamPort());
      }
    }
    asksForCapabilities = command == kReadRegister && bytes.size() >= kHeader + 4 &&
                          word(bytes, kHeader) == kCapabilities;
    send(answers, bytes, camera);
  }

  void takeAnswer(Bytes bytes) {
    if (isUnplugged) return;
    if (asksForCapabilities && bytes.size() >= kHeader + 4 &&
        halfWord(bytes, 2) == kReadRegisterAnswer) {
      setWord(bytes, kHeader, word(bytes, kHeader) | kCanResend);
    }
    send(control, bytes, host);
  }

  void takePacket(Bytes bytes) {
    if (isUnplugged || bytes.size() < kHeader) return;
    const PacketId id{halfWord(bytes, 2), word(bytes, 4) & 0xFFFFFF};
    memory[id] = bytes;
    order.push_back(id);
    if (order.size() > kRemembered) {
      memory.erase(order.front());
      order.pop_front();
    }
    frames.insert(id.first);
    std::uniform_real_distribution<double> draw(0, 1);
    const bool isAffected = frames.size() <= faults.frames;
    if (isAffected && draw(chance) < faults.lost) {
      ++counts.injected;
      missing.insert(id);
      framesWithLoss.insert(id.first);
      if (draw(chance) < faults.beyondRecovery) memory.erase(id);
    } else if (isAffected && !held && draw(chance) < faults.reordered) {
      ++counts.reordered;
      held = std::move(bytes);
      return;
    } else {
      ++counts.passed;
      send(sender, bytes, streamHost);
    }
    if (!held) return;
    ++counts.passed;
    send(sender, *std::exchange(held, std::nullopt), streamHost);
  }

  void sendAgain(std::uint32_t frame, std::uint32_t first, std::uint32_t last) {
    std::uniform_real_distribution<double> draw(0, 1);
    for (std::uint32_t packet = first; packet <= last; ++packet) {
      const auto found = memory.find({frame, packet});
      if (found == memory.end() || draw(chance) < faults.lost) continue;
      send(sender, found->second, streamHost);
      if (missing.erase({frame, packet}) > 0) ++counts.recovered;
    }
  }

  std::uint32_t ownStreamPort() const {
    sockaddr_in own{};
    socklen_t length = sizeof own;
    getsockname(stream.get(), reinterpret_cast<sockaddr*>(&own), &length);
    return ntohs(own.sin_port);
  }

  LinkFaults faults;
  sockaddr_in camera;
  hal::FileDescriptor control = boundSocket(kAddress, kControlPort);  ///< towards the program
  hal::FileDescriptor answers = boundSocket("127.0.0.1", 0);          ///< towards the camera
  hal::FileDescriptor stream = boundSocket("127.0.0.1", 0);           ///< from the camera
  hal::FileDescriptor sender = boundSocket(kAddress, 0);  ///< its packets to the program
  sockaddr_in host{};
  bool asksForCapabilities = false;
  std::atomic<bool> isUnplugged = false;

  std::mutex mutex;  // guards the following
  sockaddr_in streamHost{};
  std::mt19937 chance;
  RelayCounts counts;
  std::map<PacketId, Bytes> memory;
  std::deque<PacketId> order;
  std::set<PacketId> missing;
  std::set<std::uint32_t> frames, framesWithLoss;
  std::optional<Bytes> held;
  std::jthread thread;  ///< ends first
};

GigeRelay::GigeRelay(LinkFaults faults, const std::string& camera)
    : impl_(std::make_unique<Impl>(faults, camera)) {}

GigeRelay::~GigeRelay() = default;

bool GigeRelay::isRunning() const {
  return impl_->control && impl_->answers && impl_->stream && impl_->sender;
}

void GigeRelay::sendAlien(std::span<const std::uint8_t> bytes) {
  const std::scoped_lock lock(impl_->mutex);
  send(impl_->sender, Bytes(bytes.begin(), bytes.end()), impl_->streamHost);
}

void GigeRelay::setUnplugged(bool isUnplugged) {
  impl_->isUnplugged = isUnplugged;
}

RelayCounts GigeRelay::counts() const {
  const std::scoped_lock lock(impl_->mutex);
  RelayCounts counts = impl_->counts;
  counts.framesWithLoss = impl_->framesWithLoss.size();
  std::set<std::uint32_t> notWhole;
  for (const PacketId& each : impl_->missing) notWhole.insert(each.first);
  counts.framesNotWhole = notWhole.size();
  return counts;
}

}  // namespace pleinair::support
