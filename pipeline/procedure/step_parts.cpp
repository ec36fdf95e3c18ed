#include "pipeline/procedure/step_parts.h"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "config/suggestion.h"
#include "pipeline/procedure/node_names.h"
#include "pipeline/procedure/step_graph.h"

namespace pleinair::procedure {
namespace {

bool contains(const std::vector<std::size_t>& parts, std::size_t part) {
  return std::ranges::find(parts, part) != parts.end();
}

/// What ways to a place leave a part as. Both, where ways differ.
struct PartStates {
  bool isOn = false;
  bool isOff = false;
  bool operator==(const PartStates&) const = default;
};

PartStates after(const Step& step, std::size_t part, PartStates before) {
  if (contains(step.removes, part)) return {.isOff = true};
  if (contains(step.fits, part)) return {.isOn = true};
  return before;
}

/// Whether a way leads over the edge: a step that is done again is none that was left.
bool isWay(std::size_t from, std::size_t to) {
  return to != kEnd && to != from;
}

/// The states of a part before each step: forward data flow, exact for one part.
std::vector<PartStates> statesBefore(const Procedure& procedure, std::size_t part) {
  std::vector<PartStates> before(procedure.steps.size());
  before.front().isOn = true;
  std::vector<std::size_t> open{0};
  while (!open.empty()) {
    const std::size_t at = open.back();
    open.pop_back();
    const PartStates left = after(procedure.steps[at], part, before[at]);
    for (const auto& [outcome, next] : procedure.steps[at].next) {
      if (!isWay(at, next)) continue;
      const PartStates joined{.isOn = before[next].isOn || left.isOn,
                              .isOff = before[next].isOff || left.isOff};
      if (joined == before[next]) continue;
      before[next] = joined;
      open.push_back(next);
    }
  }
  return before;
}

/// What a step does with a part, which has to be off before it is fitted, and else on.
enum class PartUse { kNone, kShown, kRemoved, kFitted };

PartUse useOf(const Step& step, std::size_t part) {
  if (contains(step.fits, part)) return PartUse::kFitted;
  if (contains(step.removes, part)) return PartUse::kRemoved;
  return contains(step.parts, part) ? PartUse::kShown : PartUse::kNone;
}

bool isRight(PartUse use, PartStates states) {
  if (use == PartUse::kNone) return false;
  return use == PartUse::kFitted ? states.isOff : states.isOn;
}

bool isWrong(PartUse use, PartStates states) {
  if (use == PartUse::kNone) return false;
  return use == PartUse::kFitted ? states.isOn : states.isOff;
}

/// Parts that are moved by some step, rising.
std::set<std::size_t> movedParts(const Procedure& procedure) {
  std::set<std::size_t> parts;
  for (const Step& step : procedure.steps) {
    parts.insert(step.removes.begin(), step.removes.end());
    parts.insert(step.fits.begin(), step.fits.end());
  }
  return parts;
}

/// The steps that are the first to use a part wrongly on the ways from a step.
struct WrongUses {
  std::vector<std::size_t> steps;
  bool isAvoidable = false;  ///< another way uses it rightly, or not at all
};

/// `states`: on or off, before the step `from`.
WrongUses wrongUses(const Procedure& procedure, std::size_t part, std::size_t from,
                    PartStates states) {
  WrongUses found;
  std::vector<bool> isSeen(procedure.steps.size(), false);
  std::vector<std::size_t> open{from};
  isSeen[from] = true;
  while (!open.empty()) {
    const std::size_t at = open.back();
    open.pop_back();
    const PartUse use = useOf(procedure.steps[at], part);
    if (isWrong(use, states)) {
      found.steps.push_back(at);
      continue;
    }
    if (use != PartUse::kNone) {
      found.isAvoidable = true;
      continue;
    }
    for (const auto& [outcome, next] : procedure.steps[at].next) {
      if (next == kEnd) found.isAvoidable = true;
      if (!isWay(at, next) || isSeen[next]) continue;
      isSeen[next] = true;
      open.push_back(next);
    }
  }
  return found;
}

/// Gathers the parts of each mistake, so that a row of bolts is one.
class PartFaults {
 public:
  PartFaults(const Procedure& procedure, const std::string& file)
      : procedure_(procedure), file_(file) {}

  void look(std::size_t part) {
    const std::vector<PartStates> before = statesBefore(procedure_, part);
    const std::set<std::size_t> told = lookAtWays(part, before);
    for (std::size_t at = 0; at < before.size(); ++at) {
      const PartUse use = useOf(procedure_.steps[at], part);
      if (!isWrong(use, before[at])) continue;
      if (!isRight(use, before[at])) {
        onEveryWay_[{at, use}].push_back(part);
      } else if (!told.contains(at)) {
        onSomeWay_[{at, use}].push_back(part);
      }
    }
  }

  PartFindings findings() const {
    PartFindings found;
    for (const auto& [key, parts] : onEveryWay_) {
      const bool isFitted = key.second == PartUse::kFitted;
      found.faults.push_back(
          stepFault(procedure_, key.first, file_,
                    fmt::format("{} {}, {}", verbOf(key.second), quotedNames(parts),
                                isFitted ? "on already" : "off by then"),
                    isFitted ? "a part that an earlier step removes"
                             : "a part that is on, or the part in fits too"));
    }
    for (const auto& [key, parts] : byEdge_) {
      auto& list = key.isSure ? found.faults : found.warnings;
      list.push_back(edgeFault(key, parts));
    }
    for (const auto& [key, parts] : onSomeWay_) {
      const bool isFitted = key.second == PartUse::kFitted;
      found.warnings.push_back(
          stepFault(procedure_, key.first, file_,
                    fmt::format("{} {}, {} on some ways there", verbOf(key.second),
                                quotedNames(parts), isFitted ? "on already" : "off by then"),
                    "a step of its own for each way"));
    }
    return found;
  }

 private:
  struct Edge {
    std::size_t from = 0;
    Outcome outcome = Outcome::kDone;
    std::size_t to = 0;
    std::size_t user = 0;  ///< the step that uses the part wrongly: `to`, or one after it
    bool isSure = true;    ///< or it may be meant
    bool operator<(const Edge& other) const {
      return std::tie(from, outcome, to, user, isSure) <
             std::tie(other.from, other.outcome, other.to, other.user, other.isSure);
    }
  };

  /// Where ways meet that leave the part on and off, an outcome may lead to a wrong use. Returns
  /// the steps of such uses.
  std::set<std::size_t> lookAtWays(std::size_t part, const std::vector<PartStates>& before) {
    std::set<std::size_t> told;
    for (std::size_t from = 0; from < before.size(); ++from) {
      const PartStates left = after(procedure_.steps[from], part, before[from]);
      if (left.isOn == left.isOff) continue;
      for (const auto& [outcome, to] : procedure_.steps[from].next) {
        if (!isWay(from, to) || before[to].isOn != before[to].isOff) continue;
        const WrongUses wrong = wrongUses(procedure_, part, to, left);
        for (const std::size_t user : wrong.steps) {
          // On the usual way, a step may show what another way leaves in its place.
          const bool mayBeMeant =
              to == from + 1 && useOf(procedure_.steps[user], part) == PartUse::kShown;
          byEdge_[{from, outcome, to, user, !wrong.isAvoidable && !mayBeMeant}].push_back(part);
          told.insert(user);
        }
      }
    }
    return told;
  }

  config::ConfigError edgeFault(const Edge& edge, const std::vector<std::size_t>& parts) const {
    const PartUse use = useOf(procedure_.steps[edge.user], parts.front());
    const bool isFitted = use == PartUse::kFitted;
    const std::string leads =
        edge.to == edge.user ? fmt::format("\"{}\"", procedure_.steps[edge.to].id)
                             : fmt::format("\"{}\", and on to \"{}\"", procedure_.steps[edge.to].id,
                                           procedure_.steps[edge.user].id);
    return stepFault(
        procedure_, edge.from, file_,
        fmt::format("\"{}\" leads to {}, which {} {}, {}", nameOf(edge.outcome), leads, verbOf(use),
                    quotedNames(parts), isFitted ? "on already" : "off by then"),
        isFitted ? "a way on which a step removes the part"
                 : "a way on which a step puts the part back, in fits");
  }

  static std::string_view verbOf(PartUse use) {
    if (use == PartUse::kFitted) return "fits";
    return use == PartUse::kRemoved ? "removes" : "shows";
  }

  std::string quotedNames(const std::vector<std::size_t>& parts) const {
    constexpr std::size_t kShown = 4;
    std::vector<std::string> names = namesOfParts(*procedure_.model, parts);
    const std::size_t shown = std::min(names.size(), kShown);
    const std::size_t more = names.size() - shown;
    names.resize(shown);
    for (std::string& name : names) name = config::quoted(name);
    const std::string list = config::listText(names);
    return more == 0 ? list : fmt::format("{} and {} more", list, more);
  }

  const Procedure& procedure_;
  const std::string& file_;
  std::map<std::pair<std::size_t, PartUse>, std::vector<std::size_t>> onEveryWay_;
  std::map<std::pair<std::size_t, PartUse>, std::vector<std::size_t>> onSomeWay_;
  std::map<Edge, std::vector<std::size_t>> byEdge_;
};

}  // namespace

PartFindings partFindings(const Procedure& procedure, const std::string& file) {
  if (procedure.steps.empty()) return {};
  PartFaults parts(procedure, file);
  for (const std::size_t part : movedParts(procedure)) parts.look(part);
  return parts.findings();
}

PartsLeftOff partsLeftOff(const Procedure& procedure) {
  PartsLeftOff left;
  for (const std::size_t part : movedParts(procedure)) {
    const std::vector<PartStates> before = statesBefore(procedure, part);
    PartStates atEnd;
    for (std::size_t from = 0; from < before.size(); ++from) {
      const Step& step = procedure.steps[from];
      const bool ends =
          std::ranges::any_of(step.next, [](const auto& e) { return e.second == kEnd; });
      if (!ends) continue;
      const PartStates last = after(step, part, before[from]);
      atEnd.isOn = atEnd.isOn || last.isOn;
      atEnd.isOff = atEnd.isOff || last.isOff;
    }
    if (atEnd.isOff) (atEnd.isOn ? left.onSomeWays : left.onEveryWay).push_back(part);
  }
  return left;
}

}  // namespace pleinair::procedure
