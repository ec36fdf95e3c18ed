#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "hal/error.h"
#include "hal/image.h"
#include "hal/output.h"
#include "hal/outputs/movie/movie_output.h"
#include "hal/outputs/movie/sound_source.h"
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
  VideoCodec codec = VideoCodec::kH264;
  std::optional<double> crf;
};

/// An .mp4 or .mkv. `sound` is stored as it is, in step with the images, and ends with them; null
/// for a silent movie. Precondition: the container can hold it (canHold()). `file` must outlive the
/// writer.
Result<std::unique_ptr<MovieWriter>> openCodedWriter(Container container, const MovieFormat& format,
                                                     const std::string& subject, PendingFile& file,
                                                     std::unique_ptr<SoundSource> sound);
/// Whether a container can hold a coding of sound without a change.
bool canHold(Container container, const AVCodecParameters& sound);
/// Takes the bytes of a file in their order.
using ByteSink = std::function<Result<void>(std::span<const std::uint8_t>)>;
Result<std::unique_ptr<MovieWriter>> openY4mWriter(const MovieFormat& format, ByteSink sink);

}  // namespace pleinair::hal::movie
