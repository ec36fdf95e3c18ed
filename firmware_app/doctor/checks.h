#pragma once

#include <vector>

#include "firmware_app/doctor/finding.h"
#include "firmware_app/doctor/probes.h"

namespace pleinair::app::doctor {

// The checks in the order in which they are reported. A check_<subject>.cpp holds those of a
// subject.

Finding checkGraphics(const Probes& probes);       ///< an OpenGL ES 3.1 context, and on what
Finding checkFrameImport(const Probes& probes);    ///< how camera frames reach the GPU
Finding checkRenderNodes(const Probes& probes);    ///< /dev/dri may be used
Finding checkDisplays(const Probes& probes);       ///< plugged in, permitted, not another program's
Finding checkDisplayTiming(const Probes& probes);  ///< its modes, and its refreshes are counted
Finding checkKeyboards(const Probes& probes);      ///< permitted, for keys without a desktop
Finding checkCameras(const Probes& probes);        ///< there, permitted, not in use
Finding checkUsbCameras(const Probes& probes);     ///< the module uvcvideo
Finding checkLoopback(const Probes& probes);       ///< the module v4l2loopback, for all readers
Finding checkCameraLinks(const Probes& probes);    ///< MTU and speed of the way to GigE cameras
Finding checkSocketBuffers(const Probes& probes);  ///< large enough for GigE cameras
Finding checkPriority(const Probes& probes);       ///< real-time priority may be had
Finding checkLockedMemory(const Probes& probes);
Finding checkClock(const Probes& probes);          ///< a clock source that is exact and cheap
Finding checkUdev(const Probes& probes);           ///< tells of cameras that come and go
Finding checkConfiguration(const Probes& probes);  ///< profile, site file, variables
Finding checkDisk(const Probes& probes);           ///< the folder of snapshots
Finding checkMemory(const Probes& probes);

/// One for each part that the configuration asks for: whether it is there.
std::vector<Finding> checkRequested(const Probes& probes);

/// All of them.
std::vector<Finding> examine(const Probes& probes);

}  // namespace pleinair::app::doctor
