#pragma once

#include <memory>
#include <string_view>

#include "config/parameter_values.h"
#include "hal/camera_backend.h"
#include "hal/clock.h"
#include "hal/pixel_format.h"

namespace pleinair::hal {

/// How camera.source names the cameras of a kind.
enum class CameraNaming {
  kDevices,  ///< "v4l2", "v4l2:ID": devices, which come and go; "auto" looks among these
  kListed,   ///< "synthetic", "synthetic:pan": those that list() gives, which are always there
  kPaths,    ///< the path of a file or folder
};

/// The settings of a back end that are common to all kinds, beside its own table.
struct CameraBackendOptions {
  FrameSize size{640, 480};          ///< of a camera that makes its frames
  Duration framePeriod{33'333'333};  ///< of such a camera
  /// kRealTime: a live source, which goes on for as long as it is read; kStepped: every frame once,
  /// as fast as it is asked for. Devices have a pace of their own.
  Pacing pacing = Pacing::kRealTime;
};

/// The descriptor of a kind of cameras: all that the program knows of it. Each folder under
/// hal/cameras exports one; hal/cameras/CMakeLists.txt lists them
/// (docs/decisions/0023-camera-kinds.md).
struct CameraKind {
  std::string_view name;  ///< "v4l2": in camera.source; its table is [camera.v4l2]
  std::string_view help;  ///< what they are, one line without a full stop
  CameraNaming naming = CameraNaming::kDevices;
  /// The keys of its own table at their defaults; an empty list where it has none.
  config::ParameterValues defaults;
  /// A back end of it, which lists and makes cameras. `own`: of the same list as `defaults`.
  std::unique_ptr<CameraBackend> (*open)(const config::ParameterValues& own,
                                         const CameraBackendOptions& options) = nullptr;
};

}  // namespace pleinair::hal
