#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <sys/socket.h>

#include "hal/error.h"

namespace pleinair::app {

inline constexpr std::string_view kNoServer = "off";
inline constexpr std::string_view kAllowedListen = "off, or ADDRESS:PORT such as 127.0.0.1:9117";

/// Where a server listens: an address in numbers and a port; 0: any that is free.
struct ListenAddress {
  sockaddr_storage storage{};
  socklen_t length = 0;
};

/// "127.0.0.1:9117", "0.0.0.0:9117", "[::1]:9117"; nothing for "off". Errors: kInvalidArgument.
hal::Result<std::optional<ListenAddress>> parseListen(const std::string& text);

/// Whether it is this machine's own (127.0.0.0/8, ::1), or of a local socket.
bool isLoopback(const sockaddr* address);

/// As parseListen() reads it.
std::string toText(const ListenAddress& address);

}  // namespace pleinair::app
