#pragma once

#include "config/config_error.h"
#include "tests/fuzz/fuzz_target.h"

namespace pleinair::fuzz {

/// Runs `task`. A configuration error must be one line; any other exception is a finding.
template <class Task>
void expectConfigErrors(Task task) {
  try {
    task();
  } catch (const config::ConfigError& error) {
    expectOneLine(error.what());
  }
}

}  // namespace pleinair::fuzz
