#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "hal/cameras/recording/recording.h"
#include "hal/captures/frame_facts.h"
#include "hal/clock.h"
#include "hal/error.h"
#include "hal/media/handles.h"
#include "hal/pixel_format.h"

namespace pleinair::hal::recording {

struct SourceFrame {
  std::shared_ptr<const AVFrame> frame;       ///< as stored, with its display matrix
  std::optional<Duration> time;               ///< the file's timestamp, with an arbitrary origin
  std::uint64_t droppedBefore = 0;            ///< broken frames skipped since the previous one
  std::optional<captures::FrameFacts> facts;  ///< of a captured stream (hal/captures)
};
struct SourceEnd {
  std::optional<Error> truncated;  ///< the reason, if the source ended early
};
using SourceItem = std::variant<SourceFrame, SourceEnd, Error>;

/// The valid frames of one recording, played once.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  virtual std::optional<Duration> framePeriod() const = 0;
  virtual std::optional<std::uint64_t> frameCount() const = 0;
  /// The length of the whole recording, whatever part of it is played; nothing where it is not
  /// known.
  virtual std::optional<Duration> length() const { return std::nullopt; }
  /// The camera's layout of a captured stream (hal/captures), whose pixels it was stored from.
  virtual std::optional<PixelFormat> capturedLayout() const { return std::nullopt; }
  /// The camera that a captured stream is of: "v4l2:ID (HD Webcam)". Else empty.
  virtual std::string capturedFrom() const { return {}; }
  /// After SourceEnd or Error it must not be called again.
  virtual SourceItem next() = 0;
};

/// Ends a movie that next() would search for a valid frame to the end of the file.
struct MovieBounds {
  /// Packets without a valid frame, after which the movie ends as truncated.
  std::optional<int> mostWithoutFrame;
  /// Asked before each packet; true ends the movie. Null: never.
  std::function<bool()> isUnwanted = nullptr;
};

/// Errors: as Camera::start. Of the options, `from` and `to` count here.
Result<std::unique_ptr<FrameSource>> openMovie(const std::filesystem::path& path,
                                               const RecordingOptions& options,
                                               MovieBounds bounds = {});

/// Pictures in the given order, `period` apart (a single picture has none). Broken ones are
/// skipped, and options.onSkipped is told.
std::unique_ptr<FrameSource> openPictures(std::vector<std::filesystem::path> paths,
                                          std::optional<Duration> period,
                                          const RecordingOptions& options);

/// Opens a movie, a picture, a folder or a pattern, whichever `path` names. Errors: as
/// Camera::start.
Result<std::unique_ptr<FrameSource>> openSource(const std::filesystem::path& path,
                                                const RecordingOptions& options);

}  // namespace pleinair::hal::recording
