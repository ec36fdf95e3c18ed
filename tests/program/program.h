#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace pleinair::support {

/// What a run of the program left.
struct ProgramRun {
  int status = 0;  ///< exit status, or −signal
  std::string out;
  std::string error;
  long peakMemoryMebibytes = 0;  ///< resident
};

/// Whether the program was built with a sanitizer, which takes memory of its own.
bool isSanitized();

struct ProgramLimits {
  /// No file may grow beyond this: a full disk, as the program sees it. 0: none.
  unsigned long fileBytes = 0;
  /// No more memory is given to it than so much address space; 0, or with a sanitizer: no limit.
  unsigned long addressSpaceBytes = 0;
  /// It is killed, and the test fails, after so long.
  std::chrono::seconds time{120};
  /// SIGTERM is sent once this file exists; empty: never.
  std::string terminateWhenExists;
  /// What it prints goes into this instead of ProgramRun::out; empty: nowhere else.
  std::string printsInto;
};

/// Runs `pleinair` with these arguments.
ProgramRun runProgram(const std::vector<std::string>& arguments, const ProgramLimits& limits = {});

}  // namespace pleinair::support
