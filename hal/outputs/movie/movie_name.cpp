#include "hal/outputs/movie/movie_name.h"

#include <algorithm>
#include <string>

#include "hal/outputs/movie/movie_output.h"

namespace pleinair::hal {
namespace movie {

std::optional<FileKind> fileKindOf(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  if (ending == ".mp4") return FileKind::kMp4;
  if (ending == ".mkv") return FileKind::kMkv;
  if (ending == ".y4m") return FileKind::kY4m;
  return std::nullopt;
}

}  // namespace movie

bool isMovieName(const std::filesystem::path& path) {
  return movie::fileKindOf(path).has_value();
}

}  // namespace pleinair::hal
