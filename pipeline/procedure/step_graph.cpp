#include "pipeline/procedure/step_graph.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "config/suggestion.h"

namespace pleinair::procedure {
namespace {

using config::ConfigError;

std::vector<bool> reachedFromStart(const Procedure& procedure) {
  std::vector<bool> isReached(procedure.steps.size(), false);
  std::vector<std::size_t> open{0};
  isReached[0] = true;
  while (!open.empty()) {
    const Step& step = procedure.steps[open.back()];
    open.pop_back();
    for (const auto& [outcome, next] : step.next) {
      if (next == kEnd || isReached[next]) continue;
      isReached[next] = true;
      open.push_back(next);
    }
  }
  return isReached;
}

std::vector<bool> leadToEnd(const Procedure& procedure) {
  std::vector<bool> leads(procedure.steps.size(), false);
  for (bool hasChanged = true; hasChanged;) {
    hasChanged = false;
    for (std::size_t i = procedure.steps.size(); i-- > 0;) {
      if (leads[i]) continue;
      leads[i] = std::ranges::any_of(procedure.steps[i].next, [&](const auto& edge) {
        return edge.second == kEnd || leads[edge.second];
      });
      hasChanged = hasChanged || leads[i];
    }
  }
  return leads;
}

}  // namespace

ConfigError stepFault(const Procedure& procedure, std::size_t step, const std::string& file,
                      std::string problem, std::string allowed) {
  return ConfigError({.file = file,
                      .line = procedure.steps[step].line,
                      .key = fmt::format("step[{}]", step),
                      .problem = std::move(problem),
                      .allowed = std::move(allowed)});
}

std::vector<ConfigError> wayFaults(const Procedure& procedure, const std::string& file) {
  std::vector<ConfigError> faults;
  if (procedure.steps.empty()) return faults;
  const std::vector<bool> isReached = reachedFromStart(procedure);
  const std::vector<bool> leads = leadToEnd(procedure);
  std::vector<std::string> caught;
  std::optional<std::size_t> firstCaught;
  for (std::size_t i = 0; i < procedure.steps.size(); ++i) {
    if (!isReached[i]) {
      faults.push_back(stepFault(procedure, i, file,
                                 fmt::format("\"{}\" is never reached", procedure.steps[i].id),
                                 "a next or goto that leads to it"));
    } else if (!leads[i]) {
      caught.push_back(procedure.steps[i].id);
      if (!firstCaught) firstCaught = i;
    }
  }
  if (firstCaught) {
    faults.push_back(stepFault(procedure, *firstCaught, file,
                               "no way leads from here to the end: " + config::listText(caught),
                               "a next or goto out of these steps, such as \"end\""));
  }
  return faults;
}

}  // namespace pleinair::procedure
