#include <algorithm>
#include <fstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "config/suggestion.h"
#include "config/toml_reader.h"
#include "hal/cameras/recording/movie_frames.h"
#include "hal/media/picture_file.h"
#include "pipeline/digest/sha256.h"
#include "pipeline/procedure/procedure_file.h"
#include "pipeline/scene/description/model_files.h"
#include "pipeline/scene/models/limits.h"

namespace pleinair::procedure {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxFileBytes = std::size_t{1} << 20U;

std::vector<std::string> namesIn(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code failure;
  for (fs::directory_iterator at(folder, failure), end; !failure && at != end;
       at.increment(failure)) {
    names.push_back(at->path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

/// A relative path that stays below its folder.
bool isInside(const fs::path& file) {
  if (file.empty() || file.is_absolute()) return false;
  const fs::path plain = file.lexically_normal();
  return *plain.begin() != ".." && plain != ".";
}

hal::Error faultOf(std::string problem, std::string remedy,
                   hal::ErrorKind kind = hal::ErrorKind::kInvalidInput) {
  return {.kind = kind, .problem = std::move(problem), .remedy = std::move(remedy)};
}

class ProcedureFolder : public ProcedureSources {
 public:
  explicit ProcedureFolder(fs::path folder) : folder_(std::move(folder)) {}

  hal::Result<std::string> text(const std::string& name) override {
    if (auto reached = staysInside(name, "a file in the folder"); !reached) {
      return tl::unexpected(std::move(reached.error()));
    }
    std::error_code failure;
    const fs::file_status status = fs::status(folder_ / name, failure);
    if (failure) return tl::unexpected(faultOf("cannot open: " + failure.message(), ""));
    if (!fs::is_regular_file(status)) return tl::unexpected(faultOf("is not a regular file", ""));
    std::ifstream file(folder_ / name, std::ios::binary);
    std::string content(kMaxFileBytes + 1, '\0');
    file.read(content.data(), static_cast<std::streamsize>(content.size()));
    if (!file.is_open() || file.bad()) return tl::unexpected(faultOf("cannot read", ""));
    content.resize(static_cast<std::size_t>(file.gcount()));
    return content;
  }

  hal::Result<void> picture(const std::string& name) override {
    if (auto found = find(name, "picture"); !found) return found;
    const auto decoded = hal::readPicture(folder_ / name);
    if (!decoded) return tl::unexpected(faultOf(decoded.error().message(), "a picture"));
    return checkShape(name, decoded->size());
  }

  hal::Result<hal::FrameSize> movie(const std::string& name) override {
    if (auto found = find(name, "movie"); !found) return tl::unexpected(std::move(found.error()));
    std::error_code ignored;  // what cannot be read is told below
    const std::uintmax_t bytes = fs::file_size(folder_ / name, ignored);
    if (!ignored && bytes > kMostMovieFileBytes) {
      return tl::unexpected(
          faultOf(fmt::format("\"{}\" has {} MB", name, (bytes >> 20U) + 1),
                  fmt::format("at most {} MB: `pleinair render --style none --size 640x360` "
                              "makes it smaller",
                              kMostMovieFileBytes >> 20U)));
    }
    hal::FrameSize size;
    int frames = 0;
    const auto begun =
        hal::forMovieFrames(folder_ / name, {}, [&](const hal::ImageView& rgb, hal::Duration) {
          size = rgb.format.size;
          return ++frames < 2;
        });
    if (!begun) return tl::unexpected(faultOf(begun.error().message(), "a movie"));
    if (frames < 2) {
      return tl::unexpected(faultOf(fmt::format("\"{}\" has a single frame", name),
                                    "a movie; a picture belongs into the texts: ![caption](file)"));
    }
    if (auto fits = checkShape(name, size); !fits) return tl::unexpected(std::move(fits.error()));
    // Only what is beyond is decoded: most movies have nothing there.
    bool isTooLong = false;
    (void)hal::forMovieFrames(folder_ / name, kMostMovie,
                              [&](const hal::ImageView&, hal::Duration) {
                                isTooLong = true;
                                return false;
                              });
    if (isTooLong) {
      return tl::unexpected(
          faultOf(fmt::format("\"{}\" lasts longer than {} s", name, kMostMovie.count()),
                  fmt::format("a shorter one: `pleinair render --style none --to {}` cuts it",
                              kMostMovie.count())));
    }
    return size;
  }

  hal::Result<std::shared_ptr<const scene::Model>> model(
      const scene::ModelSource& source) override {
    if (const auto* file = std::get_if<scene::FileSource>(&source)) {
      std::error_code failure;
      const fs::path within = fs::relative(file->path, folder_, failure);
      if (failure) {
        return tl::unexpected(hal::errnoError(file->path.string(), "cannot open", failure.value(),
                                              "a model in the folder"));
      }
      if (!isInside(within)) {
        return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kInvalidInput,
                                         .subject = file->path.string(),
                                         .problem = "is not in the procedure's folder",
                                         .remedy = "a model in the folder"});
      }
    }
    hal::Result<scene::Model> model = scene::modelOf(source);
    if (!model) return tl::unexpected(std::move(model.error()));
    if (const std::uint64_t drawn = scene::drawnTriangles(*model); drawn > scene::kMaxTriangles) {
      return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kUnsupported,
                                       .subject = "the model",
                                       .problem = fmt::format("draws {} triangles", drawn),
                                       .remedy = fmt::format("at most {}", scene::kMaxTriangles)});
    }
    return std::make_shared<const scene::Model>(*std::move(model));
  }

  std::vector<std::string> languages() override {
    std::vector<std::string> languages;
    for (const std::string& name : namesIn(folder_)) {
      // Other documents (README.md, notes.md) may lie beside the texts.
      const fs::path file(name);
      const std::string stem = file.stem().string();
      const bool isTag = stem.size() == 2 || (stem.size() == 5 && stem[2] == '-');
      if (file.extension() == ".md" && isTag) languages.push_back(stem);
    }
    return languages;
  }

  fs::path folder() const override { return folder_; }

 private:
  static hal::Result<void> checkShape(const std::string& name, hal::FrameSize size) {
    const auto [shorter, longer] = std::minmax({size.width, size.height});
    if (longer <= kMostSlender * shorter) return {};
    return tl::unexpected(
        faultOf(fmt::format("\"{}\" has {} × {} px", name, size.width, size.height),
                fmt::format("sides of at most {0}:1, so that text has room beside it: cut it",
                            kMostSlender)));
  }

  /// Whether symbolic links lead to nothing outside of the folder.
  hal::Result<void> staysInside(const std::string& name, std::string remedy) const {
    std::error_code failure;
    const fs::path root = fs::canonical(folder_, failure);
    if (failure) return {};  // whoever reads the file tells it
    const fs::path reached = fs::weakly_canonical(folder_ / name, failure);
    if (failure) {
      return tl::unexpected(faultOf(fmt::format("cannot open: {}", failure.message()), remedy));
    }
    if (isInside(reached.lexically_relative(root))) return {};
    return tl::unexpected(faultOf(
        fmt::format("\"{}\" is not in the procedure's folder: a symbolic link leads out of it",
                    name),
        std::move(remedy)));
  }

  /// `kind`: "picture" or "movie".
  hal::Result<void> find(const std::string& name, std::string_view kind) const {
    std::string remedy = fmt::format("a {} in the folder", kind);
    if (!isInside(name)) {
      return tl::unexpected(
          faultOf(fmt::format("\"{}\" is not in the procedure's folder", name), std::move(remedy)));
    }
    if (auto stays = staysInside(name, remedy); !stays) return stays;
    std::error_code ignored;
    if (!fs::exists(folder_ / name, ignored)) {
      const std::vector<std::string> names = namesIn(folder_);
      return tl::unexpected(
          faultOf(fmt::format("there is no {} {}", kind, config::foundText(name, names)),
                  std::move(remedy)));
    }
    return {};
  }

  fs::path folder_;
};

/// Over each file's name, its length and its content, so that nothing can move between them.
std::string hashOf(const fs::path& folder, const std::vector<std::string>& files,
                   std::vector<config::ConfigError>& faults) {
  digest::Sha256Stream stream;
  for (const std::string& file : files) {
    const auto content = digest::hexOfFile(folder / file);
    if (!content) {
      faults.push_back(config::ConfigError(
          {.file = (folder / file).string(), .problem = content.error().problem}));
      return {};
    }
    stream.add(fmt::format("{}  {}\n", *content, file));  // as sha256sum prints it
  }
  return digest::hexOf(stream.finish());
}

}  // namespace

ProcedureReading readProcedureFolder(const fs::path& folder) {
  ProcedureFolder sources(folder);
  const fs::path file = folder / kProcedureFile;
  const auto toml = sources.text(std::string(kProcedureFile));
  if (!toml) {
    ProcedureReading reading;
    reading.faults.push_back(
        config::ConfigError({.file = file.string(),
                             .problem = toml.error().problem,
                             .allowed = "a folder with procedure.toml; `pleinair "
                                        "procedure new` makes one"}));
    return reading;
  }
  ProcedureReading reading = readProcedure(*toml, file.string(), sources);
  std::vector<std::string>& files = reading.procedure.files;
  files.emplace_back(kProcedureFile);
  if (const auto* model = std::get_if<scene::FileSource>(&reading.procedure.source)) {
    std::error_code failure;  // a mistake in the model is told already
    files.push_back(fs::relative(model->path, folder, failure).string());
    const auto beside = scene::filesBeside(model->path);
    const fs::path root = fs::canonical(folder, failure);
    for (const fs::path& each : beside.value_or(std::vector<fs::path>())) {
      files.push_back(fs::canonical(each, failure).lexically_relative(root).string());
    }
  }
  std::ranges::sort(files);
  const auto repeated = std::ranges::unique(files);  // a picture of a text may be a texture, too
  files.erase(repeated.begin(), repeated.end());
  if (reading.faults.empty()) reading.procedure.hash = hashOf(folder, files, reading.faults);
  return reading;
}

}  // namespace pleinair::procedure
