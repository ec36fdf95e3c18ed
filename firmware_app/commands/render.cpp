#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include "firmware_app/cli/exit_status.h"
#include "firmware_app/cli/interrupt.h"
#include "firmware_app/commands/commands.h"
#include "firmware_app/config/configuration_sections.h"
#include "firmware_app/config/configured_parts.h"
#include "firmware_app/overlay/procedure_film.h"
#include "hal/cameras/recording/recording.h"
#include "hal/media/picture_paths.h"
#include "hal/numbered_path.h"
#include "hal/outputs/movie/movie_output.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kNamePlace = "{name}";

hal::Failure misuse(std::string subject, std::string problem, std::string remedy) {
  return hal::Failure(hal::Error{.kind = hal::ErrorKind::kInvalidArgument,
                                 .subject = std::move(subject),
                                 .problem = std::move(problem),
                                 .remedy = std::move(remedy)});
}

/// "holiday" of "films/holiday.mp4" and of the folder "holiday/", "in" of "in/%04d.png".
std::string nameOfInput(const fs::path& input) {
  if (input == hal::kStandardInput) return "stdin";
  const fs::path plain = input.has_filename() ? input : input.parent_path();
  std::error_code ignored;
  if (fs::is_directory(plain, ignored)) return plain.filename().string();
  if (!fs::exists(plain, ignored) && hal::looksNumbered(plain)) {
    const std::string folder = plain.parent_path().filename().string();
    return folder.empty() ? "frames" : folder;
  }
  return plain.stem().string();
}

fs::path namedFor(const fs::path& pattern, const fs::path& input) {
  std::string text = pattern.string();
  const std::string name = nameOfInput(input);
  for (std::size_t at = text.find(kNamePlace); at != std::string::npos;
       at = text.find(kNamePlace, at + name.size())) {
    text.replace(at, kNamePlace.size(), name);
  }
  return text;
}

/// One input with the files that are written of it.
struct RenderJob {
  fs::path input;
  PaintingOptions painting;
};

std::vector<RenderJob> jobsOf(const RenderOptions& options) {
  const auto requireName = [&](const char* option, const fs::path& path) {
    if (options.inputs.size() == 1 || path.string().find(kNamePlace) != std::string::npos) return;
    throw misuse(path.string(),
                 fmt::format("is one {} for {} inputs", option, options.inputs.size()),
                 "write {name} in it, which stands for each input's name");
  };
  std::vector<RenderJob> jobs;
  for (const fs::path& input : options.inputs) {
    RenderJob job{.input = input, .painting = options.painting};
    requireName("--output", job.painting.output);
    job.painting.output = namedFor(job.painting.output, input);
    for (auto [option, path] : {std::pair("--poses", &job.painting.poses),
                                std::pair("--contact-sheet", &job.painting.contactSheet)}) {
      if (!*path) continue;
      requireName(option, **path);
      *path = namedFor(**path, input);
    }
    if (options.keepsSound) job.painting.movie.soundOf = input;
    job.painting.movie.soundFrom = options.from;
    job.painting.movie.onNotice = [](const std::string& notice) { spdlog::warn("{}", notice); };
    jobs.push_back(std::move(job));
  }
  return jobs;
}

/// Refuses options that the output does not take.
void checkFormat(const PaintingOptions& painting) {
  const std::string output = painting.output.string();
  const bool isSeries = isFrameSeries(painting.output);
  const bool isCoded = hal::isMovieName(painting.output) && !isSeries &&
                       !output.ends_with(".y4m") && !output.ends_with(".Y4M");
  const bool isPictures = isSeries || hal::writtenPictureKind(painting.output).has_value();
  const bool isJpeg = hal::writtenPictureKind(painting.output) == hal::PictureFileKind::kJpeg;
  const hal::MovieOptions& movie = painting.movie;
  if (movie.codec != hal::VideoCodec::kH264 && !isCoded) {
    throw misuse("--codec", "is of movies, and " + output + " is none that is coded",
                 "write .mp4 or .mkv");
  }
  if (movie.crf && !isCoded) {
    throw misuse("--crf", "is of movies, and " + output + " is none that is coded",
                 "write .mp4 or .mkv; of .jpg it is --quality");
  }
  if (movie.crf && movie.codec == hal::VideoCodec::kFfv1) {
    throw misuse("--crf", "is not of ffv1, which is lossless", "leave it out");
  }
  if (painting.pictures.quality && !isJpeg) {
    throw misuse("--quality", "is of JPEG, and " + output + " is none",
                 "write .jpg; of movies it is --crf");
  }
  if (painting.pictures.dotsPerInch && !isPictures) {
    throw misuse("--dpi", "is of pictures, and " + output + " is none", "write .png, .jpg or .tif");
  }
}

void checkPart(const RenderOptions& options) {
  if (!options.to || *options.to > options.from) return;
  throw misuse("--to",
               fmt::format("ends at {:g} s, and --from begins at {:g} s",
                           hal::toSeconds(*options.to), hal::toSeconds(options.from)),
               "give an end after the beginning");
}

/// Refuses outputs that would overwrite an input or one another.
void refuseCollisionsOf(const std::vector<RenderJob>& jobs, std::vector<NamedPath> read) {
  std::vector<NamedPath> written;
  for (const RenderJob& job : jobs) {
    read.insert(read.begin(), {"--input", job.input});
    const PaintingOptions& painting = job.painting;
    if (painting.output != kStandardOutput) written.push_back({"--output", painting.output});
    if (painting.poses) written.push_back({"--poses", *painting.poses});
    if (painting.contactSheet) written.push_back({"--contact-sheet", *painting.contactSheet});
  }
  refuseCollisions(read, written);
}

/// Says which files of a folder are left out because their names are no pictures'.
void reportIgnoredFiles(const fs::path& input) {
  constexpr std::size_t kNamed = 3;
  std::vector<std::string> names = hal::otherFilesIn(input);
  if (names.empty()) return;
  const std::size_t count = names.size();
  if (count > kNamed) names.resize(kNamed);
  spdlog::warn("{}: {} of its files {} left out, by {} no picture: {}{}", input.string(), count,
               count == 1 ? "is" : "are", count == 1 ? "its name" : "their names",
               fmt::join(names, ", "), count > kNamed ? " …" : "");
}

/// Null where the configuration names no procedure. Changes the scene.
std::unique_ptr<ProcedureFilm> configuredFilm(const RenderOptions& options,
                                              const Configuration& configuration,
                                              scene::Scene& scene) {
  const ProcedureSettings settings = configuration.procedure();
  if (settings.folder == kNoFile) {
    if (options.step.empty()) return nullptr;
    throw misuse("--step", "is of a procedure, and none is given", "give --procedure FOLDER");
  }
  return std::make_unique<ProcedureFilm>(
      ProcedureFilmOptions{
          .folder = settings.folder,
          .language = settings.language == "default" ? std::string() : settings.language,
          .machine = settings.machine,
          .step = options.step,
          .secondsPerStep = options.secondsPerStep,
          .showsInset = settings.inset == "always"},
      scene);
}

int renderOne(const RenderOptions& options, const Configuration& configuration,
              const RenderJob& job, const scene::Scene& scene) {
  hal::SteppedClock clock;
  reportIgnoredFiles(job.input);
  const std::unique_ptr<hal::Camera> recording = hal::openRecording(
      job.input, clock,
      {.from = options.from, .to = options.to, .onSkipped = [](const hal::Error& error) {
         spdlog::warn("{}; it is left out", error.message());
       }});
  scene::Scene shown = scene;
  const std::unique_ptr<ProcedureFilm> film = configuredFilm(options, configuration, shown);
  std::optional<std::size_t> machine;
  decltype(PaintingJob::overlay) overlay;
  if (film) {
    machine = film->machine();
    overlay = [&film](hal::Duration time, hal::FrameSize size) { return film->at(time, size); };
  }
  PaintingJob painting;
  painting.camera = recording.get();
  painting.options = configuredPainting(configuration, job.painting);
  painting.scene = std::move(shown);
  painting.machine = machine;
  painting.overlay = std::move(overlay);
  painting.progressVerb = "painting";
  painting.summaryVerb = "painted";
  return runPainting(painting);
}

}  // namespace

int render(const RenderOptions& options) {
  const Configuration configuration(options.configuration);
  return configuration.attributing([&] {
    const scene::Scene scene = configuredScene(configuration);
    const std::vector<RenderJob> jobs = jobsOf(options);
    for (const RenderJob& job : jobs) checkFormat(job.painting);
    checkPart(options);
    refuseCollisionsOf(jobs, configuredFiles(configuration, scene));
    if (jobs.size() == 1) return renderOne(options, configuration, jobs.front(), scene);
    int status = 0;
    for (const RenderJob& job : jobs) {
      int own = 0;
      try {
        own = renderOne(options, configuration, job, scene);
      } catch (...) {
        own = static_cast<int>(reportCurrentException());
      }
      if (own >= kSignalExitBase) return own;
      if (status == 0) status = own;
    }
    return status;
  });
}

}  // namespace pleinair::app
