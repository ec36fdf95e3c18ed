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
#include "hal/error.h"
#include "hal/image.h"
#include "pipeline/measure/input/moved_photograph.h"
#include "pipeline/measure/input/true_motion.h"

namespace pleinair::measure {

/// A sequence that is painted and measured, with its true motion where that is known. One thread.
class MeasuredInput {
 public:
  virtual ~MeasuredInput() = default;
  MeasuredInput() = default;
  MeasuredInput(const MeasuredInput&) = delete;
  MeasuredInput& operator=(const MeasuredInput&) = delete;

  /// For people: the file, the folder or the shot.
  virtual std::string description() const = 0;
  virtual hal::FrameFormat format() const = 0;
  /// Nothing where it goes on as long as is wanted, or does not say.
  virtual std::optional<std::uint64_t> frameCount() const = 0;
  /// Whether it makes as many frames as are asked for.
  virtual bool isEndless() const { return false; }
  /// The next frame; nothing at the end. Errors: of files.
  virtual hal::Result<std::optional<hal::CapturedFrame>> next() = 0;
  /// Null where it is not known. Lives as long as the input.
  virtual TrueMotion* motion() = 0;
  /// What should be known of it: warnings.
  virtual std::vector<std::string> notices() const { return {}; }
};

/// A photograph moved by the program (MovedPhotograph), with sensor noise.
struct PhotographOptions {
  std::optional<hal::FrameSize> size;  ///< default: its own, of 640x480 px or as many at the most
  PhotographMotion motion;
  double noiseLevels = 2.0;
  std::uint64_t frames = 60;
};

/// Errors: as hal::readPictureRgb().
hal::Result<std::unique_ptr<MeasuredInput>> openPhotograph(const std::filesystem::path& path,
                                                           const PhotographOptions& options);

/// A folder of pictures, with the truth that lies beside them: motion.json (motion_file.h), or
/// KITTI flow (kitti_flow.h) in files whose names begin with "flow", from each picture to the next,
/// with masks whose names begin with "occ". Those are not taken for pictures of the sequence.
/// Errors: of files; kInvalidInput (sizes that differ, numbers of files that do not fit together).
hal::Result<std::unique_ptr<MeasuredInput>> openPictureFolder(const std::filesystem::path& folder);

/// Any recording; `motionFile` says how it moves, where it is known. Errors: as hal::Camera.
hal::Result<std::unique_ptr<MeasuredInput>> openPlainRecording(
    const std::filesystem::path& path, const std::optional<std::filesystem::path>& motionFile);

/// The synthetic camera, whose true flow follows from the geometry of its world. Errors: as
/// hal::Camera.
hal::Result<std::unique_ptr<MeasuredInput>> openWorkbench(const hal::SyntheticOptions& options);

}  // namespace pleinair::measure
