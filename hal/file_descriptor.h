#pragma once

#include <utility>

namespace pleinair::hal {

/// Closes file descriptors; tests replace it with a simulated system.
class DescriptorCloser {
 public:
  virtual ~DescriptorCloser() = default;
  /// 0, or −errno. Never called twice for a descriptor: it is gone whatever this answers.
  virtual int close(int fd) = 0;
};

/// Closes with the system's close(); stateless, any thread.
DescriptorCloser& systemCloser();

/// Owns a file descriptor and closes it when it goes. One thread at a time; may be handed from one
/// to another.
class FileDescriptor {
 public:
  /// Holds nothing.
  FileDescriptor() = default;
  /// Takes `fd`; holds nothing where that is negative, as failed calls answer. `closer` outlives
  /// this.
  explicit FileDescriptor(int fd, DescriptorCloser& closer = systemCloser())
      : closer_(&closer), fd_(fd) {}
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  FileDescriptor(FileDescriptor&& other) noexcept : closer_(other.closer_), fd_(other.release()) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    if (this == &other) return *this;
    reset();
    closer_ = other.closer_;
    fd_ = other.release();
    return *this;
  }
  ~FileDescriptor() { reset(); }

  explicit operator bool() const { return fd_ >= 0; }
  /// Negative where it holds nothing.
  int get() const { return fd_; }
  /// Closes it, and holds nothing then.
  void reset() {
    if (fd_ >= 0) closer_->close(release());
  }
  /// Gives it up unclosed to whoever owns it from now on.
  int release() { return std::exchange(fd_, -1); }

 private:
  DescriptorCloser* closer_ = nullptr;
  int fd_ = -1;
};

}  // namespace pleinair::hal
