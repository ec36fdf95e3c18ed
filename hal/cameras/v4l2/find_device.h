#pragma once

#include <string>
#include <vector>

#include "hal/camera_backend.h"
#include "hal/cameras/v4l2/device_nodes.h"

namespace pleinair::hal::v4l2 {

/// The connected cameras, by node number, with their modes. Nodes that capture no video (metadata,
/// outputs, codecs, radio) are skipped, and so are loopback devices without a feeder or fed by this
/// process, and ends of pipelines that the media controller sets up (V4L2_CAP_IO_MC), which
/// libcamera drives. A camera that cannot be queried is listed with its problem.
///
/// The id is the first of these that exists:
/// 1. the name of udev's link in /dev/v4l/by-id (maker, model and serial; "…-video-index0"), unless
/// another device has the same one, such as two cameras without serials;
/// 2. the name of its link in /dev/v4l/by-path (its USB port or bus address);
/// 3. without udev: bus, card and the node's index on its device,
/// "platform:vivid-000-vivid-index0";
/// 4. the node's path, if nothing else can be read.
std::vector<CameraDescription> listDevices(const System& system);

/// The node of an id of listDevices(), of any link's name, or of a path (which need not exist).
/// The kernel's account of its nodes (sysfs) comes before udev's links, which may still lead to a
/// node that is gone or is another device's by now: after a reset of a driver, udev moves them
/// later. Errors: kNotFound, with the ids that there are.
Result<std::string> findNode(const System& system, const std::string& id);

}  // namespace pleinair::hal::v4l2
