#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hal/error.h"
#include "hal/file_descriptor.h"

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

/// Commands that clients may POST to /procedure, as text of at most kMaxCommandBytes.
struct StatusCommands {
  static constexpr std::size_t kMaxCommandBytes = 256;
  std::string token;  ///< clients send it as "Authorization: Bearer TOKEN"; empty: none are taken
  /// Takes the body's text, on the server's thread, without waiting. Errors: kBusy (503), others
  /// (400), with their message.
  std::function<hal::Result<void>(std::string_view text)> take;
};

/// The contents of the status pages. Each function is called on the server's thread for every
/// request, and must neither wait nor use the GPU. If it throws, the answer has status 500.
struct StatusPages {
  std::function<std::string()> page;     ///< /: for people, HTML
  std::function<std::string()> picture;  ///< /painting.jpg: a JPEG; empty (404): there is none yet
  std::function<std::string()> json;     ///< /status
  std::function<std::string()> metrics;  ///< /metrics: Prometheus' text format 0.0.4
  std::function<bool()> healthy;         ///< /healthz: 200, else 503
  StatusCommands commands = {};          ///< /procedure
};

/// A small HTTP server on a thread of its own: GET and HEAD of /, /painting.jpg, /status, /metrics
/// and /healthz; 404 for other pages, 405 for other methods. Where it takes commands, also POST of
/// /procedure: from this machine alone (403), with the token (401) and no Origin, which only a
/// browser sends for a foreign page (403); 202 says that the command was taken, not that it had an
/// effect, which /status shows. Clients can neither hold up the program nor make it
/// grow: requests have at most 8 KiB, a client that is silent for 5 s is dropped, and of more than
/// a few connections the oldest is closed.
class StatusServer {
 public:
  virtual ~StatusServer() = default;  ///< stops; waits for a page that is being made, for no client
  StatusServer() = default;
  StatusServer(const StatusServer&) = delete;
  StatusServer& operator=(const StatusServer&) = delete;

  /// "127.0.0.1:9117", with the port that port 0 was given; of a passed socket also a path.
  virtual const std::string& address() const = 0;
};

/// `listen` is [status]'s: "off", which gives null, or an address and a port (listen_address.h).
/// Says in the log where it listens. Throws hal::Failure: kInvalidArgument (no such address),
/// kBusy (the port is taken), kPermissionDenied, kUnsupported (this build has none), kIo.
std::unique_ptr<StatusServer> startStatusServer(const std::string& listen, StatusPages pages);

/// The same at a socket that listens already, of whatever family: a service manager opened it for a
/// process that has no network itself. Throws hal::Failure: kUnsupported, kIo.
std::unique_ptr<StatusServer> startStatusServer(hal::FileDescriptor listening, StatusPages pages);

}  // namespace pleinair::app
