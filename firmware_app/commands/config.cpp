#include <cstdio>

#include "firmware_app/commands/commands.h"

namespace pleinair::app {

int printConfiguration(const ConfigOptions& options) {
  const Configuration configuration(options.configuration);
  const auto which = options.givenOnly ? config::Printed::kGiven : config::Printed::kAll;
  // Write errors are checked once, at the end of the program.
  std::fputs(configuration.toToml(which).c_str(), stdout);
  return 0;
}

}  // namespace pleinair::app
