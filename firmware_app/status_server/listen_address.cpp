#include "firmware_app/status_server/listen_address.h"

#include <array>
#include <charconv>
#include <cstring>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>

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

std::string toText(const ListenAddress& address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
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
