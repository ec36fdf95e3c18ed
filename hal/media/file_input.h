#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <utility>

#include "hal/error.h"
#include "hal/file_descriptor.h"
#include "hal/media/handles.h"

namespace pleinair::hal::libav {

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

/// An AVIOContext over a FileInput. A demuxer that reads through it can open no other file.
class DemuxerIo {
 public:
  explicit DemuxerIo(FileInput file);
  AVIOContext* context() { return io_.get(); }
  const FileInput& file() const { return state_->file; }

 private:
  struct State {
    FileInput file;
    std::int64_t position = 0;
  };
  static int read(void* opaque, std::uint8_t* buffer, int size);
  static std::int64_t seek(void* opaque, std::int64_t offset, int whence);

  std::unique_ptr<State> state_;
  IoContext io_;
};

}  // namespace pleinair::hal::libav
