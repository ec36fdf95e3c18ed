#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "hal/clock.h"
#include "hal/error.h"
#include "hal/media/handles.h"

namespace pleinair::hal::recording {

struct SourceFrame {
  std::shared_ptr<const AVFrame> frame;  ///< as stored, with the display matrix that turns it
  std::optional<Duration> time;          ///< as the file says, from an origin of its own
  std::uint64_t droppedBefore = 0;       ///< broken frames left out since the last one
};
struct SourceEnd {
  std::optional<Error> truncated;  ///< why it ended before its proper end
};
using SourceItem = std::variant<SourceFrame, SourceEnd, Error>;

/// The sound frames of one recording, once through.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  virtual std::optional<Duration> framePeriod() const = 0;
  virtual std::optional<std::uint64_t> frameCount() const = 0;
  /// After SourceEnd or Error it must not be called again.
  virtual SourceItem next() = 0;
};

/// Errors: as Camera::start.
Result<std::unique_ptr<FrameSource>> openMovie(const std::filesystem::path& path);

/// Pictures in the order given, `period` apart (one alone has none). A broken one is left out.
std::unique_ptr<FrameSource> openPictures(std::vector<std::filesystem::path> paths,
                                          std::optional<Duration> period);

/// Decides by what stands at `path`. Errors: as Camera::start.
Result<std::unique_ptr<FrameSource>> openSource(const std::filesystem::path& path,
                                                Duration picturePeriod);

}  // namespace pleinair::hal::recording
