#pragma once

namespace pleinair::app {

/// Directs warnings and notes to standard error, one per line: "pleinair: warning: …"; to the
/// journal with a level: "<4>…".
void logToStandardError();

/// Reads the command line, runs the subcommand, and returns the exit status: 0; 1 for internal
/// errors and device failures; 2 for arguments, configuration, input and full disks; 128 + the
/// number of the signal that interrupted it. Errors are one line on standard error. A failed write
/// to standard output counts as 2.
int runCommandLine(int argc, const char* const* argv);

}  // namespace pleinair::app
