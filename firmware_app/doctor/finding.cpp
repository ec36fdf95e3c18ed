#include "firmware_app/doctor/finding.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace pleinair::app::doctor {
namespace {

auto countOf(const std::vector<Finding>& findings, Verdict verdict) {
  return std::ranges::count(findings, verdict, &Finding::verdict);
}

std::string plural(std::ptrdiff_t count, std::string_view one) {
  return fmt::format("{} {}{}", count, one, count == 1 ? "" : "s");
}

std::string summary(const std::vector<Finding>& findings) {
  const auto wrong = countOf(findings, Verdict::kWrong);
  const auto warnings = countOf(findings, Verdict::kWarning);
  if (wrong + warnings == 0) return "All is well.";
  if (wrong == 0) return fmt::format("Nothing is wrong; {}.", plural(warnings, "warning"));
  return fmt::format("{} to fix; {}.", plural(wrong, "thing"), plural(warnings, "warning"));
}

}  // namespace

std::string_view toString(Verdict verdict) {
  switch (verdict) {
    case Verdict::kOk:
      return "ok";
    case Verdict::kWarning:
      return "warning";
    case Verdict::kWrong:
      return "WRONG";
  }
  return "?";
}

std::string asText(const std::vector<Finding>& findings) {
  std::size_t width = 0;
  for (const Finding& each : findings) width = std::max(width, each.check.size());
  std::string text;
  for (const Finding& each : findings) {
    text += fmt::format("{:<8} {:<{}}  {}\n", toString(each.verdict), each.check, width, each.text);
    if (!each.remedy.empty())
      text += fmt::format("{:<9}{:<{}}  -> {}\n", "", "", width, each.remedy);
  }
  return text + "\n" + summary(findings) + "\n";
}

std::string asJson(const std::vector<Finding>& findings) {
  nlohmann::ordered_json checks = nlohmann::ordered_json::array();
  for (const Finding& each : findings) {
    std::string verdict(toString(each.verdict));
    if (each.verdict == Verdict::kWrong) verdict = "wrong";
    checks.push_back({{"check", each.check},
                      {"verdict", verdict},
                      {"text", each.text},
                      {"remedy", each.remedy}});
  }
  const nlohmann::ordered_json document{{"checks", std::move(checks)},
                                        {"wrong", countOf(findings, Verdict::kWrong)},
                                        {"warnings", countOf(findings, Verdict::kWarning)}};
  // Labels and paths may hold anything.
  return document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace pleinair::app::doctor
