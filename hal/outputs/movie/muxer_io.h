#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "hal/error.h"
#include "hal/media/handles.h"
#include "hal/pending_file.h"

namespace pleinair::hal::movie {

/// libav's view of a PendingFile. libav keeps writing after a failure and loses its cause; this
/// keeps the first.
class MuxerIo {
 public:
  explicit MuxerIo(PendingFile& file);
  AVIOContext* context() { return io_.get(); }
  const std::optional<Error>& failure() const { return state_->failure; }

  /// From now on writes `to` where libav's header (the file's first 4 KiB) holds `from`. Both must
  /// be of the same length and outlive this.
  void substituteInHeader(std::span<const std::uint8_t> from, std::span<const std::uint8_t> to);

 private:
  struct State {
    PendingFile& file;
    std::optional<Error> failure;
    std::int64_t position = 0;
    std::span<const std::uint8_t> from;
    std::span<const std::uint8_t> to;
  };
  static void substitute(const State& state, std::span<std::uint8_t> bytes);
  static int write(void* opaque, std::uint8_t* bytes, int size);
  static std::int64_t seek(void* opaque, std::int64_t offset, int whence);

  std::unique_ptr<State> state_;
  libav::IoContext io_;
};

}  // namespace pleinair::hal::movie
