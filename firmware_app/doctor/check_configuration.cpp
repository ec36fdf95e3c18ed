#include <fmt/format.h>

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

std::vector<Finding> checkRequested(const Probes& probes) {
  std::vector<Finding> findings;
  for (const RequestedPart& part : probes.requested()) {
    Finding finding{.check = "requested " + part.part, .text = part.value};
    if (part.problem) {
      finding.verdict = part.isChosen ? Verdict::kWrong : Verdict::kWarning;
      const hal::Error& problem = *part.problem;
      finding.text = problem.subject.empty() || problem.subject == "configuration"
                         ? problem.problem
                         : fmt::format("{}: {}", problem.subject, problem.problem);
      finding.remedy = problem.remedy.empty()
                           ? "correct it; `pleinair config` tells where it is set"
                           : problem.remedy;
    }
    findings.push_back(std::move(finding));
  }
  return findings;
}

}  // namespace pleinair::app::doctor
