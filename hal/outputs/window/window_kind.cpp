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

}  // namespace

OutputKind windowKind() {
  return {.name = "window",
          .help = "a window on the desktop",
          .forms = {"window"},
          .traits = {.isPaced = true, .isOnMainThread = true},
          .options = {},
          .recognizes = [](const std::string& target) { return target == "window"; },
          .list = listWindow,
          .problemOf = [](const std::string&) { return listWindow().problem; },
          .make = [](const std::string&, const OutputOptions&) -> Result<std::unique_ptr<Output>> {
            return openWindow();
          }};
}

}  // namespace pleinair::hal
