#include "firmware_app/status_server/status_server.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdarg>  // microhttpd.h needs it
#include <exception>
#include <optional>
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

constexpr std::string_view kCommandPage = "/procedure";
constexpr std::array<std::string_view, 5> kPages = {"/", "/painting.jpg", "/status", "/metrics",
                                                    "/healthz"};

/// Precondition: the page is one of kPages.
Answer pageOf(const StatusPages& pages, std::string_view page) {
  if (page == "/") return {.type = "text/html; charset=utf-8", .body = pages.page()};
  if (page == "/painting.jpg") {
    std::string picture = pages.picture();
    if (picture.empty()) return {.status = MHD_HTTP_NOT_FOUND, .body = "there is none yet\n"};
    return {.type = "image/jpeg", .body = std::move(picture)};
  }
  if (page == "/status") return {.type = "application/json", .body = pages.json()};
  if (page == "/metrics") {
    return {.type = "text/plain; version=0.0.4; charset=utf-8", .body = pages.metrics()};
  }
  if (pages.healthy()) return {.body = "ok\n"};
  return {.status = MHD_HTTP_SERVICE_UNAVAILABLE, .body = "no pictures are shown\n"};
}

Answer answerTo(const StatusPages& pages, std::string_view method, std::string_view page) {
  if (std::ranges::find(kPages, page) == kPages.end()) {
    return {.status = MHD_HTTP_NOT_FOUND, .body = "try /, /status, /metrics, /healthz\n"};
  }
  if (method != MHD_HTTP_METHOD_GET && method != MHD_HTTP_METHOD_HEAD) {
    return {.status = MHD_HTTP_METHOD_NOT_ALLOWED, .body = "GET only\n"};
  }
  try {
    return pageOf(pages, page);
  } catch (const std::exception& error) {
    spdlog::warn("status: {}: {}", page, error.what());
    return {.status = MHD_HTTP_INTERNAL_SERVER_ERROR, .body = "the page cannot be made\n"};
  }
}

/// A request with a body, between MHD's calls.
struct CommandRequest {
  std::string text;
  bool isTooLong = false;
};

bool isLoopbackPeer(MHD_Connection* connection) {
  const MHD_ConnectionInfo* info =
      MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CLIENT_ADDRESS);
  return info != nullptr && info->client_addr != nullptr && isLoopback(info->client_addr);
}

/// In a time that does not tell how much is right.
bool isEqual(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0U : 1U;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  }
  return difference == 0;
}

std::string_view headerOf(MHD_Connection* connection, const char* name) {
  const char* value = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, name);
  return value == nullptr ? std::string_view() : value;
}

/// Why a client may send no command; nothing where it may.
std::optional<Answer> refusalOf(const StatusCommands& commands, MHD_Connection* connection,
                                std::string_view method) {
  if (method != MHD_HTTP_METHOD_POST) {
    return Answer{.status = MHD_HTTP_METHOD_NOT_ALLOWED, .body = "POST only\n"};
  }
  const bool isForeign =
      MHD_lookup_connection_value(connection, MHD_HEADER_KIND, MHD_HTTP_HEADER_ORIGIN) != nullptr;
  if (isForeign || !isLoopbackPeer(connection)) {
    return Answer{.status = MHD_HTTP_FORBIDDEN, .body = "commands come from this machine alone\n"};
  }
  constexpr std::string_view kScheme = "Bearer ";
  std::string_view given = headerOf(connection, MHD_HTTP_HEADER_AUTHORIZATION);
  const bool hasScheme = given.starts_with(kScheme);
  given.remove_prefix(hasScheme ? kScheme.size() : 0);
  if (!hasScheme || !isEqual(given, commands.token)) {
    return Answer{.status = MHD_HTTP_UNAUTHORIZED, .body = "the token is missing or wrong\n"};
  }
  return std::nullopt;
}

Answer answerTo(const StatusCommands& commands, const CommandRequest& request) {
  if (request.isTooLong) {
    return {.status = MHD_HTTP_CONTENT_TOO_LARGE, .body = "a command is a line of text\n"};
  }
  const hal::Result<void> taken = commands.take(request.text);
  if (taken) return {.status = MHD_HTTP_ACCEPTED, .body = "taken\n"};
  const bool isBusy = taken.error().kind == hal::ErrorKind::kBusy;
  return {
      .status = static_cast<unsigned>(isBusy ? MHD_HTTP_SERVICE_UNAVAILABLE : MHD_HTTP_BAD_REQUEST),
      .body = taken.error().message() + "\n"};
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
    MHD_add_response_header(response.get(), MHD_HTTP_HEADER_ALLOW,
                            answer.body.starts_with("POST") ? "POST" : "GET, HEAD");
  }
  if (answer.status == MHD_HTTP_UNAUTHORIZED) {
    MHD_add_response_header(response.get(), MHD_HTTP_HEADER_WWW_AUTHENTICATE, "Bearer");
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

hal::FileDescriptor listenAt(const ListenAddress& address, const std::string& listen) {
  hal::FileDescriptor socket(::socket(address.storage.ss_family, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (!socket) throw cannotListen(listen, errno);
  const int on = 1;
  setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (address.storage.ss_family == AF_INET6) {
    setsockopt(socket.get(), IPPROTO_IPV6, IPV6_V6ONLY, &on, sizeof on);
  }
  const auto* where = reinterpret_cast<const sockaddr*>(&address.storage);  // NOLINT(*-cast)
  if (bind(socket.get(), where, address.length) != 0 || ::listen(socket.get(), kBacklog) != 0) {
    throw cannotListen(listen, errno);
  }
  return socket;
}

std::string boundTo(int socket) {
  ListenAddress address{.length = sizeof(sockaddr_storage)};
  getsockname(socket, reinterpret_cast<sockaddr*>(&address.storage),  // NOLINT(*-cast)
              &address.length);
  return toText(address);
}

class MicroHttpServer final : public StatusServer {
 public:
  /// `socket` listens; `listen` names it in errors.
  MicroHttpServer(const std::string& listen, hal::FileDescriptor socket, StatusPages pages)
      : pages_(std::move(pages)), address_(boundTo(socket.get())) {
    daemon_.reset(
        MHD_start_daemon(MHD_USE_AUTO_INTERNAL_THREAD, 0, nullptr, nullptr,
                         &MicroHttpServer::answer, this, MHD_OPTION_LISTEN_SOCKET, socket.get(),  //
                         MHD_OPTION_CONNECTION_LIMIT, kConnectionLimit,                           //
                         MHD_OPTION_CONNECTION_TIMEOUT, kSilentSeconds,                           //
                         MHD_OPTION_CONNECTION_MEMORY_LIMIT, kConnectionBytes,                    //
                         MHD_OPTION_NOTIFY_COMPLETED, &MicroHttpServer::forget, nullptr,          //
                         MHD_OPTION_NOTIFY_CONNECTION, &MicroHttpServer::noteConnection, this,    //
                         MHD_OPTION_END));
    if (!daemon_) throw cannotListen(listen, errno);
    socket.release();  // the daemon's now
  }

  const std::string& address() const override { return address_; }

 private:
  static MHD_Result answer(void* self, MHD_Connection* connection, const char* page,
                           const char* method, const char*, const char* body, std::size_t* bytes,
                           void** context) {
    const StatusPages& pages = static_cast<MicroHttpServer*>(self)->pages_;
    if (page == kCommandPage && !pages.commands.token.empty()) {
      return takeCommand(pages.commands, connection, method, {body, *bytes}, bytes, context);
    }
    // Before any body is read: no page has use for one.
    return send(connection, answerTo(pages, method, page));
  }

  /// Called once without a body, then with each piece of it, and at last without one again.
  static MHD_Result takeCommand(const StatusCommands& commands, MHD_Connection* connection,
                                std::string_view method, std::string_view piece, std::size_t* bytes,
                                void** context) {
    if (*context == nullptr) {
      if (const auto refusal = refusalOf(commands, connection, method)) {
        return send(connection, *refusal);
      }
      *context = std::make_unique<CommandRequest>().release();  // forget() deletes it
      return MHD_YES;
    }
    auto& request = *static_cast<CommandRequest*>(*context);
    if (piece.empty()) return send(connection, answerTo(commands, request));
    *bytes = 0;
    request.isTooLong =
        request.isTooLong || request.text.size() + piece.size() > StatusCommands::kMaxCommandBytes;
    if (!request.isTooLong) request.text += piece;
    return MHD_YES;
  }

  static void forget(void*, MHD_Connection*, void** context, MHD_RequestTerminationCode) {
    const std::unique_ptr<CommandRequest> request(static_cast<CommandRequest*>(*context));
    *context = nullptr;
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
  return std::make_unique<MicroHttpServer>(listen, listenAt(*address, listen), std::move(pages));
}

std::unique_ptr<StatusServer> startStatusServer(hal::FileDescriptor listening, StatusPages pages) {
  return std::make_unique<MicroHttpServer>("the passed socket", std::move(listening),
                                           std::move(pages));
}

}  // namespace pleinair::app
