#pragma once

#include <cstdint>
#include <filesystem>
#include <utility>

#include "hal/error.h"
#include "hal/file_descriptor.h"

namespace pleinair::hal {

/// A regular file opened for reading; its name is never interpreted as a URL. Other pipes than
/// standard input, and devices, are refused, since they could block.
class FileInput {
 public:
  /// Standard input, which is read from where it is. Error: kIo.
  static Result<FileInput> standardInput();
  /// Errors: kNotFound, kPermissionDenied, kInvalidInput (not a file, or empty), kIo.
  static Result<FileInput> open(const std::filesystem::path& path);

  /// −1 for standard input.
  std::int64_t sizeBytes() const { return sizeBytes_; }
  bool isStream() const { return sizeBytes_ < 0; }
  /// Reads up to `count` bytes at `offset`; fewer at the end, −errno on an error. Of standard
  /// input, the next bytes; −EINTR where a signal came.
  std::int64_t readAt(std::int64_t offset, std::uint8_t* bytes, std::size_t count) const;

 private:
  explicit FileInput(FileDescriptor file) : file_(std::move(file)) {}

  FileDescriptor file_;
  std::int64_t sizeBytes_ = 0;
};

}  // namespace pleinair::hal
