#include "firmware_app/cli/path_collisions.h"

#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "hal/error.h"
#include "hal/media/picture_paths.h"
#include "hal/numbered_path.h"
#include "hal/outputs/movie/movie_output.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;

/// The absolute path without a trailing slash; links are resolved as far as the path exists.
fs::path resolvedPath(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  if (error) return path;
  fs::path known = fs::weakly_canonical(absolute, error);
  if (error) known = absolute.lexically_normal();
  return known.has_filename() ? known : known.parent_path();
}

fs::path folderOf(const fs::path& path) {
  return resolvedPath(path.has_parent_path() ? path.parent_path() : fs::path("."));
}

bool isFolder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

/// A file, or the pictures in a folder.
struct Place {
  std::string option;
  fs::path path;           ///< as given by the user
  bool isSeries = false;   ///< numbered pictures
  fs::path canonicalPath;  ///< the file, or the folder of the numbered pictures
  /// of numbered pictures; unset: every picture in the folder
  std::optional<hal::NumberedPath> pattern;

  bool holds(const Place& file) const {
    const fs::path name = file.path.filename();
    if (folderOf(file.path) != canonicalPath) return false;
    return pattern ? pattern->numberOf(name.string()).has_value() : hal::isPictureName(name);
  }
};

Place fileAt(const NamedPath& named) {
  return {.option = named.option, .path = named.path, .canonicalPath = resolvedPath(named.path)};
}

Place seriesAt(const NamedPath& named, const fs::path& folder, const fs::path& pattern) {
  Place place{.option = named.option,
              .path = named.path,
              .isSeries = true,
              .canonicalPath = resolvedPath(folder.empty() ? fs::path(".") : folder)};
  // A malformed pattern is reported when the output is opened.
  if (const auto parsed = hal::NumberedPath::parse(pattern.string())) place.pattern = *parsed;
  return place;
}

Place readPlace(const NamedPath& named) {
  std::error_code ignored;
  if (isFolder(named.path)) return seriesAt(named, named.path, {});
  if (!fs::exists(named.path, ignored) && hal::looksNumbered(named.path)) {
    return seriesAt(named, named.path.parent_path(), named.path);
  }
  return fileAt(named);
}

Place writtenPlace(const NamedPath& named) {
  if (!isFrameSeries(named.path)) return fileAt(named);
  const bool isPattern = !isFolder(named.path) && hal::looksNumbered(named.path);
  return isPattern ? seriesAt(named, named.path.parent_path(), named.path)
                   : seriesAt(named, named.path, named.path / "%06d.png");
}

bool collide(const Place& a, const Place& b) {
  if (a.isSeries == b.isSeries) return a.canonicalPath == b.canonicalPath;
  return a.isSeries ? a.holds(b) : b.holds(a);
}

[[noreturn]] void refuse(const Place& written, const Place& other) {
  const std::string problem = written.isSeries && other.isSeries
                                  ? fmt::format("is in the folder of {} as well", other.option)
                                  : fmt::format("is {} as well", other.option);
  throw hal::Failure(hal::Error{.kind = hal::ErrorKind::kInvalidArgument,
                                .subject = written.path.string(),
                                .problem = problem,
                                .remedy = fmt::format("give {} another {}", written.option,
                                                      written.isSeries ? "folder" : "name")});
}

}  // namespace

bool isFrameSeries(const fs::path& output) {
  if (isFolder(output)) return true;
  if (hal::isMovieName(output)) return false;
  return !output.has_filename() || !output.has_extension() || hal::looksNumbered(output);
}

void refuseCollisions(const std::vector<NamedPath>& read, const std::vector<NamedPath>& written) {
  std::vector<Place> others;
  others.reserve(read.size() + written.size());
  for (const NamedPath& named : read) others.push_back(readPlace(named));
  for (const NamedPath& named : written) {
    // Only --output can name numbered pictures.
    Place place = named.option == "--output" ? writtenPlace(named) : fileAt(named);
    for (const Place& other : others) {
      if (collide(place, other)) refuse(place, other);
    }
    others.push_back(std::move(place));
  }
}

}  // namespace pleinair::app
