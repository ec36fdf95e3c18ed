#include "firmware_app/cli/path_collisions.h"

#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "hal/cameras/recording/picture_source.h"
#include "hal/error.h"
#include "hal/numbered_path.h"
#include "hal/outputs/movie/movie_output.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;

/// Absolute, links followed as far as there is something, without a slash at the end.
fs::path trueName(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  if (error) return path;
  fs::path known = fs::weakly_canonical(absolute, error);
  if (error) known = absolute.lexically_normal();
  return known.has_filename() ? known : known.parent_path();
}

fs::path folderOf(const fs::path& path) {
  return trueName(path.has_parent_path() ? path.parent_path() : fs::path("."));
}

bool isFolder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

/// One file, or the pictures in a folder.
struct Place {
  std::string option;
  fs::path path;                             ///< as given
  bool isRow = false;                        ///< many pictures
  fs::path canonicalPath;                    ///< the file, or the folder of a row
  std::optional<hal::NumberedPath> pattern;  ///< of a row; unset: every picture in the folder

  bool holds(const Place& file) const {
    const fs::path name = file.path.filename();
    if (folderOf(file.path) != canonicalPath) return false;
    return pattern ? pattern->numberOf(name.string()).has_value()
                   : hal::recording::isPictureName(name);
  }
};

Place fileAt(const NamedPath& named) {
  return {.option = named.option, .path = named.path, .canonicalPath = trueName(named.path)};
}

Place rowAt(const NamedPath& named, const fs::path& folder, const fs::path& pattern) {
  Place place{.option = named.option,
              .path = named.path,
              .isRow = true,
              .canonicalPath = trueName(folder.empty() ? fs::path(".") : folder)};
  // A malformed one is refused where it is opened.
  if (const auto parsed = hal::NumberedPath::parse(pattern.string())) place.pattern = *parsed;
  return place;
}

Place readPlace(const NamedPath& named) {
  std::error_code ignored;
  if (isFolder(named.path)) return rowAt(named, named.path, {});
  if (!fs::exists(named.path, ignored) && hal::looksNumbered(named.path)) {
    return rowAt(named, named.path.parent_path(), named.path);
  }
  return fileAt(named);
}

Place writtenPlace(const NamedPath& named) {
  if (!isPictureRow(named.path)) return fileAt(named);
  const bool isPattern = !isFolder(named.path) && hal::looksNumbered(named.path);
  return isPattern ? rowAt(named, named.path.parent_path(), named.path)
                   : rowAt(named, named.path, named.path / "%06d.png");
}

bool collide(const Place& a, const Place& b) {
  if (a.isRow == b.isRow) return a.canonicalPath == b.canonicalPath;
  return a.isRow ? a.holds(b) : b.holds(a);
}

[[noreturn]] void refuse(const Place& written, const Place& other) {
  const std::string problem = written.isRow && other.isRow
                                  ? fmt::format("is in the folder of {} as well", other.option)
                                  : fmt::format("is {} as well", other.option);
  throw hal::Failure(hal::Error{.kind = hal::ErrorKind::kInvalidArgument,
                                .subject = written.path.string(),
                                .problem = problem,
                                .remedy = fmt::format("give {} another {}", written.option,
                                                      written.isRow ? "folder" : "name")});
}

}  // namespace

bool isPictureRow(const fs::path& output) {
  if (isFolder(output)) return true;
  if (hal::isMovieName(output)) return false;
  return !output.has_filename() || !output.has_extension() || hal::looksNumbered(output);
}

void refuseCollisions(const std::vector<NamedPath>& read, const std::vector<NamedPath>& written) {
  std::vector<Place> others;
  others.reserve(read.size() + written.size());
  for (const NamedPath& named : read) others.push_back(readPlace(named));
  for (const NamedPath& named : written) {
    // Only --output can be a row.
    Place place = named.option == "--output" ? writtenPlace(named) : fileAt(named);
    for (const Place& other : others) {
      if (collide(place, other)) refuse(place, other);
    }
    others.push_back(std::move(place));
  }
}

}  // namespace pleinair::app
