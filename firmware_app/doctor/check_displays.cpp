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
  // Copying is no fault, and mostly the driver's choice.
  finding.text = fmt::format("{}, {}; {}", plugged->target,
                             plugged->formats.empty() ? "no modes" : plugged->formats.front(),
                             textOf(probes.scanOut()));
  return finding;
}

Finding checkDisplayTiming(const Probes& probes) {
  Finding finding{.check = "display timing", .verdict = Verdict::kOk};
  const hal::Result<hal::DisplayTiming> timing = probes.displayTiming();
  if (!timing) {
    using enum hal::ErrorKind;
    const hal::Error& error = timing.error();
    // What checkDisplays() has said already.
    const bool isNoDisplay = error.kind == kNotFound || error.kind == kDeviceLost ||
                             error.kind == kPermissionDenied || error.kind == kBusy;
    if (!isNoDisplay) finding.verdict = Verdict::kWarning;
    finding.text = isNoDisplay ? "there is no display to ask" : error.problem;
    if (!isNoDisplay) finding.remedy = error.remedy;
    return finding;
  }
  finding.text =
      fmt::format("{}x{} at {:.2f} Hz, of which each refresh is counted", timing->size.width,
                  timing->size.height, 1.0 / hal::toSeconds(timing->period));
  if (timing->hasVblank) return finding;
  finding.verdict = Verdict::kWarning;
  finding.text = fmt::format(
      "{}x{} at {:.2f} Hz by the clock: the card's driver has no vertical blanking, so that when a "
      "picture was seen is not known, and it may tear",
      timing->size.width, timing->size.height, 1.0 / hal::toSeconds(timing->period));
  finding.remedy = "show pictures on a card that is not a virtual one, or live with it";
  return finding;
}

}  // namespace pleinair::app::doctor
