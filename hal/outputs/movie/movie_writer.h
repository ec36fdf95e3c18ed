#pragma once

#include <memory>
#include <string>

#include "hal/error.h"
#include "hal/image.h"
#include "hal/output.h"
#include "hal/pending_file.h"

namespace pleinair::hal::movie {

/// Turns I420 pictures into one file's bytes.
class MovieWriter {
 public:
  virtual ~MovieWriter() = default;
  virtual Result<void> write(const ImageView& picture, Duration time) = 0;
  /// Everything that is still held back, and the file's end. Publishing is the caller's.
  virtual Result<void> finish() = 0;
};

enum class Container { kMp4, kMkv };

struct MovieFormat {
  FrameFormat frame;     ///< I420
  Duration framePeriod;  ///< nominal
};

/// `file` must outlive the writer.
Result<std::unique_ptr<MovieWriter>> openH264Writer(Container container, const MovieFormat& format,
                                                    const std::string& subject, PendingFile& file);
Result<std::unique_ptr<MovieWriter>> openY4mWriter(const MovieFormat& format, PendingFile& file);

}  // namespace pleinair::hal::movie
