#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "config/suggestion.h"
#include "firmware_app/cli/exit_status.h"
#include "firmware_app/cli/interrupt.h"
#include "firmware_app/cli/path_collisions.h"
#include "firmware_app/cli/progress.h"
#include "firmware_app/commands/commands.h"
#include "firmware_app/config/configuration_sections.h"
#include "firmware_app/config/configured_parts.h"
#include "firmware_app/live/runtime_rules.h"
#include "firmware_app/offline/measured_engine.h"
#include "hal/pending_file.h"
#include "pipeline/measure/input/measured_input.h"
#include "pipeline/measure/measurement.h"
#include "pipeline/styles/registry.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;
using hal::orThrow;

constexpr int kGateFailed = 1;
constexpr int kControlsWrong = 2;

/// For endless inputs: two seconds of measurement, after one second.
constexpr std::uint64_t kFramesByDefault = 60;
constexpr std::uint64_t kSettleByDefault = 30;

hal::Failure refusal(std::string subject, std::string problem, std::string remedy) {
  return hal::Failure({.kind = hal::ErrorKind::kInvalidArgument,
                       .subject = std::move(subject),
                       .problem = std::move(problem),
                       .remedy = std::move(remedy)});
}

/// The number of frames to request from an endless input.
std::uint64_t framesWanted(const MeasureOptions& options) {
  return options.frames.value_or(kFramesByDefault) + options.settle.value_or(kSettleByDefault);
}

std::unique_ptr<measure::MeasuredInput> openPhotographOf(const MeasureOptions& options,
                                                         const Configuration& configuration) {
  const std::string& by = options.movedBy;
  if (!options.input) {
    throw refusal(by, "moves a photograph, but --input is missing",
                  fmt::format("give --input PICTURE, or leave {} out", by));
  }
  measure::PhotographOptions photograph{
      .size = {},
      .motion = options.photograph,
      .noiseLevels = options.noiseLevels,
      .frames = framesWanted(options),
      .walker = options.walker,
      .period = hal::fromSeconds(1.0 / configuredCamera(configuration).framesPerSecond)};
  const config::PixelSize size = configuration.painting().size;
  if (size != config::PixelSize{}) photograph.size = {size.width, size.height};
  const std::string remedy = fmt::format("give a PNG or JPEG picture, or leave {} out", by);
  std::error_code ignored;
  if (fs::is_directory(*options.input, ignored)) {
    throw refusal(options.input->string(),
                  fmt::format("is a folder, and {} moves one photograph", by), remedy);
  }
  auto input = measure::openPhotograph(*options.input, photograph);
  if (!input && input.error().kind == hal::ErrorKind::kInvalidInput) {
    input.error().problem += fmt::format(", and {} moves one photograph", by);
    input.error().remedy = remedy;
  }
  return orThrow(std::move(input));
}

std::unique_ptr<measure::MeasuredInput> openWorkbenchOf(const MeasureOptions& options,
                                                        const Configuration& configuration) {
  refuseSlipOfCamera(configuration);
  const CameraSettings camera = configuredCamera(configuration);
  if (!isSynthetic(camera)) {
    throw refusal(camera.source.string(),
                  "neither a device nor a recording played live can be measured",
                  "give --input a recording, or --camera synthetic:SHOT");
  }
  hal::SyntheticOptions synthetic = syntheticOptions(camera);
  synthetic.frameCount = framesWanted(options);
  return orThrow(measure::openWorkbench(synthetic));
}

std::unique_ptr<measure::MeasuredInput> openInput(const MeasureOptions& options,
                                                  const Configuration& configuration) {
  if (!options.movedBy.empty()) return openPhotographOf(options, configuration);
  if (!options.input) return openWorkbenchOf(options, configuration);
  std::error_code ignored;
  if (fs::is_directory(*options.input, ignored) && !options.motion) {
    return orThrow(measure::openPictureFolder(*options.input));
  }
  return orThrow(measure::openPlainRecording(*options.input, options.motion));
}

/// The size to paint at. A known motion is in px of the input's own size.
hal::FrameSize pictureSizeOf(const Configuration& configuration, measure::MeasuredInput& input) {
  const hal::FrameSize own = input.format().size;
  const config::PixelSize asked = configuration.painting().size;
  if (asked == config::PixelSize{} || hal::FrameSize{asked.width, asked.height} == own) return own;
  if (input.motion() != nullptr) {
    throw refusal(configuration.origin("painting.size"),
                  fmt::format("the true motion of {} is in px of its own {}x{}",
                              input.description(), own.width, own.height),
                  input.isEndless() ? "leave one of the two sizes out" : "leave the size out");
  }
  return {asked.width, asked.height};
}

/// Whether there is anything to see of models: occluders show the camera's picture.
bool hasModels(const scene::Scene& scene) {
  return std::ranges::any_of(scene.models,
                             [](const scene::SceneModel& each) { return !each.isOccluder; });
}

/// The look in force; empty where the style has none.
std::string lookOf(const PaintingSettings& painting) {
  const auto looks = styles::styleKind(painting.style).looks;
  if (painting.look != kDefaultLook) return painting.look.string();
  return looks.empty() ? "" : std::string(looks.front().name);
}

std::string settingsText(const Configuration& configuration, hal::FrameSize size,
                         const std::string& quality) {
  const std::string look = lookOf(configuration.painting());
  return fmt::format("{}{}x{}, quality {}", look.empty() ? "" : fmt::format("look {}, ", look),
                     size.width, size.height, quality);
}

bool isOnPaper(const PaintingSettings& painting) {
  const auto looks = styles::styleKind(painting.style).coherence.paperLooks;
  return std::ranges::find(looks, lookOf(painting)) != looks.end();
}

/// Runs the measurement with progress; nothing if it was interrupted.
std::optional<measure::Report> measured(measure::MeasuredInput& input,
                                        measure::MeasuredPainter& painter,
                                        measure::MeasurementOptions options) {
  const hal::SteadyClock realTime;
  Progress progress("measuring", framesToPaint(input, options), realTime);
  options.goesOn = [&progress] {
    progress.advance();
    return Interrupt::received() == 0;
  };
  return orThrow(measure::measure(input, painter, options));
}

/// Creates the file early, so that a path that cannot be written is reported before painting.
std::optional<hal::PendingFile> created(const std::optional<fs::path>& path) {
  if (!path) return std::nullopt;
  return orThrow(hal::PendingFile::create(*path));
}

void publish(std::optional<hal::PendingFile>& file, const std::string& text) {
  if (!file) return;
  orThrow(file->write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}));
  orThrow(file->publish());
}

void refuseCollisionsOf(const MeasureOptions& options, std::vector<NamedPath> read) {
  if (options.input) {
    read.push_back({"--input", *options.input});
    read.push_back({"the motion of --input", *options.input / "motion.json"});
  }
  if (options.motion) read.push_back({"--motion", *options.motion});
  if (options.walker) read.push_back({"--walker", options.walker->cutout});
  std::vector<NamedPath> written;
  if (options.json) written.push_back({"--json", *options.json});
  if (options.html) written.push_back({"--html", *options.html});
  refuseCollisions(read, written);
}

int statusOf(const measure::Report& report, bool gates) {
  if (!report.areControlsValid()) {
    printError("a negative control failed; see the report");
    return kControlsWrong;
  }
  return gates && !report.areGatesPassed() ? kGateFailed : 0;
}

/// Refuses --gates for a style without gates, which would always pass.
void refuseGatesOf(const std::string& style) {
  if (!styles::styleKind(style).coherence.empty()) return;
  std::vector<std::string> gated;
  for (const styles::StyleKind* kind : styles::styleKinds()) {
    if (!kind->coherence.empty()) gated.emplace_back(kind->name);
  }
  throw refusal("--gates", fmt::format("the style {} has no gates", style),
                fmt::format("leave it out, or measure one of {}", config::listText(gated)));
}

/// Refuses options with which the scene's models cannot be measured.
void refuseModelsOf(const MeasureOptions& options, const scene::Scene& scene, std::size_t quality) {
  if (options.imageSpace && !hasModels(scene)) {
    throw refusal("--image-space", "there are no models to paint as part of the video",
                  "give a --scene with models, or leave it out");
  }
  if (hasModels(scene) && quality != 0) {
    throw refusal("--quality", "models are measured at the best quality only",
                  "leave it out, or leave the models out");
  }
}

/// Puts the models into the pictures that are painted as a plain video; null otherwise.
std::unique_ptr<Painter> makeComposer(const MeasureOptions& options, const scene::Scene& scene,
                                      hal::FrameSize size, const hal::FrameFormat& format) {
  if (!options.imageSpace) return nullptr;
  return std::make_unique<Painter>(PainterOptions{.pictureSize = size,
                                                  .scene = scene,
                                                  .style = "none",
                                                  .tracksTags = !scene.tags.empty(),
                                                  .expectedFormat = format,
                                                  .readsSurfaces = true});
}

int measureConfigured(const MeasureOptions& options, const Configuration& configuration) {
  if (options.gates) refuseGatesOf(configuration.painting().style);
  const scene::Scene scene = configuredScene(configuration);
  refuseCollisionsOf(options, configuredFiles(configuration, scene));
  const std::unique_ptr<measure::MeasuredInput> input = openInput(options, configuration);
  const hal::FrameSize size = pictureSizeOf(configuration, *input);
  const std::vector<std::string> levels = qualityNames();
  const std::string asked = configuration.runtime().quality;
  const auto level = std::ranges::find(levels, asked);
  const std::size_t quality =
      level == levels.end() ? 0 : static_cast<std::size_t>(level - levels.begin());
  const PaintingOptions painting = configuredPainting(configuration, {});
  refuseModelsOf(options, scene, quality);

  const auto composer = makeComposer(options, scene, size, input->format());
  Painter painter({.pictureSize = size,
                   .scene = composer ? scene::Scene{} : scene,
                   .style = painting.style,
                   .tracksTags = !composer && !scene.tags.empty(),
                   .isCameraMounted = painting.isCameraMounted,
                   .shaderDirectory = options.shaderDirectory,
                   .expectedFormat = input->format(),
                   .qualityLevels = quality != 0,
                   .readsSurfaces = !composer && hasModels(scene)});
  PaintParameters parameters = startParameters(painting);
  parameters.quality = quality;
  MeasuredEngine engine(painter, std::move(parameters), size,
                        {.readsMovers = options.standing,
                         .readsModels = hasModels(scene),
                         .composer = composer.get()});

  const std::uint64_t settle = options.settle.value_or(input->isEndless() ? kSettleByDefault : 0);
  std::optional<std::uint64_t> frames = options.frames;
  if (!frames && input->isEndless()) frames = kFramesByDefault;
  std::optional<hal::PendingFile> json = created(options.json);
  std::optional<hal::PendingFile> html = created(options.html);
  const Interrupt interrupt;
  const std::optional<measure::Report> report =
      measured(*input, engine,
               {.style = painting.style,
                .coherence = styles::styleKind(painting.style).coherence,
                .settings = settingsText(configuration, size, levels.at(quality)) +
                            (options.imageSpace ? ", models in image space" : ""),
                .frames = frames,
                .settle = settle,
                .stillNoiseLevels = options.noiseLevels,
                .isStanding = options.standing,
                .isOnPaper = isOnPaper(configuration.painting())});
  if (!report) {
    printError(fmt::format("interrupted by {}", signalName(Interrupt::received())));
    return kSignalExitBase + Interrupt::received();
  }
  publish(html, measure::reportHtml(*report));
  publish(json, measure::reportJson(*report));
  std::fputs(measure::reportText(*report).c_str(), stdout);
  return statusOf(*report, options.gates);
}

}  // namespace

int runMeasure(const MeasureOptions& options) {
  const Configuration configuration(options.configuration);
  return configuration.attributing([&] { return measureConfigured(options, configuration); });
}

}  // namespace pleinair::app
