#include "firmware_app/cli/stale_parts.h"

#include <fmt/format.h>

#include "firmware_app/cli/path_collisions.h"
#include "hal/media/picture_paths.h"
#include "hal/numbered_path.h"
#include "hal/outputs/movie/movie_output.h"
#include "hal/pending_file.h"

namespace pleinair::app {

std::vector<std::string> stalePartNotices(const std::filesystem::path& output) {
  const bool isInside = isFrameSeries(output) && !hal::looksNumbered(output);
  std::filesystem::path folder = isInside ? output : output.parent_path();
  if (folder.empty()) folder = ".";
  std::vector<std::string> notices;
  for (const std::filesystem::path& part : hal::stalePartsIn(folder)) {
    const std::filesystem::path name = hal::finalNameOf(part);
    if (hal::looksNumbered(name)) continue;  // the lock of a pattern, which the next run takes
    if (hal::isMovieName(name)) {
      notices.push_back(fmt::format(
          "{}: was left by a run that was killed; it plays up to there: rename it, or remove it",
          part.string()));
    } else if (hal::isPictureName(name)) {
      notices.push_back(
          fmt::format("{}: was left by a run that was killed; remove it", part.string()));
    }
  }
  return notices;
}

}  // namespace pleinair::app
