#include "firmware_app/doctor/checks.h"

namespace pleinair::app::doctor {

std::vector<Finding> examine(const Probes& probes) {
  std::vector<Finding> findings;
  for (const auto& check : {checkGraphics, checkRenderNodes, checkCameras, checkUsbCameras,
                            checkLoopback, checkSocketBuffers, checkPriority, checkLockedMemory,
                            checkClock, checkUdev, checkConfiguration, checkDisk, checkMemory}) {
    findings.push_back(check(probes));
  }
  return findings;
}

}  // namespace pleinair::app::doctor
