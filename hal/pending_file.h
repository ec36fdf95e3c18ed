#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

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
  /// Waits until the written data has reached the disk, if the file system reports it.
  virtual int sync(int fd) = 0;
  virtual int rename(const std::filesystem::path& from, const std::filesystem::path& to) = 0;
  virtual int unlink(const std::filesystem::path& path) = 0;
};

/// The kernel's file system; stateless, any thread.
FileSystem& systemFiles();

/// The partial files in a folder that no process writes any more: ".name.part", left by runs that
/// were killed. Empty where the folder cannot be listed.
std::vector<std::filesystem::path> stalePartsIn(const std::filesystem::path& folder);

/// The name that a partial file would have taken: "out.mp4" of ".out.mp4.part" and of
/// ".out.mp4.2.part"; empty for another name.
std::string finalNameOf(const std::filesystem::path& part);

/// Whether the data must be on the disk before the file takes its name. If so, a power loss never
/// leaves an empty file, but publish() waits for the disk.
enum class Durability { kSynced, kUnsynced };

/// A file that is written under a temporary name (".name.part" in the same folder, or
/// ".name.2.part" and so on while another writer holds that name) and takes its final name in
/// publish(). If two writers publish, the later file stays. Destruction without publish() removes
/// the temporary file and leaves an existing file of that name alone. A symbolic link to a file
/// stays a link: its target is replaced.
class PendingFile {
 public:
  /// Errors: kNotFound (no such folder), kPermissionDenied, kInvalidArgument (`path` is a folder, a
  /// device or anything else but a regular file), kNoSpace, kIo. `files` must outlive this object.
  static Result<PendingFile> create(const std::filesystem::path& path,
                                    FileSystem& files = systemFiles());

  PendingFile(PendingFile&& other) noexcept = default;
  PendingFile& operator=(PendingFile&&) = delete;
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;
  ~PendingFile();

  /// Writes all of `bytes`. Errors: kNoSpace, kIo.
  Result<void> write(std::span<const std::uint8_t> bytes);
  /// Moves the write position like lseek and gives the new offset. Errors: kIo.
  Result<std::int64_t> seek(std::int64_t offset, int whence);
  /// Writes the data to the disk (kSynced), renames the file and closes it. Errors: kNoSpace (some
  /// file systems report it only here), kIo.
  Result<void> publish(Durability durability = Durability::kSynced);

 private:
  PendingFile(std::filesystem::path path, std::filesystem::path target, FileSystem& files);
  Result<void> createTemporary();
  Error failure(const char* operation, std::int64_t minusErrno) const;

  std::filesystem::path path_;    ///< as given by the caller, for messages
  std::filesystem::path target_;  ///< with links resolved
  std::filesystem::path temporary_;
  FileSystem* files_;
  FileDescriptor file_;
};

}  // namespace pleinair::hal
