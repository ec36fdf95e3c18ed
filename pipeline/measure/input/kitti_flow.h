#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "hal/error.h"
#include "pipeline/measure/input/true_motion.h"

namespace pleinair::measure {

/// The flow between two frames, as in a file.
struct KittiFlowField {
  cv::Mat2f px;
  cv::Mat1b seen;  ///< 255 where it is known
};

/// Reads flow in KITTI's format: a PNG of 16-bit RGB with u = (R − 32768)/64 px, v likewise from G,
/// and B other than 0 where it is valid (Menze and Geiger, 2015). `size` is that of the frames.
/// Errors: as hal::readRgb16(), and kInvalidInput (another size, no valid pixel).
hal::Result<KittiFlowField> readKittiFlow(const std::filesystem::path& path, cv::Size size);

/// Clears `seen` where a mask is not black. Errors: as hal::readPictureRgb(), and kInvalidInput
/// (another size).
hal::Result<void> maskOut(KittiFlowField& field, const std::filesystem::path& occlusions);

/// The motion of a sequence with a flow file from each frame to the next. If `occlusions` is not
/// empty, it has a mask per flow of pixels hidden in the next frame. Flows over several frames are
/// composed. Keeps a dozen fields in memory.
std::unique_ptr<TrueMotion> flowSequence(cv::Size frame, std::vector<std::filesystem::path> flows,
                                         std::vector<std::filesystem::path> occlusions);

}  // namespace pleinair::measure
