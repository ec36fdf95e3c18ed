#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include <sys/types.h>

#include "hal/error.h"
#include "hal/file_descriptor.h"

namespace pleinair::hal {

/// The system calls that writing files needs, so that a full disk is a unit test. Each answers as
/// the system's does, but −errno in place of −1, and retries EINTR.
class FileSystem : public DescriptorCloser {
 public:
  /// A file descriptor of an empty file, which others cannot create while it is open; what a
  /// process that died left is replaced. −EEXIST where it is open elsewhere, or no regular file.
  virtual int create(const std::filesystem::path& path) = 0;
  virtual ssize_t write(int fd, std::span<const std::uint8_t> bytes) = 0;
  virtual std::int64_t seek(int fd, std::int64_t offset, int whence) = 0;
  /// Until what was written has reached the disk, where the file system can say so.
  virtual int sync(int fd) = 0;
  virtual int rename(const std::filesystem::path& from, const std::filesystem::path& to) = 0;
  virtual int unlink(const std::filesystem::path& path) = 0;
};

/// The real one; stateless, any thread.
FileSystem& systemFiles();

/// Whether a file has to be on the disk before it takes its name: then a loss of power never leaves
/// an empty file there, at the cost of waiting for the disk.
enum class Durability { kSynced, kUnsynced };

/// A file that is written under a temporary name (".name.part" in the same folder; ".name.2.part"
/// and so on while another writer has that) and takes its own name in publish(): of two writers,
/// the later one's stands. Destroyed without, it removes what it wrote; what stood under the name
/// before stays. A symbolic link to a file stays a link: the file that it leads to is replaced.
class PendingFile {
 public:
  /// Errors: kNotFound (no such folder), kPermissionDenied, kInvalidArgument (a folder, a device or
  /// anything else but a regular file stands there), kNoSpace, kIo. `files` must outlive this.
  static Result<PendingFile> create(const std::filesystem::path& path,
                                    FileSystem& files = systemFiles());

  PendingFile(PendingFile&& other) noexcept = default;
  PendingFile& operator=(PendingFile&&) = delete;
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;
  ~PendingFile();

  /// All of `bytes`. Errors: kNoSpace, kIo.
  Result<void> write(std::span<const std::uint8_t> bytes);
  /// As lseek; the new offset. Errors: kIo.
  Result<std::int64_t> seek(std::int64_t offset, int whence);
  /// Brings it to the disk, renames and closes. Errors: kNoSpace (some file systems say so only
  /// now), kIo.
  Result<void> publish(Durability durability = Durability::kSynced);

 private:
  PendingFile(std::filesystem::path path, std::filesystem::path target, FileSystem& files);
  Result<void> createTemporary();
  Error failure(const char* operation, std::int64_t minusErrno) const;

  std::filesystem::path path_;    ///< as given, for messages
  std::filesystem::path target_;  ///< links followed
  std::filesystem::path temporary_;
  FileSystem* files_;
  FileDescriptor file_;
};

}  // namespace pleinair::hal
