#include "hal/media/demuxer_io.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <new>
#include <utility>

namespace pleinair::hal::libav {

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
  std::int64_t wanted = size;
  if (state.end) wanted = std::clamp<std::int64_t>(*state.end - state.position, 0, size);
  const std::int64_t got =
      wanted == 0 ? 0 : state.file.readAt(state.position, buffer, static_cast<std::size_t>(wanted));
  if (got == 0) return AVERROR_EOF;
  if (got > 0) state.position += got;
  return static_cast<int>(got);
}

std::int64_t DemuxerIo::seek(void* opaque, std::int64_t offset, int whence) {
  auto& state = *static_cast<State*>(opaque);
  switch (whence & ~AVSEEK_FORCE) {
    case AVSEEK_SIZE:
      return state.end.value_or(state.file.sizeBytes());
    case SEEK_CUR:
      offset += state.position;
      break;
    case SEEK_END:
      offset += state.end.value_or(state.file.sizeBytes());
      break;
    default:
      break;
  }
  if (offset < 0) return AVERROR(EINVAL);
  return state.position = offset;
}

}  // namespace pleinair::hal::libav
