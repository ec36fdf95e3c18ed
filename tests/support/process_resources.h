#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <malloc.h>
#include <unistd.h>

namespace pleinair::support {

/// The resources of this process.
struct ProcessResources {
  std::size_t descriptors = 0;
  std::size_t threads = 0;
  std::size_t residentKiB = 0;  ///< resident memory

  static ProcessResources now() {
    const auto count = [](const char* folder) {
      return static_cast<std::size_t>(
          std::distance(std::filesystem::directory_iterator(folder), {}));
    };
    std::size_t pages = 0;
    std::size_t resident = 0;
    std::ifstream("/proc/self/statm") >> pages >> resident;
    const auto pageBytes = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    return {.descriptors = count("/proc/self/fd"),
            .threads = count("/proc/self/task"),
            .residentKiB = resident * pageBytes / 1024};
  }

  /// Bytes that are allocated now.
  static std::size_t allocatedBytes() { return mallinfo2().uordblks; }
};

}  // namespace pleinair::support
