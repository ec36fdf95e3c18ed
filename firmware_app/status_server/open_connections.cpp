#include "firmware_app/status_server/open_connections.h"

#include <algorithm>

#include <sys/socket.h>

namespace pleinair::app {

void OpenConnections::opened(int socket) {
  connections_.push_back({.socket = socket});
  const auto live =
      static_cast<std::size_t>(std::ranges::count(connections_, false, &Connection::isEnding));
  if (live <= most_) return;
  const auto oldest = std::ranges::find(connections_, false, &Connection::isEnding);
  oldest->isEnding = true;
  shutdown(oldest->socket, SHUT_RDWR);
}

void OpenConnections::closed(int socket) {
  std::erase_if(connections_, [&](const Connection& each) { return each.socket == socket; });
}

}  // namespace pleinair::app
