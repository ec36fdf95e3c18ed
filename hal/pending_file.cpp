#include "hal/pending_file.h"

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace pleinair::hal {
namespace {

template <class Call>
auto retried(Call call) {
  auto result = call();
  while (result < 0 && errno == EINTR) result = call();
  return result < 0 ? static_cast<decltype(result)>(-errno) : result;
}

class SystemFiles final : public FileSystem {
 public:
  int create(const std::filesystem::path& path) override {
    constexpr mode_t kEverybodySubjectToUmask = 0666;
    return retried([&] {
      return ::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW,
                    kEverybodySubjectToUmask);
    });
  }
  ssize_t write(int fd, std::span<const std::uint8_t> bytes) override {
    return retried([&] { return ::write(fd, bytes.data(), bytes.size()); });
  }
  std::int64_t seek(int fd, std::int64_t offset, int whence) override {
    return retried([&] { return std::int64_t{::lseek(fd, offset, whence)}; });
  }
  int close(int fd) override {
    // After EINTR the descriptor is gone all the same on Linux: never close twice.
    return ::close(fd) < 0 && errno != EINTR ? -errno : 0;
  }
  int rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
    return retried([&] { return ::rename(from.c_str(), to.c_str()); });
  }
  int unlink(const std::filesystem::path& path) override {
    return retried([&] { return ::unlink(path.c_str()); });
  }
};

std::string remedyFor(int errnoValue) {
  switch (errnoValue) {
    case ENOSPC:
    case EDQUOT:
      return "free space or choose another place";
    case ENOENT:
    case ENOTDIR:
      return "create its folder first";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a place that may be written to";
    default:
      return {};
  }
}

}  // namespace

FileSystem& systemFiles() {
  static SystemFiles files;
  return files;
}

PendingFile::PendingFile(std::filesystem::path path, FileSystem& files)
    : path_(std::move(path)), temporary_(path_), files_(&files) {
  temporary_.replace_filename("." + path_.filename().string() + ".part");
}

PendingFile::PendingFile(PendingFile&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_(std::move(other.temporary_)),
      files_(other.files_),
      fd_(std::exchange(other.fd_, -1)) {}

PendingFile::~PendingFile() {
  if (fd_ < 0) return;
  files_->close(fd_);
  files_->unlink(temporary_);
}

Error PendingFile::failure(const char* operation, std::int64_t minusErrno) const {
  const int value = static_cast<int>(-minusErrno);
  return errnoError(path_.string(), operation, value, remedyFor(value));
}

Result<PendingFile> PendingFile::create(const std::filesystem::path& path, FileSystem& files) {
  PendingFile file(path, files);
  std::error_code ignored;
  if (!path.has_filename() || std::filesystem::is_directory(path, ignored)) {
    return tl::unexpected(Error{.kind = ErrorKind::kInvalidArgument,
                                .subject = path.string(),
                                .problem = "cannot write: it is a folder",
                                .remedy = "name a file in it"});
  }
  file.fd_ = files.create(file.temporary_);
  if (file.fd_ < 0) return tl::unexpected(file.failure("cannot write", file.fd_));
  return file;
}

Result<void> PendingFile::write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = files_->write(fd_, bytes);
    if (written < 0) return tl::unexpected(failure("cannot write", written));
    if (written == 0) return tl::unexpected(failure("cannot write", -EIO));
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return {};
}

Result<std::int64_t> PendingFile::seek(std::int64_t offset, int whence) {
  const std::int64_t position = files_->seek(fd_, offset, whence);
  if (position < 0) return tl::unexpected(failure("cannot seek", position));
  return position;
}

Result<void> PendingFile::publish() {
  const int closed = files_->close(std::exchange(fd_, -1));
  const int renamed = closed < 0 ? closed : files_->rename(temporary_, path_);
  if (renamed < 0) {
    files_->unlink(temporary_);
    return tl::unexpected(failure("cannot write", renamed));
  }
  return {};
}

}  // namespace pleinair::hal
