#pragma once

#include <memory>
#include <optional>

#include "hal/error.h"
#include "hal/libav/handles.h"
#include "hal/pending_file.h"

namespace pleinair::hal::movie {

/// libav's view of a PendingFile. libav keeps writing after a failure and loses its cause; this
/// keeps the first.
class MuxerIo {
 public:
  explicit MuxerIo(PendingFile& file);
  AVIOContext* context() { return io_.get(); }
  const std::optional<Error>& failure() const { return state_->failure; }

 private:
  struct State {
    PendingFile& file;
    std::optional<Error> failure;
  };
  static int write(void* opaque, std::uint8_t* bytes, int size);
  static std::int64_t seek(void* opaque, std::int64_t offset, int whence);

  std::unique_ptr<State> state_;
  libav::IoContext io_;
};

}  // namespace pleinair::hal::movie
