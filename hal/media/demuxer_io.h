#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "hal/media/file_input.h"
#include "hal/media/handles.h"

namespace pleinair::hal::libav {

/// An AVIOContext over a FileInput. A demuxer that reads through it can open no other file.
class DemuxerIo {
 public:
  explicit DemuxerIo(FileInput file);
  AVIOContext* context() { return io_.get(); }
  const FileInput& file() const { return state_->file; }
  /// Sets the size that the demuxer is told, and where reads end. What is buffered already stays
  /// readable. Not of a stream.
  void endAt(std::int64_t bytes) { state_->end = bytes; }

 private:
  struct State {
    FileInput file;
    std::int64_t position = 0;
    std::optional<std::int64_t> end;  ///< unset: the file's own
  };
  static int read(void* opaque, std::uint8_t* buffer, int size);
  static std::int64_t seek(void* opaque, std::int64_t offset, int whence);

  std::unique_ptr<State> state_;
  IoContext io_;
};

}  // namespace pleinair::hal::libav
