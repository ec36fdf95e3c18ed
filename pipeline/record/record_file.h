#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include <sys/types.h>

#include "hal/error.h"
#include "hal/file_descriptor.h"

namespace pleinair::record {

/// The system calls that a record is written with, so that power cuts and full disks are unit
/// tests. Each answers as the system's does, but −errno in place of −1.
struct RecordSystem {
  std::function<ssize_t(int fd, std::string_view bytes)> write;
  std::function<int(int fd)> sync;  ///< fdatasync()
  std::function<int(int fd, off_t size)> truncate;

  /// The kernel's.
  static RecordSystem real();
};

/// A file of lines that is only appended to, by one process at a time (flock). Each line is on the
/// disk when append() returns. One thread at a time.
class RecordFile {
 public:
  /// Creates the file, and its name in the folder, durably. Errors: kInvalidArgument (it is there
  /// already), kNotFound (no such folder), kPermissionDenied, kNoSpace, kBusy, kIo.
  static hal::Result<RecordFile> create(const std::filesystem::path& path,
                                        RecordSystem system = RecordSystem::real());
  /// Opens the file to go on at its end. Errors: as above, but kNotFound where there is no file.
  static hal::Result<RecordFile> open(const std::filesystem::path& path,
                                      RecordSystem system = RecordSystem::real());

  /// Cuts off what follows the first `size` bytes. Error: kIo.
  hal::Result<void> cutAfter(std::uint64_t size);

  /// Writes all bytes and waits for the disk. After an error, the file is as it was before, and the
  /// call can be tried again when there is space; except that after a failed sync, or where the
  /// file cannot be cut back, every further call fails (kIo): what the disk holds is not known
  /// then.
  hal::Result<void> append(std::string_view bytes);

  std::uint64_t size() const { return size_; }

 private:
  RecordFile(std::filesystem::path path, hal::FileDescriptor file, std::uint64_t size,
             RecordSystem system);
  static hal::Result<RecordFile> lock(const std::filesystem::path& path, hal::FileDescriptor file,
                                      RecordSystem system);

  std::filesystem::path path_;
  hal::FileDescriptor file_;
  std::uint64_t size_ = 0;
  bool isBroken_ = false;
  RecordSystem system_;
};

}  // namespace pleinair::record
