#include "hal/outputs/movie/muxer_io.h"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstdint>
#include <span>

namespace pleinair::hal::movie {

MuxerIo::MuxerIo(PendingFile& file)
    : state_(new State{.file = file, .failure = std::nullopt, .from = {}, .to = {}}) {
  constexpr int kBufferBytes = 256 * 1024;
  auto* buffer = static_cast<unsigned char*>(av_malloc(kBufferBytes));
  if (buffer == nullptr) throw std::bad_alloc();
  AVIOContext* io = avio_alloc_context(buffer, kBufferBytes, 1, state_.get(), nullptr,
                                       &MuxerIo::write, &MuxerIo::seek);
  if (io == nullptr) av_free(buffer);
  io_ = libav::owned<libav::IoContext>(io);
}

void MuxerIo::substituteInHeader(std::span<const std::uint8_t> from,
                                 std::span<const std::uint8_t> to) {
  assert(from.size() == to.size());
  state_->from = from;
  state_->to = to;
}

void MuxerIo::substitute(const State& state, std::span<std::uint8_t> bytes) {
  constexpr std::int64_t kHeaderBytes = 4096;
  if (state.from.empty() || state.position >= kHeaderBytes) return;
  const auto found = std::search(bytes.begin(), bytes.end(), state.from.begin(), state.from.end());
  if (found != bytes.end()) std::copy(state.to.begin(), state.to.end(), found);
}

int MuxerIo::write(void* opaque, std::uint8_t* bytes, int size) {
  auto& state = *static_cast<State*>(opaque);
  if (state.failure) return AVERROR(EIO);
  const std::span<std::uint8_t> all(bytes, static_cast<std::size_t>(size));
  substitute(state, all);
  const Result<void> written = state.file.write(all);
  if (written) {
    state.position += size;
    return size;
  }
  state.failure = written.error();
  return AVERROR(EIO);
}

std::int64_t MuxerIo::seek(void* opaque, std::int64_t offset, int whence) {
  auto& state = *static_cast<State*>(opaque);
  if ((whence & AVSEEK_SIZE) != 0) return AVERROR(ENOSYS);
  const Result<std::int64_t> position = state.file.seek(offset, whence & ~AVSEEK_FORCE);
  if (position) return state.position = *position;
  if (!state.failure) state.failure = position.error();
  return AVERROR(EIO);
}

}  // namespace pleinair::hal::movie
