#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include "firmware_app/commands/commands.h"
#include "firmware_app/config/configured_parts.h"
#include "hal/cameras/recording/picture_source.h"
#include "hal/cameras/recording/recording.h"

namespace pleinair::app {
namespace {

/// Refuses outputs that would overwrite an input or one another.
void refuseCollisionsOf(const RenderOptions& options, std::vector<NamedPath> read) {
  read.insert(read.begin(), {"--input", options.input});
  const PaintingOptions& painting = options.painting;
  std::vector<NamedPath> written;
  if (painting.output != kStandardOutput) written.push_back({"--output", painting.output});
  if (painting.poses) written.push_back({"--poses", *painting.poses});
  if (painting.contactSheet) written.push_back({"--contact-sheet", *painting.contactSheet});
  refuseCollisions(read, written);
}

/// Says which files of a folder are left out because their names are no pictures'.
void reportIgnoredFiles(const std::filesystem::path& input) {
  constexpr std::size_t kNamed = 3;
  std::vector<std::string> names = hal::recording::otherFilesIn(input);
  if (names.empty()) return;
  const std::size_t count = names.size();
  if (count > kNamed) names.resize(kNamed);
  spdlog::warn("{}: {} of its files {} left out, by {} no picture: {}{}", input.string(), count,
               count == 1 ? "is" : "are", count == 1 ? "its name" : "their names",
               fmt::join(names, ", "), count > kNamed ? " …" : "");
}

}  // namespace

int render(const RenderOptions& options) {
  const Configuration configuration(options.configuration);
  return configuration.attributing([&] {
    scene::Scene scene = configuredScene(configuration);
    refuseCollisionsOf(options, configuredFiles(configuration, scene));
    hal::SteppedClock clock;
    reportIgnoredFiles(options.input);
    const std::unique_ptr<hal::Camera> recording = hal::openRecording(
        options.input, clock,
        {.from = options.from, .to = options.to, .onSkipped = [](const hal::Error& error) {
           spdlog::warn("{}; it is left out", error.message());
         }});
    PaintingOptions painting = options.painting;
    if (options.keepsSound) painting.movie.soundOf = options.input;
    painting.movie.soundFrom = options.from;
    painting.movie.onNotice = [](const std::string& notice) { spdlog::warn("{}", notice); };
    return runPainting({.camera = recording.get(),
                        .options = configuredPainting(configuration, std::move(painting)),
                        .scene = std::move(scene),
                        .progressVerb = "painting",
                        .summaryVerb = "painted"});
  });
}

}  // namespace pleinair::app
