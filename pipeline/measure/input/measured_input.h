#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/cameras/synthetic/synthetic_camera.h"
#include "hal/captured_frame.h"
#include "hal/clock.h"
#include "hal/error.h"
#include "hal/image.h"
#include "pipeline/measure/input/moved_photograph.h"
#include "pipeline/measure/input/true_motion.h"
#include "pipeline/measure/input/walking_cutout.h"

namespace pleinair::measure {

/// Frame period of inputs without times of their own.
inline constexpr hal::Duration kFramePeriod{33'333'333};

/// A sequence to paint and measure, with its true motion if that is known. One thread.
class MeasuredInput {
 public:
  virtual ~MeasuredInput() = default;
  MeasuredInput() = default;
  MeasuredInput(const MeasuredInput&) = delete;
  MeasuredInput& operator=(const MeasuredInput&) = delete;

  /// For people: the file, the folder or the shot.
  virtual std::string description() const = 0;
  virtual hal::FrameFormat format() const = 0;
  /// Nothing if the input is endless or its length is unknown.
  virtual std::optional<std::uint64_t> frameCount() const = 0;
  /// Whether it delivers as many frames as are requested.
  virtual bool isEndless() const { return false; }
  /// Returns the next frame, or nothing at the end. Errors: those of files.
  virtual hal::Result<std::optional<hal::CapturedFrame>> next() = 0;
  /// Null if the motion is unknown. Lives as long as the input.
  virtual TrueMotion* motion() = 0;
  /// Null if the true movers are unknown. Lives as long as the input.
  virtual TrueMovers* movers() { return nullptr; }
  /// Warnings about the input.
  virtual std::vector<std::string> notices() const { return {}; }
};

/// A photograph moved by the program (MovedPhotograph), with sensor noise.
struct PhotographOptions {
  /// Default: its own, reduced to at most the pixels of 640x480.
  std::optional<hal::FrameSize> size;
  PhotographMotion motion;
  double noiseLevels = 2.0;
  std::uint64_t frames = 60;            ///< without a walker
  std::optional<WalkerOptions> walker;  ///< then the input ends when it has passed
  hal::Duration period = kFramePeriod;
};

/// Errors: as hal::readPictureRgb(); kInvalidInput too where nothing of the walker is opaque.
/// Precondition: with a walker, the photograph does not move.
hal::Result<std::unique_ptr<MeasuredInput>> openPhotograph(const std::filesystem::path& path,
                                                           const PhotographOptions& options);

/// Opens a folder of pictures with the ground truth beside them: motion.json (motion_file.h), or
/// KITTI flow (kitti_flow.h) in files whose names begin with "flow", from each picture to the next,
/// with masks whose names begin with "occ". Such files do not count as pictures of the sequence.
/// Errors: those of files; kInvalidInput (different sizes, numbers of files that do not match).
hal::Result<std::unique_ptr<MeasuredInput>> openPictureFolder(const std::filesystem::path& folder);

/// Opens any recording; `motionFile` gives its motion, if known. Errors: as hal::Camera.
hal::Result<std::unique_ptr<MeasuredInput>> openPlainRecording(
    const std::filesystem::path& path, const std::optional<std::filesystem::path>& motionFile);

/// Opens the synthetic camera, whose true flow is computed from the geometry of its world. Errors:
/// as hal::Camera.
hal::Result<std::unique_ptr<MeasuredInput>> openWorkbench(const hal::SyntheticOptions& options);

}  // namespace pleinair::measure
