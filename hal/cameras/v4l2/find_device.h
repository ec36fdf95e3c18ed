#pragma once

#include <string>
#include <vector>

#include "hal/camera_backend.h"
#include "hal/cameras/v4l2/device_nodes.h"

namespace pleinair::hal::v4l2 {

/// The cameras that are there, by node number, with their modes. Left out are nodes that capture no
/// video (metadata, outputs, codecs, radio) and loopback devices that nobody feeds. One that cannot
/// be looked at is listed with its problem.
///
/// The id is the first of these that there is:
/// 1. the name of udev's link in /dev/v4l/by-id (maker, model and serial; "…-video-index0"), unless
///    another device has the same, as of two cameras without serials;
/// 2. the name of its link in /dev/v4l/by-path (the socket that it is plugged into);
/// 3. bus, card and the node's index on its device, where there is no udev:
///    "platform:vivid-000-vivid-index0";
/// 4. the node's path, where nothing else can be read.
std::vector<CameraDescription> listDevices(const System& system);

/// The node of an id of listDevices(), of any link's name, or of a path (which need not exist).
/// The kernel's account of its nodes (sysfs) comes before udev's links, which may still lead to a
/// node that is gone or is another device's by now: after a reset of a driver, udev moves them
/// later. Errors: kNotFound, with the ids that there are.
Result<std::string> findNode(const System& system, const std::string& id);

}  // namespace pleinair::hal::v4l2
