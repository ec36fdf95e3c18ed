#pragma once

#include <string_view>

#include "hal/error.h"

namespace pleinair::app {

/// What the program exits with.
enum class ExitStatus {
  kSuccess = 0,
  kInternal = 1,  ///< internal error, or a device's
  kUsage = 2,     ///< arguments, configuration, input or a full disk: what the caller can fix
};

ExitStatus exitStatusOf(const hal::Error& error);

/// Prints "pleinair: <message>" as one line on standard error, whatever the message quotes.
void printError(std::string_view message);

/// Prints the exception as printError() does. To be called in a catch block.
ExitStatus reportCurrentException();

}  // namespace pleinair::app
