// In place of the status server where the build found no libmicrohttpd.
#include <utility>

#include "firmware_app/status_server/listen_address.h"
#include "firmware_app/status_server/status_server.h"

namespace pleinair::app {

namespace {

[[noreturn]] void refuse(std::string subject) {
  throw hal::Failure({.kind = hal::ErrorKind::kUnsupported,
                      .subject = std::move(subject),
                      .problem = "this build has no status server",
                      .remedy = "install libmicrohttpd-dev and build again, or say \"off\""});
}

}  // namespace

std::unique_ptr<StatusServer> startStatusServer(
    const std::string& listen,
    StatusPages /*pages*/) {  // NOLINT(performance-unnecessary-value-param): the server keeps them
  if (!orThrow(parseListen(listen))) return nullptr;
  refuse("status.listen");
}

std::unique_ptr<StatusServer> startStatusServer(
    hal::FileDescriptor /*listening*/,
    StatusPages /*pages*/) {  // NOLINT(performance-unnecessary-value-param): the server keeps them
  refuse("a socket for the status server");
}

}  // namespace pleinair::app
