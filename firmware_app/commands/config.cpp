#include <cstdio>

#include "firmware_app/commands/commands.h"

namespace pleinair::app {

int printConfiguration(const ConfigOptions& options) {
  const Configuration configuration(options.configuration);
  const auto which = options.givenOnly ? config::Printed::kGiven : config::Printed::kAll;
  // Whether it arrived is looked at once, at the program's end.
  std::fputs(configuration.toToml(which).c_str(), stdout);
  return 0;
}

}  // namespace pleinair::app
