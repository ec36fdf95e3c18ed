#pragma once

#include <filesystem>

#include "config/toml_reader.h"
#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::tracking {

/// Reads a camera's calibration (TOML):
///
///     image_size = [1280, 720]
///     fx = 1050.0
///     fy = 1052.0
///     cx = 636.8
///     cy = 364.1
///     pixel_centres = "integer"      # as OpenCV counts; "half" (the default): centres at +0.5
///     distortion = [0, 0, 0, 0, 0]   # k1 k2 p1 p2 k3 [k4 k5 k6], OpenCV's; none if left out
///
/// Throws config::ConfigError.
CameraModel loadCalibration(const std::filesystem::path& path);

/// Reads the same keys from a table that may hold others. The caller calls finish() on the table.
CameraModel readCalibration(const config::TomlTable& table);

}  // namespace pleinair::tracking
