#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hal/clock.h"
#include "hal/error.h"
#include "hal/image.h"

namespace pleinair::hal {

/// What the pipeline offers to an output.
struct OutputRequest {
  FrameSize size;
  std::optional<Duration> framePeriod;  ///< nominal, where the source has one
};

/// What the output takes. The pipeline scales and converts to it (pipeline/present).
struct OutputFormat {
  FrameFormat frame;
  std::optional<Duration> refreshPeriod;  ///< of a display; unset where there is none
};

struct OutputIdentity {
  std::string backend;  ///< "movie", "frames", "headless" …
  std::string id;       ///< path or device
};

/// A sink that takes pictures in memory: movie, frames, loopback, preview. One conformance suite
/// holds them all (tests/conformance/output_conformance.h). All calls come from one thread.
///
/// An output to files writes under temporary names and publishes in finish(): until then, and if it
/// is destroyed without, nothing stands under the final name, and what stood there before still
/// does. A folder of frames publishes each whole frame as it comes.
class MemoryOutput {
 public:
  virtual ~MemoryOutput() = default;
  MemoryOutput() = default;
  MemoryOutput(const MemoryOutput&) = delete;
  MemoryOutput& operator=(const MemoryOutput&) = delete;

  virtual OutputIdentity identity() const = 0;

  /// Opens. Called once, before write(). Errors: kPermissionDenied, kNotFound (no such folder),
  /// kNoSpace, kUnsupported (size), kIo.
  virtual Result<OutputFormat> start(const OutputRequest& request) = 0;

  /// Takes one picture of the format that start() answered; copies what it keeps. `time` is the
  /// capture time since the first picture's and rises strictly. Errors: kNoSpace, kIo,
  /// kDeviceLost; after one, only destruction is allowed.
  virtual Result<void> write(const ImageView& picture, Duration time) = 0;

  /// How many of the pictures that write() took were dropped, because whoever reads them was too
  /// slow; of outputs to devices that must not be waited for.
  virtual std::uint64_t skippedPictures() const { return 0; }

  /// Completes and publishes. Errors as write(). Afterwards only destruction is allowed.
  virtual Result<void> finish() = 0;
};

}  // namespace pleinair::hal
