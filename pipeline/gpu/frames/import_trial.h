#pragma once

#include <optional>
#include <string>

#include "hal/clock.h"
#include "hal/error.h"
#include "hal/surface.h"
#include "pipeline/gpu/frames/trial_process.h"

namespace pleinair::gpu {

/// Draws the pattern (hal::surfacePatternAt()) into a surface in another process, because software
/// drivers have crashed in memory that they imported without an error (Mesa 22.3, kms_swrast on a
/// render node). That process is this program, started with arguments of its own; its main() has
/// runImportTrial(). Never waits; one thread.
class ImportTrial {
 public:
  /// Starts it. The surface's descriptors stay open until it has ended.
  explicit ImportTrial(const hal::GpuSurface& surface,
                       const hal::Clock& clock = hal::steadyClock());

  /// Nothing while it runs. Error: kUnsupported (it has crashed, failed, or takes too long).
  std::optional<hal::Result<void>> poll();

 private:
  TrialProcess process_;
};

/// Carries out a trial, if the arguments of main() are those of one, and gives the exit status.
std::optional<int> runImportTrial(int argc, const char* const* argv);

}  // namespace pleinair::gpu
