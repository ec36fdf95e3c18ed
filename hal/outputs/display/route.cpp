#include "hal/outputs/display/route.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "hal/surface.h"

namespace pleinair::hal::display {
namespace {

Error error(ErrorKind kind, std::string subject, std::string problem, std::string remedy = {}) {
  return {.kind = kind,
          .subject = std::move(subject),
          .problem = std::move(problem),
          .remedy = std::move(remedy)};
}

std::string namesOf(std::span<const Connector> connectors) {
  std::string names;
  for (const Connector& each : connectors) {
    names += (names.empty() ? "" : ", ") + each.name + (each.isConnected ? " (connected)" : "");
  }
  return names.empty() ? "none" : names;
}

/// How far a refresh is from a whole multiple of the camera's rate, relative to the camera's
/// period; one that is slower than the camera loses frames and comes last.
double misfit(Duration refresh, Duration framePeriod) {
  const double refreshes = toSeconds(framePeriod) / toSeconds(refresh);
  constexpr double kSlow = 1.0;
  // A rate that is less than 1 % too slow (59.94 for 60) still counts as that rate.
  if (refreshes < 0.99) return kSlow + 1.0 / refreshes;
  return std::abs(refreshes - std::round(refreshes)) / std::round(refreshes);
}

struct ModeText {
  FrameSize size;
  std::optional<double> hertz;
};

/// "1920x1080", "1920x1080@59.94".
std::optional<ModeText> parse(const std::string& text) {
  ModeText mode;
  const char* at = text.data();
  const char* end = at + text.size();
  const auto width = std::from_chars(at, end, mode.size.width);
  if (width.ec != std::errc() || width.ptr == end || *width.ptr != 'x') return std::nullopt;
  const auto height = std::from_chars(width.ptr + 1, end, mode.size.height);
  if (height.ec != std::errc() || !isAcceptedSize(mode.size)) return std::nullopt;
  if (height.ptr == end) return mode;
  double hertz = 0.0;
  if (*height.ptr != '@') return std::nullopt;
  const auto rate = std::from_chars(height.ptr + 1, end, hertz);
  if (rate.ec != std::errc() || rate.ptr != end || !(hertz > 0.0)) return std::nullopt;
  mode.hertz = hertz;
  return mode;
}

const Mode& preferredOf(const Connector& connector) {
  const auto preferred = std::ranges::find(connector.modes, true, &Mode::isPreferred);
  return preferred == connector.modes.end() ? connector.modes.front() : *preferred;
}

/// Among the progressive modes of a size, the one with the smallest cost; the first of equal ones.
template <class Cost>
const Mode* bestOfSize(const Connector& connector, FrameSize size, Cost cost) {
  const Mode* best = nullptr;
  for (const Mode& each : connector.modes) {
    if (each.size != size || each.isInterlaced) continue;
    if (best == nullptr || cost(each) < cost(*best)) best = &each;
  }
  return best;
}

std::string sizesOf(const Connector& connector) {
  std::string sizes;
  for (const Mode& each : connector.modes) {
    const std::string size =
        std::to_string(each.size.width) + "x" + std::to_string(each.size.height);
    if (sizes.find(size) == std::string::npos) sizes += (sizes.empty() ? "" : ", ") + size;
  }
  return sizes;
}

bool takesXrgb(const Plane& plane) {
  return std::ranges::find(plane.fourccs, kXrgb8888) != plane.fourccs.end();
}

}  // namespace

bool isDisplayName(const std::string& name) {
  if (name == kDisplayName) return true;
  return name.starts_with("display:") && name.size() > kDisplayName.size() + 1 &&
         name.find('/') == std::string::npos;
}

DisplayName parseDisplayName(const std::string& name) {
  if (name == kDisplayName) return {};
  const std::string rest = name.substr(kDisplayName.size() + 1);
  const std::size_t dash = rest.find('-');
  const bool hasCard = rest.starts_with("card") && dash != std::string::npos && dash > 4 &&
                       std::all_of(rest.begin() + 4, rest.begin() + static_cast<long>(dash),
                                   [](char c) { return c >= '0' && c <= '9'; });
  if (!hasCard) return {.card = {}, .connector = rest};
  return {.card = rest.substr(0, dash), .connector = rest.substr(dash + 1)};
}

Result<Connector> chooseConnector(const CardState& card, const std::string& name,
                                  std::span<const ObjectId> taken) {
  const auto isTaken = [&](const Connector& each) {
    return std::ranges::find(taken, each.id) != taken.end();
  };
  if (name.empty()) {
    for (const Connector& each : card.connectors) {
      if (each.isConnected && !isTaken(each)) return each;
    }
    return tl::unexpected(error(ErrorKind::kDeviceLost, "display", "no display is plugged in",
                                "plug one in; connectors: " + namesOf(card.connectors)));
  }
  const auto found = std::ranges::find(card.connectors, name, &Connector::name);
  if (found == card.connectors.end()) {
    return tl::unexpected(error(ErrorKind::kNotFound, name, "there is no such connector",
                                "choose one of: " + namesOf(card.connectors)));
  }
  if (isTaken(*found)) {
    return tl::unexpected(error(ErrorKind::kBusy, name, "another output shows on it"));
  }
  if (!found->isConnected) {
    return tl::unexpected(error(ErrorKind::kDeviceLost, name, "no display is plugged in"));
  }
  return *found;
}

bool isModeText(const std::string& text) {
  return text == "auto" || text == "preferred" || parse(text).has_value();
}

Result<Mode> chooseMode(const Connector& connector, const DisplayRequest& request) {
  const Mode& preferred = preferredOf(connector);
  if (request.mode == "preferred") return preferred;
  if (request.mode == "auto") {
    if (!request.framePeriod) return preferred;
    const auto cost = [&](const Mode& mode) { return misfit(mode.period, *request.framePeriod); };
    const Mode* best = bestOfSize(connector, preferred.size, cost);
    if (best == nullptr) return preferred;
    // The display's own choice, unless another rate is really better.
    constexpr double kBetter = 0.005;
    const bool keeps = !preferred.isInterlaced && cost(preferred) <= cost(*best) + kBetter;
    return keeps ? preferred : *best;
  }
  const std::optional<ModeText> asked = parse(request.mode);
  if (!asked) {
    return tl::unexpected(error(ErrorKind::kInvalidArgument, request.mode, "is no mode",
                                "give auto, preferred, 1920x1080 or 1920x1080@60"));
  }
  const Mode* best = bestOfSize(connector, asked->size, [&](const Mode& mode) {
    const double hertz = 1.0 / toSeconds(mode.period);
    return asked->hertz ? std::abs(hertz - *asked->hertz) : -hertz;
  });
  constexpr double kMaxOff = 1.0;  // hertz
  const bool isNear =
      best != nullptr &&
      (!asked->hertz || std::abs(1.0 / toSeconds(best->period) - *asked->hertz) < kMaxOff);
  if (isNear) return *best;
  return tl::unexpected(error(ErrorKind::kNotFound, connector.name, "has no mode " + request.mode,
                              "it has " + sizesOf(connector)));
}

Result<DisplayRoute> routeTo(const CardState& card, const Connector& connector, const Mode& mode,
                             const InUse& inUse) {
  const Property* current = find(connector.properties, "CRTC_ID");
  const Crtc* chosen = nullptr;
  std::size_t index = 0;
  for (std::size_t i = 0; i < card.crtcs.size() && i < 32; ++i) {
    const std::uint32_t bit = std::uint32_t{1} << i;
    if ((connector.crtcs & bit) == 0 || (inUse.crtcs & bit) != 0) continue;
    const bool isCurrent = current != nullptr && current->value == card.crtcs[i].id;
    if (chosen != nullptr && !isCurrent) continue;
    chosen = &card.crtcs[i];
    index = i;
  }
  if (chosen == nullptr) {
    return tl::unexpected(error(ErrorKind::kBusy, connector.name,
                                "the card can show no more pictures at once",
                                "use fewer displays of this card"));
  }
  for (std::size_t i = 0; i < card.planes.size() && i < 64; ++i) {
    const Plane& plane = card.planes[i];
    const bool isFree = (inUse.planes & (std::uint64_t{1} << i)) == 0;
    if (!plane.isPrimary || !isFree || ((plane.crtcs >> index) & 1U) == 0) continue;
    if (takesXrgb(plane)) {
      return DisplayRoute{.connector = connector,
                          .crtc = *chosen,
                          .plane = plane,
                          .mode = mode,
                          .crtcIndex = index,
                          .planeIndex = i};
    }
  }
  return tl::unexpected(
      error(ErrorKind::kUnsupported, connector.name, "no plane of the card takes XRGB8888"));
}

}  // namespace pleinair::hal::display
