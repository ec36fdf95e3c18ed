#include <cstdio>
#include <string>

#include <spdlog/spdlog.h>

#include "firmware_app/commands/commands.h"
#include "firmware_app/config/requested_parts.h"

namespace pleinair::app {

int printConfiguration(const ConfigOptions& options) {
  const Configuration configuration(options.configuration);
  const auto which = options.givenOnly ? config::Printed::kGiven : config::Printed::kAll;
  const std::string text = configuration.toToml(which);
  // Devices may be another machine's, or not plugged in yet: `pleinair doctor` judges those.
  for (const doctor::RequestedPart& part : requestedParts(configuration)) {
    if (part.problem && !part.isDevice) spdlog::warn("{}", part.problem->message());
  }
  // Whether it arrived is looked at once, at the program's end.
  std::fputs(text.c_str(), stdout);
  return 0;
}

}  // namespace pleinair::app
