#pragma once

#include <array>
#include <charconv>
#include <chrono>
#include <stdexcept>
#include <string>
#include <string_view>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace pleinair::app {

/// A raw connection to a server on this machine. Whatever the server does, no call takes longer
/// than ten seconds.
class HttpClient {
 public:
  explicit HttpClient(std::string_view address) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    const timeval limit{.tv_sec = 4, .tv_usec = 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
    const std::string_view digits = address.substr(address.rfind(':') + 1);
    in_port_t port = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), port);
    sockaddr_in there{};
    there.sin_family = AF_INET;
    there.sin_port = htons(port);
    there.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (connect(socket_, reinterpret_cast<const sockaddr*>(&there), sizeof there) != 0) {
      close(socket_);
      throw std::runtime_error("no connection to " + std::string(address));
    }
  }
  ~HttpClient() { close(socket_); }
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;

  /// False where the server has closed.
  bool send(std::string_view text) {
    while (!text.empty()) {
      const ssize_t sent = ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      text.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }

  /// All until the server closes.
  std::string receiveAll() {
    std::string text;
    std::array<char, 4096> part{};
    for (;;) {
      const ssize_t received = recv(socket_, part.data(), part.size(), 0);
      if (received <= 0) return text;
      text.append(part.data(), static_cast<std::size_t>(received));
    }
  }

  /// One whole exchange over a connection of its own.
  static std::string request(std::string_view address, std::string_view firstLine) {
    HttpClient client(address);
    client.send(std::string(firstLine) + " HTTP/1.1\r\nHost: here\r\n\r\n");
    return client.receiveAll();
  }

 private:
  int socket_;
};

}  // namespace pleinair::app
