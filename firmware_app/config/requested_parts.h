#pragma once

#include <string>
#include <vector>

#include "firmware_app/config/configuration.h"
#include "firmware_app/doctor/probes.h"
#include "hal/error.h"

namespace pleinair::app {

/// Whether what the configuration in force asks for is there: the camera or recording, each output
/// (a file's folder, a loopback, a display), the scene with its models and calibration, the style's
/// own files (brushes), the status server's address. Reads files and lists devices; opens no camera
/// and writes nothing.
std::vector<doctor::RequestedPart> requestedParts(const Configuration& configuration);

/// Whether an output's folder is there and may be written to, where `target` (as of
/// hal::openOutput()) is a file or folder; all others are taken for granted. Errors: kNotFound,
/// kPermissionDenied, kIo, each with the command that fixes it.
hal::Result<void> checkOutputFolder(const std::string& target);

}  // namespace pleinair::app
