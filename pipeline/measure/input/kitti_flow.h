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

/// The flow between two frames as a file has it.
struct KittiFlowField {
  cv::Mat2f px;
  cv::Mat1b seen;  ///< 255 where it is known
};

/// Reads flow as KITTI stores it: a PNG of 16-bit RGB with u = (R − 32768)/64 px, v likewise of G,
/// and B other than 0 where it is valid (Menze and Geiger, 2015). `size` is that of the frames.
/// Errors: as hal::readRgb16(), and kInvalidInput (another size, nothing valid in it).
hal::Result<KittiFlowField> readKittiFlow(const std::filesystem::path& path, cv::Size size);

/// Takes what a mask shows (other than black) out of what is seen. Errors: as
/// hal::readPictureRgb(), and kInvalidInput (another size).
hal::Result<void> maskOut(KittiFlowField& field, const std::filesystem::path& occlusions);

/// The motion of a sequence of which there is a flow file from each frame to the next, and, where
/// `occlusions` is not empty, a mask of what is hidden in the next for each. Flows over several
/// frames are composed. Keeps a dozen fields in memory.
std::unique_ptr<TrueMotion> flowSequence(cv::Size frame, std::vector<std::filesystem::path> flows,
                                         std::vector<std::filesystem::path> occlusions);

}  // namespace pleinair::measure
