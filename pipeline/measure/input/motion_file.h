#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include "hal/error.h"
#include "pipeline/measure/input/true_motion.h"

namespace pleinair::measure {

/// The contents of a motion.json: {"v": [vx, vy]}, px per frame, or {"homographies": [[9 numbers],
/// …]}, row by row, each of which maps pixels of a frame (centres at whole numbers) to the next
/// one's.
struct MotionFile {
  std::optional<cv::Point2d> perFrame;
  std::vector<cv::Matx33d> nextFromFrame;  ///< if perFrame is not set
};

/// Errors: kInvalidInput (not JSON, a missing or unknown key, invalid numbers), which names
/// `subject`.
hal::Result<MotionFile> parseMotion(std::string_view text, const std::string& subject);
/// Reads the same from a file. Errors: kNotFound, kPermissionDenied, kIo too.
hal::Result<MotionFile> readMotion(const std::filesystem::path& path);

/// The motion of frames of this size. Errors: kInvalidInput (fewer homographies than `frames`
/// need).
hal::Result<std::unique_ptr<TrueMotion>> motionOf(const MotionFile& file, cv::Size frame,
                                                  std::uint64_t frames, const std::string& subject);

}  // namespace pleinair::measure
