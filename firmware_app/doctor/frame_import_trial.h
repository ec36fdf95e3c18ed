#pragma once

#include <string>

#include "hal/clock.h"

namespace pleinair::app::doctor {

/// How camera frames would reach the GPU.
struct FrameImportVerdict {
  bool isImported = false;  ///< the GPU reads memory that it shares with a camera
  std::string reason;       ///< the memory; or why frames are uploaded
  hal::Duration took{0};    ///< the trial
};

/// Tries it as `run` does, with a frame in memory of each allocator that this machine has, in a
/// process of its own on a software renderer. Opens no camera; waits for some 100 ms.
FrameImportVerdict tryFrameImport();

}  // namespace pleinair::app::doctor
