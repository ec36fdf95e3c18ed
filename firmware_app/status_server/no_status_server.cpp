// In place of the status server where the build found no libmicrohttpd.
#include "firmware_app/status_server/listen_address.h"
#include "firmware_app/status_server/status_server.h"

namespace pleinair::app {

std::unique_ptr<StatusServer> startStatusServer(
    const std::string& listen,
    StatusPages /*pages*/) {  // NOLINT(performance-unnecessary-value-param): the server keeps them
  if (!orThrow(parseListen(listen))) return nullptr;
  throw hal::Failure({.kind = hal::ErrorKind::kUnsupported,
                      .subject = "status.listen",
                      .problem = "this build has no status server",
                      .remedy = "install libmicrohttpd-dev and build again, or say \"off\""});
}

}  // namespace pleinair::app
