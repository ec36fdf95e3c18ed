#include "hal/media/file_input.h"

#include <cerrno>
#include <cstdio>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pleinair::hal {

Result<FileInput> FileInput::open(const std::filesystem::path& path) {
  // O_NONBLOCK: opening a pipe without a writer must not wait.
  FileInput file(FileDescriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)));
  if (!file.file_) return tl::unexpected(errnoError(path.string(), "cannot open", errno));
  struct stat status = {};
  if (::fstat(file.file_.get(), &status) != 0) {
    return tl::unexpected(errnoError(path.string(), "cannot read", errno));
  }
  if (S_ISFIFO(status.st_mode)) {
    return tl::unexpected(Error{.kind = ErrorKind::kInvalidInput,
                                .subject = path.string(),
                                .problem = "is a pipe",
                                .remedy = "read a movie from standard input: --input - < PIPE"});
  }
  if (!S_ISREG(status.st_mode)) {
    return tl::unexpected(Error{.kind = ErrorKind::kInvalidInput,
                                .subject = path.string(),
                                .problem = "is not a regular file",
                                .remedy = "give a movie, a picture or a folder of pictures"});
  }
  if (status.st_size == 0) {
    return tl::unexpected(Error{.kind = ErrorKind::kInvalidInput,
                                .subject = path.string(),
                                .problem = "is empty",
                                .remedy = "give a movie or a picture"});
  }
  file.sizeBytes_ = status.st_size;
  return file;
}

Result<FileInput> FileInput::standardInput() {
  FileInput file(FileDescriptor(::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0)));
  if (!file.file_) return tl::unexpected(errnoError("standard input", "cannot read", errno));
  file.sizeBytes_ = -1;
  return file;
}

std::int64_t FileInput::readAt(std::int64_t offset, std::uint8_t* bytes, std::size_t count) const {
  if (isStream()) {
    const ssize_t got = ::read(file_.get(), bytes, count);
    return got < 0 ? -errno : std::int64_t{got};
  }
  std::size_t done = 0;
  while (done < count) {
    const ssize_t got =
        ::pread(file_.get(), bytes + done, count - done, offset + static_cast<std::int64_t>(done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return -errno;
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return static_cast<std::int64_t>(done);
}

}  // namespace pleinair::hal
