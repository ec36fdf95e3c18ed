#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "config/sections.h"
#include "firmware_app/config/configuration.h"

namespace pleinair::app {

inline constexpr std::string_view kVariablePrefix = "PLEINAIR_";
inline constexpr std::string_view kNoFile = "none";
inline constexpr std::string_view kDefaultLook = "default";
inline constexpr std::string_view kFinishedView = "finished";
inline constexpr std::string_view kStyleKey = "painting.style";
inline constexpr std::string_view kLookKey = "painting.look";
inline constexpr std::string_view kViewKey = "painting.view";

/// The cameras that have a name: "auto", "v4l2", "synthetic:pan" …
std::vector<std::string> cameraNames();
/// The names that go on after a colon: "serial:NUMBER".
std::vector<std::string> openCameraNames();
/// "v4l2:/dev/video0" for "/dev/video0", whether it is there or not; others as they are.
std::string namedCamera(const std::string& source);
/// Whether camera.source is one of either; else it is a recording's path.
bool isCameraName(std::string_view source);

/// Every key that the program knows, at its default: the profile, [camera] with a [camera.…] for
/// each kind, [painting], [output], [runtime], [procedure], [status] and a [style.…] for each
/// style.
config::Sections defaultSections();

// The settings in force of what defaultSections() made.
std::filesystem::path profileOf(const config::Sections& sections);
CameraSettings cameraOf(const config::Sections& sections);
PaintingSettings paintingOf(const config::Sections& sections);
OutputSettings outputOf(const config::Sections& sections);
InputSettings inputOf(const config::Sections& sections);
RuntimeSettings runtimeOf(const config::Sections& sections);
ProcedureSettings procedureOf(const config::Sections& sections);
StatusSettings statusOf(const config::Sections& sections);

}  // namespace pleinair::app
