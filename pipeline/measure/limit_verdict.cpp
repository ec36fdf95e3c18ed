#include "pipeline/measure/limit_verdict.h"

#include <fmt/format.h>

namespace pleinair::measure {

Verdict verdictOf(const Limit& limit, std::optional<double> value) {
  const char* const relation = limit.isUpper ? "≤" : limit.isReached ? "≥" : ">";
  Verdict verdict{
      .what = fmt::format("{} {} {:g}{}", limit.name, relation, limit.value, limit.unit),
      .found = limit.missing,
      .comparison =
          Verdict::Comparison{.value = value, .limit = limit.value, .isUpperLimit = limit.isUpper}};
  if (!value) return verdict;
  verdict.found = fmt::format("{:.3g}{}", *value, limit.unit);
  const bool isPassed = limit.isUpper     ? *value <= limit.value
                        : limit.isReached ? *value >= limit.value
                                          : *value > limit.value;
  verdict.state = isPassed ? Verdict::State::kPassed : Verdict::State::kFailed;
  return verdict;
}

Verdict verdictAlong(const Limit& limit, std::optional<double> value,
                     std::optional<double> ofInput) {
  if (!ofInput || *ofInput <= limit.value / 2) return verdictOf(limit, value);
  Limit unexplained = limit;
  unexplained.missing = "the input itself reads more than half of it";
  return verdictOf(unexplained, std::nullopt);
}

}  // namespace pleinair::measure
