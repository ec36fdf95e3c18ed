#include <cstdio>

#include "firmware_app/commands/commands.h"
#include "firmware_app/config/camera_selection.h"
#include "firmware_app/config/configured_parts.h"
#include "firmware_app/devices/inventory.h"
#include "firmware_app/doctor/scan_out_trial.h"
#include "hal/outputs/registry.h"

namespace pleinair::app {
namespace {

/// For displays that are plugged in.
void tryScanOut(std::vector<KindOfOutputs>& kinds) {
  for (KindOfOutputs& kind : kinds) {
    for (hal::OutputDescription& each : kind.listing.outputs) {
      const hal::Result<const hal::OutputKind*> of = hal::outputKindOf(each.target);
      if (!of || !(*of)->traits.isOnConsole || each.problem) continue;
      each.scanOut = doctor::textOf(doctor::tryScanOut(each.target));
    }
  }
}

Inventory takeInventory() {
  Inventory inventory{.cameras = listDeviceCameras(deviceBackends()),
                      .outputs = listOutputs(hal::outputKinds()),
                      .keyboards = listKeyboards(hal::kernelKeyboards())};
  tryScanOut(inventory.outputs);
  return inventory;
}

/// The cameras alone, with their modes and what each would take.
Inventory takeModes(const ConfigurationRequest& request) {
  const CameraSettings settings = configuredCamera(Configuration(request));
  const std::vector<hal::SelectableBackend> backends = deviceBackends(settings);
  Inventory inventory{.cameras = listDeviceCameras(backends), .asked = streamRequestOf(settings)};
  askModes(inventory.cameras, backends, *inventory.asked);
  return inventory;
}

}  // namespace

int listDevices(const DevicesOptions& options) {
  const Inventory inventory = options.modes ? takeModes(options.configuration) : takeInventory();
  // Write errors are checked once, at the end of the program.
  std::fputs((options.json ? asJson(inventory) : asText(inventory)).c_str(), stdout);
  return 0;
}

}  // namespace pleinair::app
