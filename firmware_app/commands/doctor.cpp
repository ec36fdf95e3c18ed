#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "config/config_error.h"
#include "firmware_app/commands/commands.h"
#include "firmware_app/config/camera_selection.h"
#include "firmware_app/config/configured_parts.h"
#include "firmware_app/config/requested_parts.h"
#include "firmware_app/devices/inventory.h"
#include "firmware_app/doctor/checks.h"

namespace pleinair::app {
int examineMachine(const DoctorOptions& options) {
  doctor::Probes probes = doctor::systemProbes();
  // Asked for by several checks; looking for cameras on a network takes a second.
  const DeviceCameras cameras = listDeviceCameras(deviceBackends());
  probes.cameras = [&] { return cameras; };
  probes.snapshots = ".";
  std::optional<std::string> configurationError;
  std::vector<doctor::RequestedPart> requested;
  try {
    const Configuration configuration(options.configuration);
    probes.snapshots = configuration.output().snapshots;
    requested = requestedParts(configuration);
    const CameraSettings camera = configuredCamera(configuration);
    const double asked = camera.framesPerSecond * camera.size.width * camera.size.height;
    probes.askedPixelsPerSecond = [asked] { return asked; };
  } catch (const config::ConfigError& error) {
    configurationError = error.what();
  }
  probes.requested = [&] { return requested; };
  probes.configurationError = [&] { return configurationError; };
  const std::vector<doctor::Finding> findings = doctor::examine(probes);
  // Write errors are checked once, at the end of the program.
  std::fputs((options.json ? doctor::asJson(findings) : doctor::asText(findings)).c_str(), stdout);
  const bool isWrong = std::ranges::find(findings, doctor::Verdict::kWrong,
                                         &doctor::Finding::verdict) != findings.end();
  return isWrong ? 1 : 0;
}

}  // namespace pleinair::app
