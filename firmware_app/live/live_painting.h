#pragma once

#include "firmware_app/live/live_job.h"

namespace pleinair::app {

/// Runs the job until its frames are shown, the recording ends, the window is closed, or a key or a
/// signal ends it; then completes the outputs, prints the ledger on standard output and returns 0.
/// It waits for a lost camera or GPU, and for outputs that can be opened again. Throws hal::Failure
/// and config::ConfigError; if an output failed for good, after printing the ledger.
///
/// Outputs of kinds that show waiting pictures are opened, and show one, before the camera is
/// opened and the GL context is made.
///
/// It ends within two seconds of a signal, which the caller's Interrupt receives. If a thread hangs
/// in a driver or at a disk, the process exits here, with status 1, or 0 if nothing is lost:
/// nothing had been painted yet, or a procedure was being read again.
int runLive(const LiveJob& job);

}  // namespace pleinair::app
