#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace pleinair::support {

/// The result of a run of the program.
struct ProgramRun {
  int status = 0;  ///< exit status, or −signal
  std::string out;
  std::string error;
  long peakMemoryMebibytes = 0;  ///< resident
};

/// Whether the program was built with a sanitizer, which takes memory of its own.
bool isSanitized();

/// What the standard streams are.
enum class Streams {
  kPipes,         ///< read by the test
  kClosedError,   ///< standard error is closed
  kClosed,        ///< all are closed
  kBrokenPipes,   ///< standard output's and error's readers are gone
  kBrokenOutput,  ///< standard output's reader is gone
};

struct ProgramLimits {
  /// No file may grow beyond this: a full disk, as the program sees it. 0: none.
  unsigned long fileBytes = 0;
  /// The program's file; empty: the built one.
  std::string program = {};
  /// No more memory is given to it than so much address space; 0, or with a sanitizer: no limit.
  unsigned long addressSpaceBytes = 0;
  /// How many file descriptors it may have; 0: no limit.
  unsigned long fileDescriptors = 0;
  /// It is killed, and the test fails, after so long.
  std::chrono::seconds time{120};
  /// SIGTERM is sent once this file exists; empty: never.
  std::string terminateWhenExists;
  /// The file that takes its standard output, instead of ProgramRun::out; empty: none.
  std::string printsInto;
  /// What is its standard input, instead of the test's; empty: the test's.
  std::string readsFrom = {};
  Streams streams = Streams::kPipes;
  /// Keeps the line that says that shaders are compiled, which depends on the driver's cache, in
  /// ProgramRun::error.
  bool keepsCompileNotice = false;
  /// "NAME=VALUE" sets a variable, "NAME" takes it away. Without, the environment is the test's,
  /// with no variable of the program's but an empty PLEINAIR_CONFIG: what the machine is set up for
  /// does not count.
  std::vector<std::string> environment = {};
  /// It cannot have sockets of IPv4 and IPv6, as in the sandbox of a service.
  bool withoutInternet = false;
  /// Its working directory is one that was removed.
  bool inRemovedFolder = false;
  /// Called beside the program, on a thread of its own, with the program's process.
  std::function<void(pid_t)> meanwhile;
};

/// Runs `pleinair` with these arguments.
ProgramRun runProgram(const std::vector<std::string>& arguments, const ProgramLimits& limits = {});

}  // namespace pleinair::support
