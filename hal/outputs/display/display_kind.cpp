#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "hal/outputs/display/display_errors.h"
#include "hal/outputs/display/display_output.h"
#include "hal/outputs/display/route.h"
#include "hal/outputs/display/shared_card.h"

namespace pleinair::hal {
namespace {

using namespace display;
namespace fs = std::filesystem;

constexpr double kMaxMarginPercent = 20.0;
constexpr const char* kDimLevel = "0.4";

std::optional<double> percentOf(std::string_view text) {
  double percent = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), percent);
  const bool isWhole = read.ec == std::errc() && read.ptr == text.data() + text.size();
  if (!isWhole || !(percent >= 0.0 && percent <= kMaxMarginPercent)) return std::nullopt;
  return percent;
}

bool isMargin(std::string_view text) {
  return percentOf(text).has_value();
}

std::optional<int> driftOf(std::string_view text) {
  constexpr int kMost = 16;
  int pixels = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), pixels);
  const bool isWhole = read.ec == std::errc() && read.ptr == text.data() + text.size();
  if (!isWhole || pixels < 0 || pixels > kMost) return std::nullopt;
  return pixels;
}

bool isDrift(std::string_view text) {
  return driftOf(text).has_value();
}

bool isMode(std::string_view text) {
  return isModeText(std::string(text));
}

bool isTimes(std::string_view text) {
  return text == "never" || DailyTimes::parsed(text).has_value();
}

bool isDimLevel(std::string_view text) {
  return DimmingRules::parsedLevel(text).has_value();
}

bool isQuietTime(std::string_view text) {
  return QuietTime::parsed(text).has_value();
}

std::string valueOf(const OutputOptions& options, std::string_view name, std::string initial) {
  const auto given = options.find(name);
  return given == options.end() ? std::move(initial) : given->second;
}

DisplaySettings settingsOf(const OutputOptions& options) {
  DisplaySettings settings;
  settings.mode = valueOf(options, "mode", "auto");
  Placement& placement = settings.placement;
  placement.fit = valueOf(options, "fit", "letterbox") == "fill" ? Placement::Fit::kFill
                                                                 : Placement::Fit::kLetterbox;
  const std::string rotation = valueOf(options, "rotation", "0");
  placement.quarterTurns = rotation == "90" ? 1 : rotation == "180" ? 2 : rotation == "270" ? 3 : 0;
  placement.marginPercent = percentOf(valueOf(options, "margin", "0")).value_or(0.0);
  settings.driftPixels = driftOf(valueOf(options, "drift", "0")).value_or(0);
  settings.lendsToGpu = valueOf(options, "scan_out", "auto") != "copied";
  settings.blanking.times = DailyTimes::parsed(valueOf(options, "blank", "never"));
  const auto quiet = QuietTime::parsed(valueOf(options, "blank_after", "never"));
  settings.blanking.after = quiet.value_or(QuietTime{}).after;
  settings.dimming.times = DailyTimes::parsed(valueOf(options, "dim", "never"));
  settings.dimming.level = DimmingRules::parsedLevel(valueOf(options, "dim_level", kDimLevel))
                               .value_or(settings.dimming.level);
  return settings;
}

/// The kernel's list of connectors, which opens no card and needs no permission.
std::vector<std::string> linesOf(const fs::path& path) {
  constexpr std::size_t kMaxLines = 256;
  std::vector<std::string> lines;
  std::ifstream file(path);
  for (std::string line; lines.size() < kMaxLines && std::getline(file, line);) {
    // The kernel lists a size once for each of its rates.
    if (std::ranges::find(lines, line) == lines.end()) lines.push_back(line);
  }
  return lines;
}

/// Why the display could not be claimed now; it is claimed, and released.
std::optional<Error> problemOf(const std::string& target) {
  const Result<ClaimedDisplay> claimed = claimDisplay(kernelCards(), target, {});
  if (!claimed) return claimed.error();
  Card& card = claimed->card->card();
  const bool isMaster = card.isMaster() || card.becomeMaster() == 0;
  claimed->card->release(claimed->route);
  if (isMaster) return std::nullopt;
  return notMaster(card.node(), claimed->route.connector.name);
}

Result<std::unique_ptr<Output>> make(const std::string& target, const OutputOptions& options) {
  return openDisplay(target, settingsOf(options));
}

}  // namespace

OutputListing listDisplays(const fs::path& folder) {
  OutputListing listing;
  std::error_code failure;
  for (fs::directory_iterator each(folder, failure), end; !failure && each != end;
       each.increment(failure)) {
    std::error_code ignored;
    if (!fs::exists(each->path() / "status", ignored)) continue;  // a card, or a render node
    const std::string connector = each->path().filename().string();
    if (connector.find("Writeback") != std::string::npos) continue;
    const std::vector<std::string> status = linesOf(each->path() / "status");
    OutputDescription output{.target = std::string(kDisplayName) + ":" + connector,
                             .formats = linesOf(each->path() / "modes")};
    if (status.empty() || status.front() != "connected") {
      output.problem = Error{.kind = ErrorKind::kDeviceLost,
                             .subject = connector,
                             .problem = "no display is plugged in"};
    }
    listing.outputs.push_back(std::move(output));
  }
  std::ranges::sort(listing.outputs, {}, &OutputDescription::target);
  if (listing.outputs.empty()) listing.problem = noCard(std::string(kDisplayName));
  return listing;
}

Result<DisplayTiming> displayTiming(const std::string& name, Cards& cards) {
  const Result<ClaimedDisplay> claimed = claimDisplay(cards, name, {});
  if (!claimed) return tl::unexpected(claimed.error());
  const DisplayRoute& route = claimed->route;
  const DisplayTiming timing{.size = route.mode.size,
                             .period = route.mode.period,
                             .hasVblank = claimed->card->card().hasVblank(route.crtc.id)};
  claimed->card->release(route);
  return timing;
}

OutputKind displayKind() {
  return {.name = std::string(kDisplayName),
          .help = "a screen without a desktop, through the kernel (DRM/KMS)",
          .forms = {"display", "display:CONNECTOR"},
          .traits = {.isPaced = true, .reopens = true, .showsWaiting = true, .isOnConsole = true},
          .options = {{.name = "mode",
                       .help = "The mode; \"auto\": the display's own size at the rate that fits "
                               "the camera's best.",
                       .initial = "auto",
                       .allowed = "auto, preferred, 1920x1080 or 1920x1080@60",
                       .takes = isMode},
                      {.name = "fit",
                       .help = "Whether pictures are shown whole, with black bars, or fill the "
                               "display.",
                       .choices = {"letterbox", "fill"}},
                      {.name = "rotation",
                       .help = "How far pictures are turned clockwise, in degrees.",
                       .choices = {"0", "90", "180", "270"}},
                      {.name = "margin",
                       .help = "What stays black at each edge, for screens that hide theirs, in "
                               "percent of the side.",
                       .initial = "0",
                       .allowed = "a number from 0 to 20",
                       .takes = isMargin},
                      {.name = "drift",
                       .help = "By how many pixels pictures move to and fro, one a minute, so that "
                               "nothing burns in; as much of each edge is cut off.",
                       .initial = "0",
                       .allowed = "a whole number from 0 to 16",
                       .takes = isDrift},
                      {.name = "scan_out",
                       .help = "Whether the GPU draws straight into the display's memory, where a "
                               "trial has shown that it can, or pictures are always copied.",
                       .choices = {"auto", "copied"}},
                      {.name = "blank",
                       .help = "From when to when the display is switched off while nobody is "
                               "there.",
                       .initial = "never",
                       .allowed = "never, or times such as 22:00-08:00",
                       .takes = isTimes},
                      {.name = "blank_after",
                       .help = "After how many seconds without a key or a movement before the "
                               "camera the display is switched off.",
                       .initial = "never",
                       .allowed = "never, or a whole number from 1 to 86400",
                       .takes = isQuietTime},
                      {.name = "dim",
                       .help = "From when to when pictures are darker, whoever is there; the "
                               "display's own backlight is left alone.",
                       .initial = "never",
                       .allowed = "never, or times such as 20:00-23:00",
                       .takes = isTimes},
                      {.name = "dim_level",
                       .help = "How bright pictures are then: 1 as ever, 0 black.",
                       .initial = kDimLevel,
                       .allowed = "a number from 0 to 1",
                       .takes = isDimLevel}},
          .recognizes = isDisplayName,
          .list = [] { return listDisplays(); },
          .problemOf = problemOf,
          .make = make};
}

}  // namespace pleinair::hal
