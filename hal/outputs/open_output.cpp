#include "hal/outputs/open_output.h"

#include <system_error>

#include "hal/outputs/frames/frames_output.h"
#include "hal/outputs/movie/movie_output.h"
#include "hal/outputs/v4l2_loopback/loopback_output.h"
#include "hal/outputs/window/window.h"

namespace pleinair::hal {

Result<std::unique_ptr<MemoryOutput>> openFileOutput(const std::filesystem::path& path) {
  if (path.native().starts_with("/dev/") && !path.native().starts_with("/dev/shm/")) {
    return tl::unexpected(Error{.kind = ErrorKind::kInvalidArgument,
                                .subject = path.string(),
                                .problem = "is a device's place, not a file's",
                                .remedy = "a V4L2 loopback is loopback:" + path.string()});
  }
  std::error_code ignored;
  const bool isFolder = std::filesystem::is_directory(path, ignored);
  if (isMovieName(path) && !isFolder) return openMovieOutput(path);
  const std::filesystem::path ending = path.extension();
  const bool isFrames =
      isFolder || !path.has_filename() || ending.empty() || ending == ".png" || ending == ".PNG";
  if (!path.empty() && isFrames) return openFramesOutput(path);
  return tl::unexpected(Error{.kind = ErrorKind::kInvalidArgument,
                              .subject = path.string(),
                              .problem = "does not say what to write",
                              .remedy = "end it in .mp4, .mkv, .y4m or .png (numbered: "
                                        "out/%04d.png), or give a folder"});
}

bool isFileOutputName(const std::string& name) {
  return name != "window" && !isLoopbackName(name);
}

Result<std::unique_ptr<MemoryOutput>> openOutput(const std::string& name,
                                                 const OutputOptions& options) {
  if (isFileOutputName(name)) return openFileOutput(name);
  if (isLoopbackName(name)) return openLoopback(name, options.loopbackLayout);
  return openWindow();
}

}  // namespace pleinair::hal
