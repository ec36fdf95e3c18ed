#include <cstdio>

#include "firmware_app/commands/commands.h"
#include "firmware_app/devices/inventory.h"
#include "firmware_app/live/camera_selection.h"
#include "hal/outputs/window/window.h"

namespace pleinair::app {
namespace {

Inventory takeInventory() {
  Inventory inventory{.cameras = listDeviceCameras(deviceBackends())};
  inventory.loopbacks = hal::listLoopbacks();
  inventory.displays = listDisplays();
  // The window is not shown before start().
  if (const auto window = hal::openWindow(); !window) inventory.noWindow = window.error();
  return inventory;
}

}  // namespace

int listDevices(const DevicesOptions& options) {
  const Inventory inventory = takeInventory();
  // Write errors are checked once, at the end of the program.
  std::fputs((options.json ? asJson(inventory) : asText(inventory)).c_str(), stdout);
  return 0;
}

}  // namespace pleinair::app
