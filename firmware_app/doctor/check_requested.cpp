#include <fmt/format.h>

#include "firmware_app/doctor/checks.h"

namespace pleinair::app::doctor {

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
