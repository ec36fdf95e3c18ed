#include <string>
#include <string_view>
#include <utility>

#include "hal/outputs/window/window.h"

namespace pleinair::hal {
namespace {

/// Opens one that is never shown.
OutputListing listWindow() {
  Result<std::unique_ptr<Window>> window = openWindow();
  if (!window) return {.outputs = {}, .problem = std::move(window.error())};
  return {.outputs = {{.target = "window"}}, .problem = {}};
}

std::string valueOf(const OutputOptions& options, std::string_view name) {
  const auto given = options.find(name);
  return given == options.end() ? std::string() : given->second;
}

WindowSettings settingsOf(const OutputOptions& options) {
  WindowSettings settings;
  settings.isFullScreen = valueOf(options, "full_screen") == "true";
  if (const std::string display = valueOf(options, "display"); !display.empty()) {
    settings.display = display;
  }
  const std::string rotation = valueOf(options, "rotation");
  settings.quarterTurns = rotation == "90" ? 1 : rotation == "180" ? 2 : rotation == "270" ? 3 : 0;
  settings.isMirrored = valueOf(options, "mirror") == "true";
  settings.takesKeys = valueOf(options, "keys") != "locked";
  settings.hidesCursor = valueOf(options, "cursor") == "hidden";
  const std::string scanOut = valueOf(options, "scan_out");
  using Lending = WindowSettings::Lending;
  settings.lending = scanOut == "direct"   ? Lending::kAlways
                     : scanOut == "copied" ? Lending::kNever
                                           : Lending::kByGpus;
  return settings;
}

bool isDisplayText(std::string_view text) {
  return !text.empty();
}

}  // namespace

OutputKind windowKind() {
  return {.name = "window",
          .help = "a window on the desktop",
          .forms = {"window"},
          .traits = {.isPaced = true, .isOnMainThread = true, .showsWaiting = true},
          .options = {{.name = "full_screen",
                       .help = "Whether it fills the screen from the start.",
                       .isSwitch = true},
                      {.name = "display",
                       .help = "The display that it opens on.",
                       .initial = "auto",
                       .allowed = "auto, a number from 1, or a part of a display's name",
                       .takes = isDisplayText},
                      {.name = "rotation",
                       .help = "How far pictures are turned clockwise, in degrees.",
                       .choices = {"0", "90", "180", "270"}},
                      {.name = "mirror",
                       .help = "Whether left and right are exchanged, as in a mirror.",
                       .isSwitch = true},
                      {.name = "keys",
                       .help = "Whether its keys work, and it can be closed; \"locked\": neither, "
                               "and the desktop's own keys are kept from it.",
                       .choices = {"free", "locked"}},
                      {.name = "cursor",
                       .help = "Whether the mouse pointer is seen; \"auto\": not in full screen.",
                       .choices = {"auto", "hidden"}},
                      {.name = "scan_out",
                       .help = "Whether paintings are drawn straight into the window's textures, "
                               "where a trial has shown that this works: \"auto\" by GPUs, "
                               "\"direct\" by software, too; or pictures are always copied.",
                       .choices = {"auto", "direct", "copied"}}},
          .recognizes = [](const std::string& target) { return target == "window"; },
          .list = listWindow,
          .problemOf = [](const std::string&) { return listWindow().problem; },
          .make = [](const std::string&, const OutputOptions& options)
              -> Result<std::unique_ptr<Output>> { return openWindow(settingsOf(options)); }};
}

}  // namespace pleinair::hal
