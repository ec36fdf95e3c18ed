#pragma once

#include <cstddef>
#include <vector>

namespace pleinair::app {

/// The sockets that clients have open, oldest first. So that slow ones keep nobody out, the oldest
/// makes room for the newest. One thread.
class OpenConnections {
 public:
  explicit OpenConnections(std::size_t most) : most_(most) {}

  /// Shuts the oldest down where there are too many: its closed() comes later.
  void opened(int socket);
  void closed(int socket);

 private:
  struct Connection {
    int socket = -1;
    bool isEnding = false;
  };
  std::size_t most_;
  std::vector<Connection> connections_;
};

}  // namespace pleinair::app
