#pragma once

#include <filesystem>
#include <string>

#include "hal/cameras/synthetic/ground_truth.h"
#include "hal/error.h"
#include "hal/pixel_format.h"

namespace pleinair::app {

/// The scene file for recordings of the synthetic camera: its intrinsics, the tags of its
/// workbench, and models on some of them.
std::string workbenchScene(const hal::GroundTruth& truth, hal::FrameSize size);

/// The part of it without models.
std::string workbenchSetting(const hal::GroundTruth& truth, hal::FrameSize size);

/// Writes workbenchScene() to `path`. Errors as hal::PendingFile.
hal::Result<void> writeWorkbenchScene(const std::filesystem::path& path,
                                      const hal::GroundTruth& truth, hal::FrameSize size);

}  // namespace pleinair::app
