#include "firmware_app/status_server/status_server.h"

#include <algorithm>
#include <cerrno>
#include <cstdarg>  // microhttpd.h needs it
#include <exception>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <microhttpd.h>
#include <netinet/in.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include "firmware_app/status_server/listen_address.h"
#include "hal/file_descriptor.h"

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

namespace {

// Bounds of what clients may take.
constexpr unsigned kSilentSeconds = 5;
constexpr std::size_t kConnectionBytes = 8192;  // a request's, and what it is answered with beyond
                                                // its page
constexpr std::size_t kMaxConnections = 16;
constexpr unsigned kConnectionLimit = 24;  // with those that are being closed
constexpr int kBacklog = 16;

struct DaemonDeleter {
  void operator()(MHD_Daemon* daemon) const { MHD_stop_daemon(daemon); }
};
struct ResponseDeleter {
  void operator()(MHD_Response* response) const { MHD_destroy_response(response); }
};
using Daemon = std::unique_ptr<MHD_Daemon, DaemonDeleter>;
using Response = std::unique_ptr<MHD_Response, ResponseDeleter>;

struct Answer {
  unsigned status = MHD_HTTP_OK;
  std::string type = "text/plain; charset=utf-8";
  std::string body;
};

Answer answerTo(const StatusPages& pages, std::string_view method, std::string_view page) {
  const bool isKnown = page == "/status" || page == "/metrics" || page == "/healthz";
  if (!isKnown) return {.status = MHD_HTTP_NOT_FOUND, .body = "try /status, /metrics, /healthz\n"};
  if (method != MHD_HTTP_METHOD_GET && method != MHD_HTTP_METHOD_HEAD) {
    return {.status = MHD_HTTP_METHOD_NOT_ALLOWED, .body = "GET only\n"};
  }
  try {
    if (page == "/status") return {.type = "application/json", .body = pages.json()};
    if (page == "/metrics") {
      return {.type = "text/plain; version=0.0.4; charset=utf-8", .body = pages.metrics()};
    }
    if (pages.healthy()) return {.body = "ok\n"};
    return {.status = MHD_HTTP_SERVICE_UNAVAILABLE, .body = "no pictures are shown\n"};
  } catch (const std::exception& error) {
    spdlog::warn("status: {}: {}", page, error.what());
    return {.status = MHD_HTTP_INTERNAL_SERVER_ERROR, .body = "the page cannot be made\n"};
  }
}

MHD_Result send(MHD_Connection* connection, const Answer& answer) {
  // MHD copies it and does not write there.
  void* body = const_cast<char*>(answer.body.data());  // NOLINT(*-const-cast)
  const Response response(
      MHD_create_response_from_buffer(answer.body.size(), body, MHD_RESPMEM_MUST_COPY));
  if (!response) return MHD_NO;
  MHD_add_response_header(response.get(), MHD_HTTP_HEADER_CONTENT_TYPE, answer.type.c_str());
  MHD_add_response_header(response.get(), MHD_HTTP_HEADER_CACHE_CONTROL, "no-store");
  MHD_add_response_header(response.get(), MHD_HTTP_HEADER_CONNECTION, "close");
  if (answer.status == MHD_HTTP_METHOD_NOT_ALLOWED) {
    MHD_add_response_header(response.get(), MHD_HTTP_HEADER_ALLOW, "GET, HEAD");
  }
  return MHD_queue_response(connection, answer.status, response.get());
}

hal::Failure cannotListen(const std::string& listen, int errnoValue) {
  hal::Error error =
      hal::errnoError("status.listen", fmt::format("cannot listen at {}", listen), errnoValue);
  if (errnoValue == EADDRINUSE) {
    error.kind = hal::ErrorKind::kBusy;
    error.remedy = "give another port; `ss -tlnp` lists who has which";
  } else if (errnoValue == EADDRNOTAVAIL || errnoValue == EAFNOSUPPORT) {
    error.kind = hal::ErrorKind::kInvalidArgument;
    error.remedy = "give an address of this machine (`ip address` lists them), or 127.0.0.1";
  } else if (errnoValue == EACCES) {
    error.remedy = "give a port from 1024";
  }
  return hal::Failure(std::move(error));
}

void listenAt(int socket, const ListenAddress& address, const std::string& listen) {
  const int on = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (address.storage.ss_family == AF_INET6) {
    setsockopt(socket, IPPROTO_IPV6, IPV6_V6ONLY, &on, sizeof on);
  }
  const auto* where = reinterpret_cast<const sockaddr*>(&address.storage);  // NOLINT(*-cast)
  if (bind(socket, where, address.length) != 0 || ::listen(socket, kBacklog) != 0) {
    throw cannotListen(listen, errno);
  }
}

std::string boundTo(int socket) {
  ListenAddress address{.length = sizeof(sockaddr_storage)};
  getsockname(socket, reinterpret_cast<sockaddr*>(&address.storage),  // NOLINT(*-cast)
              &address.length);
  return toText(address);
}

class MicroHttpServer final : public StatusServer {
 public:
  MicroHttpServer(const std::string& listen, const ListenAddress& address, StatusPages pages)
      : pages_(std::move(pages)) {
    hal::FileDescriptor socket(::socket(address.storage.ss_family, SOCK_STREAM | SOCK_CLOEXEC, 0));
    if (!socket) throw cannotListen(listen, errno);
    listenAt(socket.get(), address, listen);
    address_ = boundTo(socket.get());
    daemon_.reset(
        MHD_start_daemon(MHD_USE_AUTO_INTERNAL_THREAD, 0, nullptr, nullptr,
                         &MicroHttpServer::answer, this, MHD_OPTION_LISTEN_SOCKET, socket.get(),  //
                         MHD_OPTION_CONNECTION_LIMIT, kConnectionLimit,                           //
                         MHD_OPTION_CONNECTION_TIMEOUT, kSilentSeconds,                           //
                         MHD_OPTION_CONNECTION_MEMORY_LIMIT, kConnectionBytes,                    //
                         MHD_OPTION_NOTIFY_CONNECTION, &MicroHttpServer::noteConnection, this,    //
                         MHD_OPTION_END));
    if (!daemon_) throw cannotListen(listen, errno);
    socket.release();  // the daemon's now
    spdlog::info("status: http://{0}/status, /metrics and /healthz", address_);
  }

  const std::string& address() const override { return address_; }

 private:
  static MHD_Result answer(void* self, MHD_Connection* connection, const char* page,
                           const char* method, const char*, const char*, std::size_t*, void**) {
    // Before any body is read: no page has use for one.
    return send(connection, answerTo(static_cast<MicroHttpServer*>(self)->pages_, method, page));
  }

  static void noteConnection(void* self, MHD_Connection* connection, void**,
                             MHD_ConnectionNotificationCode what) {
    OpenConnections& open = static_cast<MicroHttpServer*>(self)->connections_;
    const int socket =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD)->connect_fd;
    if (what == MHD_CONNECTION_NOTIFY_STARTED) {
      open.opened(socket);
    } else {
      open.closed(socket);
    }
  }

  StatusPages pages_;
  std::string address_;
  OpenConnections connections_{kMaxConnections};
  Daemon daemon_;  ///< last: its thread uses the rest
};

}  // namespace

std::unique_ptr<StatusServer> startStatusServer(const std::string& listen, StatusPages pages) {
  const std::optional<ListenAddress> address = hal::orThrow(parseListen(listen));
  if (!address) return nullptr;
  return std::make_unique<MicroHttpServer>(listen, *address, std::move(pages));
}

}  // namespace pleinair::app
