#pragma once

#include <string>

#include "config/config_error.h"

namespace pleinair::config {

/// The message of the ConfigError that `action` throws; "(nothing thrown)" if none.
template <class Action>
std::string thrownBy(const Action& action) {
  try {
    action();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "(nothing thrown)";
}

}  // namespace pleinair::config
