#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>

#include <sys/mman.h>
#include <unistd.h>

#include "hal/image.h"

/// Each target defines this function, which reads one input to its end. Returns 0, or −1 to keep
/// the input out of libFuzzer's corpus. Any result but success or a clear error is a finding.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace pleinair::fuzz {

inline std::string_view asText(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Ends the process as a sanitizer does, so that libFuzzer saves the input.
[[noreturn]] inline void fail(const std::string& why) {
  std::fprintf(stderr, "finding: %s\n", why.c_str());
  std::abort();
}

/// An error must be one line without control characters, whatever the input.
inline void expectOneLine(std::string_view message) {
  const bool isClean = std::ranges::none_of(message, [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 || byte == 0x7F;
  });
  if (!isClean || message.empty()) fail("not one printable line: " + std::string(message));
}

/// Reads every byte of an image, for the address sanitizer to check.
inline std::uint32_t touch(const hal::ImageView& picture) {
  if (!picture.isComplete()) fail("an incomplete picture");
  std::uint32_t sum = 0;
  for (int plane = 0; plane < hal::planeCount(picture.format.pixelFormat); ++plane) {
    const int rows = hal::planeRows(picture.format.pixelFormat, plane, picture.format.size.height);
    for (int y = 0; y < rows; ++y) {
      for (const std::uint8_t byte : picture.row(plane, y)) sum += byte;
    }
  }
  return sum;
}

/// A file in memory with the input's bytes, for code that reads files.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size) : fd_(memfd_create("input", MFD_CLOEXEC)) {
    if (fd_ < 0) throw std::runtime_error("no memory file");
    const ssize_t written = write(fd_, data, size);
    if (written != static_cast<ssize_t>(size)) throw std::runtime_error("no room for the input");
  }
  ~MemoryFile() { close(fd_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string path() const { return "/proc/self/fd/" + std::to_string(fd_); }

 private:
  int fd_;
};

}  // namespace pleinair::fuzz
