#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include "hal/outputs/movie/movie_output.h"

namespace pleinair::hal {

std::unique_ptr<MemoryOutput> openMovieOutput(std::filesystem::path path, FileSystem& files) {
  return openMovieOutput(std::move(path), {}, files);
}

OutputKind movieKind() {
  return {.name = "movie",
          .help = "a movie (.mp4, .mkv), or uncompressed (.y4m)",
          .forms = {"movie.mp4", "movie.mkv", "movie.y4m"},
          .traits = {.writesFiles = true},
          .options = {},
          .recognizes =
              [](const std::string& target) {
                std::error_code ignored;
                return isMovieName(target) && !std::filesystem::is_directory(target, ignored);
              },
          .list = nullptr,
          .problemOf = nullptr,
          .make = [](const std::string& target, const OutputOptions&)
              -> Result<std::unique_ptr<Output>> { return openMovieOutput(target); }};
}

}  // namespace pleinair::hal
