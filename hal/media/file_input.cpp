#include "hal/media/file_input.h"

#include <cerrno>
#include <cstdio>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pleinair::hal::libav {

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

DemuxerIo::DemuxerIo(FileInput file) : state_(new State{.file = std::move(file)}) {
  constexpr int kBufferBytes = 64 * 1024;
  auto* buffer = static_cast<unsigned char*>(av_malloc(kBufferBytes));
  if (buffer == nullptr) throw std::bad_alloc();
  AVIOContext* io =
      avio_alloc_context(buffer, kBufferBytes, 0, state_.get(), &DemuxerIo::read, nullptr,
                         state_->file.isStream() ? nullptr : &DemuxerIo::seek);
  if (io == nullptr) av_free(buffer);
  io_ = owned<IoContext>(io);
}

int DemuxerIo::read(void* opaque, std::uint8_t* buffer, int size) {
  auto& state = *static_cast<State*>(opaque);
  const std::int64_t got =
      state.file.readAt(state.position, buffer, static_cast<std::size_t>(size));
  if (got == 0) return AVERROR_EOF;
  if (got > 0) state.position += got;
  return static_cast<int>(got);
}

std::int64_t DemuxerIo::seek(void* opaque, std::int64_t offset, int whence) {
  auto& state = *static_cast<State*>(opaque);
  switch (whence & ~AVSEEK_FORCE) {
    case AVSEEK_SIZE:
      return state.file.sizeBytes();
    case SEEK_CUR:
      offset += state.position;
      break;
    case SEEK_END:
      offset += state.file.sizeBytes();
      break;
    default:
      break;
  }
  if (offset < 0) return AVERROR(EINVAL);
  return state.position = offset;
}

}  // namespace pleinair::hal::libav
