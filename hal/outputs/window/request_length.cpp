// A connection to an X server that is gone has no greatest length of a request: XCB answers 0.
// Mesa's software renderers (platform_x11.c of EGL, at least up to 22.3) send pictures in parts of
// that length, and never come to an end then. This function takes the place of XCB's in the program
// (CMakeLists.txt exports it) and answers the length that every server has; requests to a
// connection that is broken are dropped by XCB anyway.
#include <cstdint>

#include <dlfcn.h>

struct xcb_connection_t;

namespace pleinair::hal::window {
namespace {

/// In units of 4 bytes, as the X protocol counts without the extension BIG-REQUESTS.
constexpr std::uint32_t kOfEveryServer = 65'535;

using Function = std::uint32_t (*)(xcb_connection_t*);

/// XCB's own; null where the library is not loaded, so that nobody can have a connection.
Function original() {
  static const auto kFunction = [] {
    void* const library = dlopen("libxcb.so.1", RTLD_LAZY | RTLD_NOLOAD);
    void* const symbol =
        library == nullptr ? nullptr : dlsym(library, "xcb_get_maximum_request_length");
    return reinterpret_cast<Function>(symbol);
  }();
  return kFunction;
}

}  // namespace
}  // namespace pleinair::hal::window

// NOLINTBEGIN(readability-identifier-naming): the name is XCB's
extern "C" {
[[gnu::visibility("default")]] std::uint32_t xcb_get_maximum_request_length(
    xcb_connection_t* connection);

std::uint32_t xcb_get_maximum_request_length(xcb_connection_t* connection) {
  using namespace pleinair::hal::window;
  const Function function = original();
  const std::uint32_t length = function == nullptr ? 0 : function(connection);
  return length == 0 ? kOfEveryServer : length;
}
}
// NOLINTEND(readability-identifier-naming)
