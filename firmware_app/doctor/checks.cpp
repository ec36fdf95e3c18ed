#include "firmware_app/doctor/checks.h"

#include <utility>

namespace pleinair::app::doctor {

std::vector<Finding> examine(const Probes& probes) {
  std::vector<Finding> findings;
  for (const auto& check :
       {checkGraphics, checkFrameImport, checkRenderNodes, checkDisplays, checkDisplayTiming,
        checkKeyboards, checkCameras, checkUsbCameras, checkCameraLinks, checkLoopback,
        checkSocketBuffers, checkPriority, checkLockedMemory, checkClock, checkUdev,
        checkConfiguration, checkDisk, checkMemory}) {
    findings.push_back(check(probes));
  }
  for (Finding& finding : checkRequested(probes)) findings.push_back(std::move(finding));
  return findings;
}

}  // namespace pleinair::app::doctor
