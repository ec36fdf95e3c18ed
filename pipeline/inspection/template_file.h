#pragma once

#include <filesystem>
#include <string>

#include <glm/mat4x4.hpp>

#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::inspection {

/// Where a template was taken: the camera, and the machine before it.
struct TemplatePose {
  tracking::CameraModel camera;
  glm::dmat4 cameraFromModel{1.0};
};

/// The file beside a template's picture: "seal.toml" of "seal.png".
std::filesystem::path templatePosePath(const std::filesystem::path& picture);

/// Reads such a file: the keys of a calibration, and camera_from_model, 16 numbers by rows: a
/// rotation, a translation and a uniform scale. Throws config::ConfigError.
TemplatePose readTemplatePose(const std::filesystem::path& file);
/// The text of such a file.
std::string templatePoseText(const TemplatePose& pose);

}  // namespace pleinair::inspection
