#include "firmware_app/exit_status.h"

#include <new>

#include <fmt/format.h>

#include "config/config_error.h"
#include "hal/error.h"

namespace pleinair::app {
namespace {

void print(const char* message) {
  fmt::print(stderr, "pleinair: {}\n", message);
}

}  // namespace

ExitStatus exitStatusOf(const hal::Error& error) {
  if (error.domain == hal::ErrorDomain::kEgl || error.domain == hal::ErrorDomain::kGl) {
    return ExitStatus::kInternal;
  }
  switch (error.kind) {
    case hal::ErrorKind::kInvalidArgument:
    case hal::ErrorKind::kInvalidInput:
    case hal::ErrorKind::kUnsupported:
    case hal::ErrorKind::kNotFound:
    case hal::ErrorKind::kPermissionDenied:
    case hal::ErrorKind::kNoSpace:
      return ExitStatus::kUsage;
    case hal::ErrorKind::kBusy:
    case hal::ErrorKind::kTimeout:
    case hal::ErrorKind::kDeviceLost:
    case hal::ErrorKind::kIo:
    case hal::ErrorKind::kInternal:
      break;
  }
  return ExitStatus::kInternal;
}

ExitStatus reportCurrentException() {
  try {
    throw;
  } catch (const hal::StartupError& error) {
    print(error.what());
    return exitStatusOf(error.error());
  } catch (const config::ConfigError& error) {
    print(error.what());
    return ExitStatus::kUsage;
  } catch (const std::bad_alloc&) {
    print("out of memory");
  } catch (const std::exception& error) {
    fmt::print(stderr, "pleinair: internal error: {}\n", error.what());
  }
  return ExitStatus::kInternal;
}

}  // namespace pleinair::app
