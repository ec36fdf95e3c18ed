#include "firmware_app/status_server/listen_address.h"

#include <array>
#include <charconv>
#include <cstddef>
#include <cstring>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/un.h>

namespace pleinair::app {
namespace {

std::optional<in_port_t> portOf(std::string_view text) {
  in_port_t port = 0;
  const char* const last = text.data() + text.size();
  const auto [end, status] = std::from_chars(text.data(), last, port);
  if (text.empty() || status != std::errc() || end != last) return std::nullopt;
  return port;
}

template <class Address>
ListenAddress stored(const Address& address) {
  ListenAddress result{.length = sizeof(Address)};
  std::memcpy(&result.storage, &address, sizeof address);
  return result;
}

template <class Address>
Address loaded(const ListenAddress& address) {
  Address result{};
  std::memcpy(&result, &address.storage, sizeof result);
  return result;
}

std::optional<ListenAddress> addressOf(std::string host, in_port_t port) {
  sockaddr_in v4{};
  if (inet_pton(AF_INET, host.c_str(), &v4.sin_addr) == 1) {
    v4.sin_family = AF_INET;
    v4.sin_port = htons(port);
    return stored(v4);
  }
  if (!host.starts_with('[') || !host.ends_with(']')) return std::nullopt;
  host = host.substr(1, host.size() - 2);
  sockaddr_in6 v6{};
  if (inet_pton(AF_INET6, host.c_str(), &v6.sin6_addr) != 1) return std::nullopt;
  v6.sin6_family = AF_INET6;
  v6.sin6_port = htons(port);
  return stored(v6);
}

/// "unix:/run/pleinair.sock"; an abstract name begins with '@'.
std::string pathOf(const ListenAddress& address) {
  const auto local = loaded<sockaddr_un>(address);
  const std::size_t head = offsetof(sockaddr_un, sun_path);
  std::string path(static_cast<const char*>(local.sun_path),
                   address.length > head ? address.length - head : 0);
  if (path.starts_with('\0')) path.front() = '@';
  return "unix:" + path.substr(0, path.find('\0'));
}

}  // namespace

hal::Result<std::optional<ListenAddress>> parseListen(const std::string& text) {
  if (text == kNoServer) return std::nullopt;
  const std::size_t colon = text.rfind(':');
  if (colon != std::string::npos) {
    const auto port = portOf(std::string_view(text).substr(colon + 1));
    const auto address = port ? addressOf(text.substr(0, colon), *port) : std::nullopt;
    if (address) return address;
  }
  return tl::unexpected(
      hal::Error{.kind = hal::ErrorKind::kInvalidArgument,
                 .subject = "status.listen",
                 .problem = fmt::format("found \"{}\", allowed: {}", text, kAllowedListen)});
}

bool isLoopback(const sockaddr* address) {
  constexpr std::uint32_t kLoopbackNet = 127;
  const void* any = address;
  if (address->sa_family == AF_UNIX) return true;
  if (address->sa_family == AF_INET) {
    sockaddr_in v4{};
    std::memcpy(&v4, any, sizeof v4);
    return ntohl(v4.sin_addr.s_addr) >> 24U == kLoopbackNet;
  }
  if (address->sa_family != AF_INET6) return false;
  sockaddr_in6 v6{};
  std::memcpy(&v6, any, sizeof v6);
  constexpr std::size_t kMappedNet = 12;  // of ::ffff:127.0.0.1
  return IN6_IS_ADDR_LOOPBACK(&v6.sin6_addr) != 0 ||
         (IN6_IS_ADDR_V4MAPPED(&v6.sin6_addr) != 0 &&
          v6.sin6_addr.s6_addr[kMappedNet] == kLoopbackNet);
}

std::string toText(const ListenAddress& address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (address.storage.ss_family == AF_UNIX) return pathOf(address);
  if (address.storage.ss_family == AF_INET6) {
    const auto v6 = loaded<sockaddr_in6>(address);
    inet_ntop(AF_INET6, &v6.sin6_addr, text.data(), text.size());
    return fmt::format("[{}]:{}", text.data(), ntohs(v6.sin6_port));
  }
  const auto v4 = loaded<sockaddr_in>(address);
  inet_ntop(AF_INET, &v4.sin_addr, text.data(), text.size());
  return fmt::format("{}:{}", text.data(), ntohs(v4.sin_port));
}

}  // namespace pleinair::app
