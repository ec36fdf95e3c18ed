#pragma once

namespace pleinair::app {

/// Warnings and notes go to standard error, one a line: "pleinair: warning: …".
void logToStandardError();

/// Reads the command line, runs the command, and returns the exit status: 0; 1 for internal errors
/// and devices; 2 for arguments, configuration, input and full disks; 128 + a signal that broke it
/// off. Errors are one line on standard error. Standard output that does not take what is printed
/// (a full disk) counts as an error of the caller's.
int runCommandLine(int argc, const char* const* argv);

}  // namespace pleinair::app
