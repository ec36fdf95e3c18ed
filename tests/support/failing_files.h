#pragma once

#include <algorithm>
#include <cerrno>
#include <cstdint>

#include "hal/pending_file.h"

namespace pleinair::support {

/// The real file system with a disk that is full after a number of bytes, and with calls that can
/// be made to fail. Writes are always short.
class FailingFiles final : public hal::FileSystem {
 public:
  explicit FailingFiles(std::int64_t freeBytes) : freeBytes_(freeBytes) {}

  int renameAnswer = 0;
  int syncAnswer = 0;

  int create(const std::filesystem::path& path) override { return real_.create(path); }
  ssize_t write(int fd, std::span<const std::uint8_t> bytes) override {
    if (freeBytes_ <= 0) return -ENOSPC;
    constexpr std::size_t kMaxAtOnce = 1000;
    const auto room = static_cast<std::size_t>(freeBytes_);
    const std::size_t count = std::min({bytes.size(), room, kMaxAtOnce});
    const ssize_t written = real_.write(fd, bytes.first(count));
    freeBytes_ -= written;
    return written;
  }
  std::int64_t seek(int fd, std::int64_t offset, int whence) override {
    return real_.seek(fd, offset, whence);
  }
  int sync(int) override { return syncAnswer; }  // a real sync would only take time
  int close(int fd) override { return real_.close(fd); }
  int rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
    return renameAnswer != 0 ? renameAnswer : real_.rename(from, to);
  }
  int unlink(const std::filesystem::path& path) override { return real_.unlink(path); }

 private:
  hal::FileSystem& real_ = hal::systemFiles();
  std::int64_t freeBytes_;
};

}  // namespace pleinair::support
