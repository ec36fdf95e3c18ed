#include <cstdio>

#include "firmware_app/commands/commands.h"
#include "firmware_app/config/camera_selection.h"
#include "firmware_app/devices/inventory.h"
#include "hal/outputs/registry.h"

namespace pleinair::app {
namespace {

Inventory takeInventory() {
  return {.cameras = listDeviceCameras(deviceBackends()),
          .outputs = listOutputs(hal::outputKinds()),
          .keyboards = listKeyboards(hal::kernelKeyboards())};
}

}  // namespace

int listDevices(const DevicesOptions& options) {
  const Inventory inventory = takeInventory();
  // Write errors are checked once, at the end of the program.
  std::fputs((options.json ? asJson(inventory) : asText(inventory)).c_str(), stdout);
  return 0;
}

}  // namespace pleinair::app
