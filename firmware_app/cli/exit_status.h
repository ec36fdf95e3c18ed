#pragma once

#include <string_view>

#include "hal/error.h"

namespace pleinair::app {

/// The exit status of the program.
enum class ExitStatus {
  kSuccess = 0,
  kInternal = 1,  ///< internal error or device failure
  kUsage = 2,     ///< arguments, configuration, input or a full disk: errors that the user can fix
};

ExitStatus exitStatusOf(const hal::Error& error);

/// Prints "pleinair: <message>" as one line on standard error, with control characters replaced.
void printError(std::string_view message);

/// Prints the current exception with printError(). Call it in a catch block.
ExitStatus reportCurrentException();

}  // namespace pleinair::app
