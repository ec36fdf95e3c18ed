#include "pipeline/procedure/step_graph.h"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

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

ConfigError faultAt(const Procedure& procedure, std::size_t step, const std::string& file,
                    std::string problem, std::string allowed) {
  return ConfigError({.file = file,
                      .line = procedure.steps[step].line,
                      .key = fmt::format("step[{}]", step),
                      .problem = std::move(problem),
                      .allowed = std::move(allowed)});
}

/// The parts that are off before each step: on some way there, and on every way there.
struct Removed {
  std::vector<std::set<std::size_t>> onSome;
  std::vector<std::set<std::size_t>> onEvery;
};

std::set<std::size_t> after(const Step& step, std::set<std::size_t> off) {
  for (const std::size_t part : step.fits) off.erase(part);
  off.insert(step.removes.begin(), step.removes.end());
  return off;
}

/// A forward data-flow analysis: unions grow and intersections shrink until nothing changes.
Removed removedBefore(const Procedure& procedure) {
  const std::size_t count = procedure.steps.size();
  Removed removed{.onSome = std::vector<std::set<std::size_t>>(count),
                  .onEvery = std::vector<std::set<std::size_t>>(count)};
  std::vector<bool> isVisited(count, false);
  isVisited[0] = true;
  std::vector<std::size_t> open{0};
  while (!open.empty()) {
    const std::size_t at = open.back();
    open.pop_back();
    const Step& step = procedure.steps[at];
    const std::set<std::size_t> some = after(step, removed.onSome[at]);
    const std::set<std::size_t> every = after(step, removed.onEvery[at]);
    for (const auto& [outcome, next] : step.next) {
      if (next == kEnd) continue;
      std::set<std::size_t> joinedSome = removed.onSome[next];
      joinedSome.insert(some.begin(), some.end());
      std::set<std::size_t> joinedEvery = every;
      // The first step is also reached with every part on.
      if (next == 0) joinedEvery.clear();
      if (isVisited[next]) {
        std::erase_if(joinedEvery,
                      [&](std::size_t part) { return !removed.onEvery[next].contains(part); });
      }
      if (isVisited[next] && joinedSome == removed.onSome[next] &&
          joinedEvery == removed.onEvery[next]) {
        continue;
      }
      isVisited[next] = true;
      removed.onSome[next] = std::move(joinedSome);
      removed.onEvery[next] = std::move(joinedEvery);
      open.push_back(next);
    }
  }
  return removed;
}

/// A goto that leads back to a step whose part is off on every way to the goto. The step itself may
/// be right on the usual way.
void addGotoFaults(const Procedure& procedure, const std::string& file, std::size_t from,
                   const Removed& removed, std::vector<ConfigError>& faults) {
  const std::set<std::size_t> off = after(procedure.steps[from], removed.onEvery[from]);
  for (const auto& [outcome, to] : procedure.steps[from].next) {
    if (to == kEnd || to == from || to == from + 1) continue;
    const Step& step = procedure.steps[to];
    for (const std::size_t part : step.parts) {
      const bool isFitted = std::ranges::find(step.fits, part) != step.fits.end();
      // On every way: told at that step.
      const bool isTold = removed.onEvery[to].contains(part);
      if (isFitted || isTold || !off.contains(part)) continue;
      faults.push_back(
          faultAt(procedure, from, file,
                  fmt::format("\"{}\" leads to \"{}\", whose \"{}\" is off by then",
                              nameOf(outcome), step.id, procedure.model->parts[part].name),
                  "a way on which a step puts the part back, in fits"));
      break;
    }
  }
}

void addPartFaults(const Procedure& procedure, const std::string& file,
                   const std::vector<bool>& isReached, std::vector<ConfigError>& faults) {
  if (!procedure.model) return;
  const Removed removed = removedBefore(procedure);
  const auto nameOfPart = [&](std::size_t part) { return procedure.model->parts[part].name; };
  for (std::size_t i = 0; i < procedure.steps.size(); ++i) {
    if (!isReached[i]) continue;
    addGotoFaults(procedure, file, i, removed, faults);
    const Step& step = procedure.steps[i];
    for (const std::size_t part : step.parts) {
      const bool isFitted = std::ranges::find(step.fits, part) != step.fits.end();
      if (isFitted || !removed.onEvery[i].contains(part)) continue;
      faults.push_back(faultAt(procedure, i, file,
                               fmt::format("shows \"{}\", which is off by then", nameOfPart(part)),
                               "a part that is on, or the part in fits too"));
      break;
    }
    for (const std::size_t part : step.fits) {
      if (removed.onSome[i].contains(part)) continue;
      faults.push_back(faultAt(procedure, i, file,
                               fmt::format("fits \"{}\", which is on already", nameOfPart(part)),
                               "a part that an earlier step removes"));
      break;
    }
  }
}

}  // namespace

std::vector<ConfigError> graphFaults(const Procedure& procedure, const std::string& file) {
  std::vector<ConfigError> faults;
  if (procedure.steps.empty()) return faults;
  const std::vector<bool> isReached = reachedFromStart(procedure);
  const std::vector<bool> leads = leadToEnd(procedure);
  std::vector<std::string> caught;
  std::optional<std::size_t> firstCaught;
  for (std::size_t i = 0; i < procedure.steps.size(); ++i) {
    if (!isReached[i]) {
      faults.push_back(faultAt(procedure, i, file,
                               fmt::format("\"{}\" is never reached", procedure.steps[i].id),
                               "a next or goto that leads to it"));
    } else if (!leads[i]) {
      caught.push_back(procedure.steps[i].id);
      if (!firstCaught) firstCaught = i;
    }
  }
  if (firstCaught) {
    faults.push_back(faultAt(procedure, *firstCaught, file,
                             "no way leads from here to the end: " + config::listText(caught),
                             "a next or goto out of these steps, such as \"end\""));
  }
  addPartFaults(procedure, file, isReached, faults);
  return faults;
}

}  // namespace pleinair::procedure
