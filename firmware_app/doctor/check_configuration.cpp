#include "firmware_app/doctor/checks.h"

namespace pleinair::app::doctor {

Finding checkConfiguration(const Probes& probes) {
  const std::optional<std::string> error = probes.configurationError();
  if (!error) return {.check = "configuration", .text = "sound"};
  return {.check = "configuration",
          .verdict = Verdict::kWrong,
          .text = *error,
          .remedy = "correct it; `pleinair config` checks it and prints what is in force"};
}

}  // namespace pleinair::app::doctor
