#include "pipeline/record/record_file.h"

#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pleinair::record {
namespace {

hal::Error failureOf(const std::filesystem::path& path, const char* operation, int errnoValue) {
  std::string remedy;
  if (errnoValue == ENOSPC || errnoValue == EDQUOT || errnoValue == EFBIG) {
    remedy = "free space, then repeat the step";
  }
  return hal::errnoError(path.string(), operation, errnoValue, std::move(remedy));
}

/// Makes a new name in a folder durable.
hal::Result<void> syncFolder(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const hal::FileDescriptor fd(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!fd) return tl::unexpected(failureOf(folder, "cannot open", errno));
  if (fsync(fd.get()) != 0 && errno != EINVAL) {
    return tl::unexpected(failureOf(folder, "cannot sync", errno));
  }
  return {};
}

}  // namespace

RecordSystem RecordSystem::real() {
  return {.write =
              [](int fd, std::string_view bytes) {
                ssize_t written = 0;
                do {
                  written = ::write(fd, bytes.data(), bytes.size());
                } while (written < 0 && errno == EINTR);
                return written < 0 ? ssize_t{-errno} : written;
              },
          .sync = [](int fd) { return fdatasync(fd) == 0 ? 0 : -errno; },
          .truncate = [](int fd, off_t size) { return ftruncate(fd, size) == 0 ? 0 : -errno; }};
}

RecordFile::RecordFile(std::filesystem::path path, hal::FileDescriptor file, std::uint64_t size,
                       RecordSystem system)
    : path_(std::move(path)), file_(std::move(file)), size_(size), system_(std::move(system)) {}

hal::Result<RecordFile> RecordFile::lock(const std::filesystem::path& path,
                                         hal::FileDescriptor file, RecordSystem system) {
  if (!file) return tl::unexpected(failureOf(path, "cannot open", errno));
  if (flock(file.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) return tl::unexpected(failureOf(path, "cannot lock", errno));
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kBusy,
                                     .subject = path.string(),
                                     .problem = "another program writes this record",
                                     .remedy = "end it, or begin another record"});
  }
  struct stat status {};
  if (fstat(file.get(), &status) != 0) {
    return tl::unexpected(failureOf(path, "cannot examine", errno));
  }
  if (!S_ISREG(status.st_mode)) {
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kInvalidArgument,
                                     .subject = path.string(),
                                     .problem = "is not a regular file"});
  }
  return RecordFile(path, std::move(file), static_cast<std::uint64_t>(status.st_size),
                    std::move(system));
}

hal::Result<RecordFile> RecordFile::create(const std::filesystem::path& path, RecordSystem system) {
  constexpr mode_t kMode = 0640;
  hal::FileDescriptor fd(
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, kMode));
  if (!fd && errno == EEXIST) {
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kInvalidArgument,
                                     .subject = path.string(),
                                     .problem = "exists already; a record is never overwritten",
                                     .remedy = "another name"});
  }
  auto file = lock(path, std::move(fd), std::move(system));
  if (!file) return file;
  if (auto synced = syncFolder(path); !synced) return tl::unexpected(std::move(synced.error()));
  return file;
}

hal::Result<RecordFile> RecordFile::open(const std::filesystem::path& path, RecordSystem system) {
  hal::FileDescriptor fd(::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | O_NONBLOCK));
  return lock(path, std::move(fd), std::move(system));
}

hal::Result<void> RecordFile::cutAfter(std::uint64_t size) {
  if (size_ <= size) return {};
  if (const int answer = system_.truncate(file_.get(), static_cast<off_t>(size)); answer != 0) {
    return tl::unexpected(failureOf(path_, "cannot cut", -answer));
  }
  if (const int answer = system_.sync(file_.get()); answer != 0) {
    return tl::unexpected(failureOf(path_, "cannot sync", -answer));
  }
  size_ = size;
  return {};
}

hal::Result<void> RecordFile::append(std::string_view bytes) {
  if (isBroken_) {
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kIo,
                                     .subject = path_.string(),
                                     .problem = "the disk failed earlier",
                                     .remedy = "open the record again"});
  }
  std::string_view rest = bytes;
  int failure = 0;
  while (!rest.empty() && failure == 0) {
    const ssize_t written = system_.write(file_.get(), rest);
    if (written > 0) {
      rest.remove_prefix(static_cast<std::size_t>(written));
    } else {
      failure = written < 0 ? static_cast<int>(-written) : EIO;
    }
  }
  if (failure != 0) {
    // No part of a line stays, so that the next one begins on a line of its own.
    isBroken_ = system_.truncate(file_.get(), static_cast<off_t>(size_)) != 0;
    return tl::unexpected(failureOf(path_, "cannot write", failure));
  }
  if (const int answer = system_.sync(file_.get()); answer != 0) {
    isBroken_ = true;
    return tl::unexpected(failureOf(path_, "cannot sync", -answer));
  }
  size_ += bytes.size();
  return {};
}

}  // namespace pleinair::record
