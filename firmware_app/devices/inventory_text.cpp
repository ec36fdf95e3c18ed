#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "firmware_app/devices/inventory.h"

namespace pleinair::app {
namespace {

/// A frame rate: "30", "29.97".
std::string rateText(hal::Duration period) {
  const double rate = 1e9 / static_cast<double>(period.count());
  const double whole = std::round(rate);
  return std::abs(rate - whole) < 0.005 ? fmt::format("{:.0f}", whole)
                                        : fmt::format("{:.2f}", rate);
}

/// A size with its rates: "640x480 at 30, 15".
std::string sizeText(const hal::CameraMode& mode) {
  std::string text = fmt::format("{}x{}", mode.size.width, mode.size.height);
  std::vector<std::string> rates;
  for (const hal::Duration period : mode.periods) {
    if (period.count() > 0) rates.push_back(rateText(period));
  }
  if (!rates.empty()) text += fmt::format(" at {}", fmt::join(rates, ", "));
  return text;
}

/// The sizes of a layout, in the device's order.
struct LayoutLines {
  std::string layout;
  bool isSupported = true;
  std::vector<std::string> sizes;
};

std::vector<LayoutLines> byLayout(const std::vector<hal::CameraMode>& modes) {
  std::vector<LayoutLines> layouts;
  for (const hal::CameraMode& mode : modes) {
    if (layouts.empty() || layouts.back().layout != mode.layout) {
      layouts.push_back({.layout = mode.layout, .isSupported = mode.isSupported, .sizes = {}});
    }
    layouts.back().sizes.push_back(sizeText(mode));
  }
  return layouts;
}

std::string problemText(const hal::Error& problem) {
  std::string text = "    " + problem.problem + "\n";
  if (!problem.remedy.empty()) text += "    -> " + problem.remedy + "\n";
  return text;
}

std::string cameraText(const hal::CameraDescription& camera) {
  std::string text = fmt::format("  {}:{}", camera.identity.backend, camera.identity.id);
  if (!camera.identity.description.empty()) text += "  " + camera.identity.description;
  if (!camera.node.empty()) text += "  " + camera.node;
  if (!camera.serial.empty()) text += "  serial:" + camera.serial;
  text += "\n";
  if (camera.problem) text += problemText(*camera.problem);
  for (const LayoutLines& layout : byLayout(camera.modes)) {
    text += fmt::format("    {:<5} {}{}\n", layout.layout, fmt::join(layout.sizes, "; "),
                        layout.isSupported ? "" : " (not supported)");
  }
  if (camera.chosen) {
    text += fmt::format("    takes {} {}: {}\n", camera.chosen->mode.layout,
                        sizeText(camera.chosen->mode), camera.chosen->reason);
  }
  if (!camera.areModesKnown && !camera.problem) {
    text += "    tells its formats when it is opened\n";
  } else if (!camera.problem && camera.modes.empty()) {
    text += "    offers no formats\n";
  }
  return text;
}

/// What they are asked for: ", asked for 640x480 at 30".
std::string askedText(const hal::StreamRequest& request) {
  hal::CameraMode mode{
      .layout = {}, .size = request.size.value_or(hal::FrameSize{}), .periods = {}};
  if (request.framePeriod) mode.periods = {*request.framePeriod};
  return ", asked for " + sizeText(mode);
}

std::string camerasText(const Inventory& inventory) {
  std::string text = "Cameras (--camera ID)";
  if (inventory.asked) text += askedText(*inventory.asked);
  text += "\n";
  for (const hal::CameraDescription& each : inventory.cameras.cameras) text += cameraText(each);
  for (const hal::Error& each : inventory.cameras.problems) text += "  " + each.message() + "\n";
  if (inventory.cameras.cameras.empty() && inventory.cameras.problems.empty()) {
    text +=
        "  none. Plug one in, see `pleinair doctor`, or use --camera synthetic or the path of a\n"
        "  recording.\n";
  }
  return text;
}

std::string outputText(const hal::OutputDescription& output) {
  std::string text = "  " + output.target;
  if (output.problem) return text + "\n" + problemText(*output.problem);
  if (!output.name.empty()) text += "  " + output.name;
  if (output.isBusy) {
    text += "  (another program writes to it)";
  } else if (!output.formats.empty()) {
    text += fmt::format("  {}", fmt::join(output.formats, " "));
  }
  if (!output.scanOut.empty()) text += "\n    " + output.scanOut;
  return text + "\n";
}

std::string outputsText(const Inventory& inventory) {
  std::string text = "Outputs (--output NAME)\n";
  for (const KindOfOutputs& kind : inventory.outputs) {
    if (kind.isFile) {
      text += fmt::format("  {}: {}\n", fmt::join(kind.forms, ", "), kind.help);
      continue;
    }
    for (const hal::OutputDescription& each : kind.listing.outputs) text += outputText(each);
    if (!kind.listing.problem) continue;
    text += fmt::format("  no {}\n", kind.kind) + problemText(*kind.listing.problem);
  }
  return text;
}

std::string keyboardsText(const Inventory& inventory) {
  std::string text = "Keyboards (--set input.keyboards=NAME)\n";
  for (const ListedKeyboard& each : inventory.keyboards) {
    text += fmt::format("  {}  {}{}\n", each.description.name, each.description.node,
                        each.description.isKeyboard ? "" : "  (not in \"auto\")");
    if (each.problem) text += problemText(*each.problem);
  }
  if (inventory.keyboards.empty()) text += "  none\n";
  return text;
}

}  // namespace

std::string asText(const Inventory& inventory) {
  if (inventory.asked) return camerasText(inventory);
  return camerasText(inventory) + "\n" + outputsText(inventory) + "\n" + keyboardsText(inventory);
}

}  // namespace pleinair::app
