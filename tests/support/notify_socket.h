#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace pleinair::support {

/// The socket at which a service manager listens, in a test's folder.
class NotifySocket {
 public:
  explicit NotifySocket(const std::filesystem::path& path)
      : path_(path.string()), socket_(socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    sockaddr_un here{};
    here.sun_family = AF_UNIX;
    std::strncpy(static_cast<char*>(here.sun_path), path_.c_str(), sizeof here.sun_path - 1);
    if (bind(socket_, reinterpret_cast<const sockaddr*>(&here), sizeof here) != 0) {
      throw std::runtime_error("no socket: " + path_);
    }
  }
  ~NotifySocket() { close(socket_); }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  const std::string& path() const { return path_; }

  /// The messages since the last call, without those that begin with `ignored`.
  std::vector<std::string> take(const std::string& ignored = "STATUS=") {
    std::vector<std::string> messages;
    std::array<char, 4096> text{};
    for (;;) {
      const ssize_t size = recv(socket_, text.data(), text.size(), 0);
      if (size < 0) return messages;
      std::string message(text.data(), static_cast<std::size_t>(size));
      if (!message.starts_with(ignored)) messages.push_back(std::move(message));
    }
  }

 private:
  std::string path_;
  int socket_;
};

}  // namespace pleinair::support
