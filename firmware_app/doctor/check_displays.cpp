#include <algorithm>

#include <fmt/format.h>

#include "firmware_app/doctor/checks.h"

namespace pleinair::app::doctor {

Finding checkDisplays(const Probes& probes) {
  Finding finding{.check = "displays", .verdict = Verdict::kWarning};
  const hal::OutputListing listing = probes.displays();
  if (listing.outputs.empty()) {
    finding.text = "no graphics card with displays: no picture without a desktop";
    finding.remedy = "load the card's driver; see `dmesg | grep drm`";
    return finding;
  }
  const auto plugged = std::ranges::find_if(
      listing.outputs, [](const hal::OutputDescription& each) { return !each.problem; });
  if (plugged == listing.outputs.end()) {
    finding.text = fmt::format("none of {} connectors has a display", listing.outputs.size());
    finding.remedy = "plug one in and switch it on";
    return finding;
  }
  if (const std::optional<hal::Error> problem = probes.displayProblem()) {
    const bool isForbidden = problem->kind == hal::ErrorKind::kPermissionDenied;
    finding.verdict = isForbidden ? Verdict::kWrong : Verdict::kWarning;
    finding.text = fmt::format("{}: {}", plugged->target, problem->problem);
    finding.remedy =
        isForbidden ? "sudo usermod -aG video $USER, then log in again" : problem->remedy;
    return finding;
  }
  finding.verdict = Verdict::kOk;
  finding.text = fmt::format("{}, {}", plugged->target,
                             plugged->formats.empty() ? "no modes" : plugged->formats.front());
  return finding;
}

}  // namespace pleinair::app::doctor
