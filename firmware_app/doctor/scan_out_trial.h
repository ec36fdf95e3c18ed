#pragma once

#include <string>

#include "hal/clock.h"

namespace pleinair::app::doctor {

/// How pictures would reach the memory that a display scans out.
struct ScanOutVerdict {
  bool isDirect = false;  ///< the GPU draws into it; else they are copied
  std::string reason;     ///< why they are copied; of direct ones, the layout
  hal::Duration took{0};  ///< the trial
};

/// Tries it as `run` does, with a small buffer of the display's card: `target` is a display's. The
/// drawing is done in a process of its own. Takes no display; waits for some 100 ms.
ScanOutVerdict tryScanOut(const std::string& target);

/// "the GPU draws straight into its memory, rows (linear)", or "pictures are copied: …".
std::string textOf(const ScanOutVerdict& verdict);

}  // namespace pleinair::app::doctor
