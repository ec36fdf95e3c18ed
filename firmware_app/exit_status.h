#pragma once

#include <exception>

#include "hal/error.h"

namespace pleinair::app {

/// What the program exits with.
enum class ExitStatus {
  kSuccess = 0,
  kInternal = 1,  ///< internal error, or a device's
  kUsage = 2,     ///< arguments, configuration, input or a full disk: what the caller can mend
};

ExitStatus exitStatusOf(const hal::Error& error);

/// Prints the exception as one line on standard error. To be called in a catch block.
ExitStatus reportCurrentException();

}  // namespace pleinair::app
