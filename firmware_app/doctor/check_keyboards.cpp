#include <algorithm>

#include <fmt/format.h>

#include "firmware_app/doctor/checks.h"

namespace pleinair::app::doctor {

Finding checkKeyboards(const Probes& probes) {
  Finding finding{.check = "keyboards", .verdict = Verdict::kWarning};
  std::vector<ListedKeyboard> keyboards = probes.keyboards();
  std::erase_if(keyboards, [](const ListedKeyboard& each) { return !each.description.isKeyboard; });
  if (keyboards.empty()) {
    finding.verdict = Verdict::kOk;
    finding.text = "none: no keys on a screen without a desktop";
    return finding;
  }
  const auto refused = std::ranges::find_if(
      keyboards, [](const ListedKeyboard& each) { return each.problem.has_value(); });
  if (refused == keyboards.end()) {
    finding.verdict = Verdict::kOk;
    finding.text = fmt::format("{} ({})", keyboards.front().description.node,
                               keyboards.front().description.name);
    return finding;
  }
  finding.text = fmt::format("{}: {}: no keys on a screen without a desktop",
                             refused->description.node, refused->problem->problem);
  const bool isForbidden = refused->problem->kind == hal::ErrorKind::kPermissionDenied;
  finding.remedy = refused->problem->remedy.empty() ? "plug it in again" : refused->problem->remedy;
  if (isForbidden) finding.remedy = "sudo usermod -aG input $USER, then log in again";
  return finding;
}

}  // namespace pleinair::app::doctor
