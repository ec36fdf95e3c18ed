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
  kDevices,  ///< "v4l2", "v4l2:ID": devices, which come and go; "auto" chooses among these
  kListed,   ///< "synthetic", "synthetic:pan": cameras of list(), which are always present
  kPaths,    ///< the path of a file or folder
};

/// The settings that back ends of all kinds have in common.
struct CameraBackendOptions {
  FrameSize size{640, 480};          ///< for a camera that renders its frames
  Duration framePeriod{33'333'333};  ///< for such a camera
  /// kRealTime: an endless live source. kStepped: each frame once, as fast as it is asked for.
  /// Devices ignore it.
  Pacing pacing = Pacing::kRealTime;
};

/// The descriptor of a kind of cameras, all that the program uses of it. Each folder under
/// hal/cameras exports one; hal/cameras/CMakeLists.txt lists them
/// (docs/decisions/0023-camera-kinds.md).
struct CameraKind {
  std::string_view name;  ///< "v4l2": in camera.source; its table is [camera.v4l2]
  std::string_view help;  ///< description, one line without a full stop
  CameraNaming naming = CameraNaming::kDevices;
  /// How the paths of its device nodes begin, which then are names, too: "/dev/video". Empty: none.
  std::string_view nodePrefix = {};
  /// The keys of its own table at their defaults; an empty list if it has none.
  config::ParameterValues defaults;
  /// Makes a back end. `own`: values of the same list as `defaults`.
  std::unique_ptr<CameraBackend> (*open)(const config::ParameterValues& own,
                                         const CameraBackendOptions& options) = nullptr;
};

}  // namespace pleinair::hal
