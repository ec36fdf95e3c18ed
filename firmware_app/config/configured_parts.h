#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "firmware_app/cli/path_collisions.h"
#include "firmware_app/config/configuration.h"
#include "firmware_app/config/input_map.h"
#include "firmware_app/offline/painting.h"
#include "firmware_app/status_server/status_server.h"
#include "hal/camera.h"
#include "hal/cameras/synthetic/synthetic_camera.h"
#include "hal/file_descriptor.h"
#include "hal/keyboards/keyboards.h"
#include "pipeline/scene/description/scene.h"

namespace pleinair::app {

// Converts a configuration to options of the parts of the program.

/// `options` with what [painting] and the style's table say.
PaintingOptions configuredPainting(const Configuration& configuration, PaintingOptions options);

/// The scene of a file. Throws as scene::loadScene() does, and says so where the file seems to be a
/// configuration.
scene::Scene sceneOfFile(const std::filesystem::path& file);

/// [painting]'s scene; without one, an empty scene. Throws config::ConfigError.
scene::Scene configuredScene(const Configuration& configuration);

/// [camera], which delivers the painting's size where nobody chose another.
CameraSettings configuredCamera(const Configuration& configuration);
/// Throws config::ConfigError where [camera]'s source is most likely a slip of a name.
void refuseSlipOfCamera(const Configuration& configuration);
bool isSynthetic(const CameraSettings& camera);
/// Whether the camera is of a kind whose cameras are always there (hal::CameraNaming::kListed).
bool isAlwaysThere(const CameraSettings& camera);
/// Whether the source is a path, and no camera's name.
bool isRecording(const CameraSettings& camera);
/// The settings that a back end is made with, beside its kind's table.
hal::CameraBackendOptions backendOptionsOf(const CameraSettings& camera, hal::Pacing pacing);
/// The synthetic camera's options, stepped, whatever the source; the shot is the source's where it
/// names one.
hal::SyntheticOptions syntheticOptions(const CameraSettings& camera);
/// The request to a device: size, rate and controls.
hal::StreamRequest streamRequestOf(const CameraSettings& camera);

/// [input]'s keyboards; nothing where none are read. "auto": all, where there is an output on the
/// console (hal::OutputTraits::isOnConsole) and no window.
std::optional<hal::KeyboardChoice> configuredKeyboards(const Configuration& configuration);

/// [input]'s map; empty where there is none. Throws as readInputMap().
InputMap configuredInputMap(const Configuration& configuration);

/// [status]'s secret for commands; empty where none are taken. Throws hal::Failure for a file that
/// cannot be read, that others may read, or whose secret is short (16 to 200 characters without
/// spaces), and where the server listens beyond this machine. `isPassed`: the server's socket came
/// from a service manager.
std::string configuredToken(const Configuration& configuration, bool isPassed);

/// The status server, started: at `passed`, a socket from the service manager, where there is one,
/// else as [status] says; null where that is off. Throws hal::Failure as startStatusServer().
std::unique_ptr<StatusServer> configuredStatusServer(const Configuration& configuration,
                                                     StatusPages pages,
                                                     hal::FileDescriptor passed = {});

/// The files that the configuration and the scene were read from: nothing may be written over them.
std::vector<NamedPath> configuredFiles(const Configuration& configuration,
                                       const scene::Scene& scene);

}  // namespace pleinair::app
