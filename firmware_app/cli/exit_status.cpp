#include "firmware_app/cli/exit_status.h"

#include <algorithm>
#include <new>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include "config/config_error.h"
#include "firmware_app/cli/memory_limit.h"
#include "firmware_app/cli/standard_streams.h"
#include "firmware_app/service_manager/journal_stream.h"
#include "hal/error.h"

namespace pleinair::app {

void printError(std::string_view message) {
  std::string line(message);
  // Replaces control characters: file names and arguments may contain any.
  std::ranges::replace_if(
      line, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }, '?');
  writeText(stderr,
            fmt::format("{}{}\n", isJournalStream(STDERR_FILENO) ? "<3>" : "pleinair: ", line));
}

ExitStatus exitStatusOf(const hal::Error& error) {
  // For GL errors, only a shader from --shaders is the user's input; all others are the device's.
  const bool isInput =
      error.kind == hal::ErrorKind::kInvalidInput || error.kind == hal::ErrorKind::kNotFound;
  const bool isShader = error.domain == hal::ErrorDomain::kGl && isInput;
  const bool isGpu =
      error.domain == hal::ErrorDomain::kEgl || error.domain == hal::ErrorDomain::kGl;
  if (isGpu && !isShader) return ExitStatus::kInternal;
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
    case hal::ErrorKind::kCancelled:
    case hal::ErrorKind::kIo:
    case hal::ErrorKind::kInternal:
      break;
  }
  return ExitStatus::kInternal;
}

ExitStatus reportCurrentException() {
  try {
    throw;
  } catch (const hal::Failure& error) {
    printError(error.what());
    return exitStatusOf(error.error());
  } catch (const config::ConfigError& error) {
    printError(error.what());
    return ExitStatus::kUsage;
  } catch (const std::bad_alloc&) {
    const std::string limit = memoryLimitText();
    printError(limit.empty() ? "out of memory" : "out of memory: " + limit);
  } catch (const std::exception& error) {
    printError(fmt::format("internal error: {}", error.what()));
  }
  return ExitStatus::kInternal;
}

}  // namespace pleinair::app
