#include "hal/pending_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
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
    const int fd = retried([&] {
      return ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK,
                    kEverybodySubjectToUmask);
    });
    if (fd == -ELOOP || fd == -EISDIR || fd == -ENXIO) return -EEXIST;
    if (fd < 0) return fd;
    FileDescriptor file(fd);
    // The lock ends with the process, however that ends: a file that nobody has locked is stale.
    // Where a file system knows no locks, the file is taken for stale.
    const int locked = retried([&] { return ::flock(fd, LOCK_EX | LOCK_NB); });
    const bool ours = locked != -EWOULDBLOCK && isRegularFileAt(fd, path);
    const int emptied = ours ? retried([&] { return ::ftruncate(fd, 0); }) : -EEXIST;
    return emptied == 0 ? file.release() : emptied;
  }
  ssize_t write(int fd, std::span<const std::uint8_t> bytes) override {
    return retried([&] { return ::write(fd, bytes.data(), bytes.size()); });
  }
  std::int64_t seek(int fd, std::int64_t offset, int whence) override {
    return retried([&] { return std::int64_t{::lseek(fd, offset, whence)}; });
  }
  int sync(int fd) override {
    const int synced = retried([&] { return ::fsync(fd); });
    const bool cannotSay = synced == -EINVAL || synced == -ENOSYS || synced == -EROFS;
    return cannotSay ? 0 : synced;
  }
  int close(int fd) override { return systemCloser().close(fd); }
  int rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
    return retried([&] { return ::rename(from.c_str(), to.c_str()); });
  }
  int unlink(const std::filesystem::path& path) override {
    return retried([&] { return ::unlink(path.c_str()); });
  }

 private:
  /// Checks the file again: between open() and flock() another writer may have published or removed
  /// it.
  static bool isRegularFileAt(int fd, const std::filesystem::path& path) {
    struct stat opened = {};
    struct stat named = {};
    return ::fstat(fd, &opened) == 0 && ::lstat(path.c_str(), &named) == 0 &&
           S_ISREG(opened.st_mode) && opened.st_dev == named.st_dev &&
           opened.st_ino == named.st_ino;
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
      return "choose a place with write permission";
    default:
      return {};
  }
}

Error notWritable(const std::filesystem::path& path, std::string problem, std::string remedy) {
  return Error{.kind = ErrorKind::kInvalidArgument,
               .subject = path.string(),
               .problem = "cannot write: " + std::move(problem),
               .remedy = std::move(remedy)};
}

/// The path that publish() replaces: `path`, or the target of the symbolic link there.
Result<std::filesystem::path> targetOf(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (!path.has_filename() || std::filesystem::is_directory(status)) {
    return tl::unexpected(notWritable(path, "it is a folder", "name a file in it"));
  }
  const bool isLink = std::filesystem::is_symlink(std::filesystem::symlink_status(path, ignored));
  const bool isRegular = std::filesystem::is_regular_file(status);
  if (!isRegular && (isLink || std::filesystem::exists(status))) {
    return tl::unexpected(notWritable(
        path, isLink ? "it is a link and does not lead to a file" : "it is not a regular file",
        "give another name"));
  }
  if (!isLink) return path;
  std::error_code failed;
  std::filesystem::path target = std::filesystem::canonical(path, failed);
  if (failed) return tl::unexpected(errnoError(path.string(), "cannot write", failed.value()));
  return target;
}

}  // namespace

FileSystem& systemFiles() {
  static SystemFiles files;
  return files;
}

std::string finalNameOf(const std::filesystem::path& part) {
  constexpr std::string_view kEnding = ".part";
  std::string name = part.filename().string();
  if (!name.starts_with('.') || !name.ends_with(kEnding)) return {};
  name = name.substr(1, name.size() - 1 - std::min(name.size() - 1, kEnding.size()));
  const std::size_t dot = name.rfind('.');
  const std::string number = dot == std::string::npos ? "" : name.substr(dot + 1);
  const bool isNumbered =
      !number.empty() && std::ranges::all_of(number, [](char c) { return c >= '0' && c <= '9'; });
  return isNumbered ? name.substr(0, dot) : name;
}

std::vector<std::filesystem::path> stalePartsIn(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> stale;
  std::error_code status;
  for (std::filesystem::directory_iterator entry(folder, status), end; !status && entry != end;
       entry.increment(status)) {
    if (finalNameOf(entry->path()).empty()) continue;
    const FileDescriptor file(retried([&] {
      return ::open(entry->path().c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    }));
    struct stat opened = {};
    if (!file || ::fstat(file.get(), &opened) != 0 || !S_ISREG(opened.st_mode)) continue;
    if (retried([&] { return ::flock(file.get(), LOCK_SH | LOCK_NB); }) == 0) {
      stale.push_back(entry->path());
    }
  }
  std::ranges::sort(stale);
  return stale;
}

PendingFile::PendingFile(std::filesystem::path path, std::filesystem::path target,
                         FileSystem& files)
    : path_(std::move(path)), target_(std::move(target)), files_(&files) {}

PendingFile::~PendingFile() {
  if (file_)
    files_->unlink(temporary_);  // before it is closed, which unlocks it for the next writer
}

Error PendingFile::failure(const char* operation, std::int64_t minusErrno) const {
  const int value = static_cast<int>(-minusErrno);
  return errnoError(path_.string(), operation, value, remedyFor(value));
}

Result<PendingFile> PendingFile::create(const std::filesystem::path& path, FileSystem& files) {
  Result<std::filesystem::path> target = targetOf(path);
  if (!target) return tl::unexpected(std::move(target.error()));
  PendingFile file(path, *std::move(target), files);
  if (auto created = file.createTemporary(); !created) return tl::unexpected(created.error());
  return file;
}

Result<void> PendingFile::createTemporary() {
  constexpr int kWritersAtOnce = 100;
  const std::string name = target_.filename().string();
  int fd = -EEXIST;
  for (int writer = 1; writer <= kWritersAtOnce && fd == -EEXIST; ++writer) {
    const std::string number = writer == 1 ? "" : "." + std::to_string(writer);
    temporary_ = target_;
    temporary_.replace_filename(std::string(".").append(name).append(number).append(".part"));
    fd = files_->create(temporary_);
  }
  if (fd < 0) return tl::unexpected(failure("cannot write", fd));
  file_ = FileDescriptor(fd, *files_);
  return {};
}

Result<void> PendingFile::write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = files_->write(file_.get(), bytes);
    if (written < 0) return tl::unexpected(failure("cannot write", written));
    if (written == 0) return tl::unexpected(failure("cannot write", -EIO));
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return {};
}

Result<std::int64_t> PendingFile::seek(std::int64_t offset, int whence) {
  const std::int64_t position = files_->seek(file_.get(), offset, whence);
  if (position < 0) return tl::unexpected(failure("cannot seek", position));
  return position;
}

Result<void> PendingFile::publish(Durability durability) {
  const int synced = durability == Durability::kSynced ? files_->sync(file_.get()) : 0;
  const int renamed = synced < 0 ? synced : files_->rename(temporary_, target_);
  if (renamed < 0) files_->unlink(temporary_);
  // Closed last, as that unlocks it. After sync() there is nothing left that close() could lose.
  file_.reset();
  if (renamed < 0) return tl::unexpected(failure("cannot write", renamed));
  return {};
}

}  // namespace pleinair::hal
