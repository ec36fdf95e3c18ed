#pragma once

#include "config/config_error.h"
#include "tests/fuzz/fuzz_target.h"

namespace pleinair::fuzz {

/// Runs `task`; a configuration error is an answer, of one line, and anything else a finding.
template <class Task>
void expectConfigErrors(Task task) {
  try {
    task();
  } catch (const config::ConfigError& error) {
    expectOneLine(error.what());
  }
}

}  // namespace pleinair::fuzz
