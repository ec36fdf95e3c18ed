#include "hal/cameras/recording/frame_source.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>
#include <span>
#include <string>
#include <system_error>

#include "hal/media/file_input.h"
#include "hal/media/picture_header.h"
#include "hal/media/picture_paths.h"

namespace pleinair::hal::recording {
namespace {

using SourceResult = Result<std::unique_ptr<FrameSource>>;

SourceResult pictures(const Result<std::vector<std::filesystem::path>>& paths,
                      const RecordingOptions& options) {
  if (!paths) return tl::unexpected(paths.error());
  return openPictures(*paths, options.picturePeriod, options);
}

enum class RecordingKind { kPicture, kMovie };

/// The kind that the file's signature tells. A picture's name decides first, so that the error
/// about a broken picture speaks of a picture.
Result<RecordingKind> kindOf(const std::filesystem::path& path) {
  if (isPictureName(path)) return RecordingKind::kPicture;
  const Result<FileInput> file = FileInput::open(path);
  if (!file) return tl::unexpected(file.error());
  std::array<std::uint8_t, 16> head{};
  const std::int64_t got = file->readAt(0, head.data(), head.size());
  if (got < 0) {
    return tl::unexpected(errnoError(path.string(), "cannot read", static_cast<int>(-got)));
  }
  const auto kind = pictureKindOf(std::span(head).first(static_cast<std::size_t>(got)));
  // Motion-JPEG is a movie although it begins as a JPEG picture does.
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  const bool isJpegStream = ending == ".mjpeg" || ending == ".mjpg";
  return kind && !isJpegStream ? RecordingKind::kPicture : RecordingKind::kMovie;
}

}  // namespace

SourceResult openSource(const std::filesystem::path& path, const RecordingOptions& options) {
  if (path == kStandardInput) return openMovie(path, options);
  std::error_code status;
  const std::filesystem::file_status file = std::filesystem::status(path, status);
  if (std::filesystem::is_directory(file)) return pictures(picturesIn(path), options);
  if (!std::filesystem::exists(file)) {
    if (file.type() == std::filesystem::file_type::not_found && looksNumbered(path)) {
      const Result<NumberedPath> pattern = NumberedPath::parse(path.string());
      if (!pattern) return tl::unexpected(pattern.error());
      return pictures(picturesOf(*pattern, path.string()), options);
    }
    const int value = status.value() != 0 ? status.value() : ENOENT;
    return tl::unexpected(
        errnoError(path.string(), "cannot open", value, "check the path of the recording"));
  }
  const Result<RecordingKind> kind = kindOf(path);
  if (!kind) return tl::unexpected(kind.error());
  if (*kind == RecordingKind::kPicture) return openPictures({path}, std::nullopt, options);
  return openMovie(path, options);
}

}  // namespace pleinair::hal::recording
