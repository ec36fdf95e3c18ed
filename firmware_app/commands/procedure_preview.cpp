#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "firmware_app/cli/exit_status.h"
#include "firmware_app/cli/interrupt.h"
#include "firmware_app/cli/path_collisions.h"
#include "firmware_app/cli/progress.h"
#include "firmware_app/cli/standard_streams.h"
#include "firmware_app/commands/procedure.h"
#include "firmware_app/overlay/step_movie.h"
#include "firmware_app/procedure/step_pictures.h"
#include "firmware_app/procedure/step_tile.h"
#include "hal/media/picture_file.h"
#include "hal/media/png_file.h"
#include "hal/pending_file.h"
#include "pipeline/present/labelled_sheet.h"
#include "pipeline/procedure/procedure_file.h"

namespace pleinair::app {
namespace {

using hal::orThrow;
using procedure::Procedure;

constexpr hal::FrameSize kStepPicture{480, 360};
constexpr int kStepColumns = 4;
constexpr int kMaxStepColumns = 16;  // a sheet's side is limited (hal::kMaxSidePixels)
constexpr int kStepSheetGap = 40;    // of a tile: gaps and its label, and a little more

std::string stepLanguage(const ProcedurePreviewOptions& options, const Procedure& procedure) {
  if (options.language.empty()) return procedure.languages.front();
  if (std::ranges::find(procedure.languages, options.language) != procedure.languages.end()) {
    return options.language;
  }
  throw hal::Failure({.kind = hal::ErrorKind::kInvalidArgument,
                      .subject = "--language",
                      .problem = fmt::format("found \"{}\"", options.language),
                      .remedy = fmt::format("one of {}", fmt::join(procedure.languages, ", "))});
}

/// A step for each name of a node, with all parts of that name; a step for each of a few, which a
/// procedure may want to tell apart.
Procedure stepsOfNodes(const Procedure& procedure) {
  std::map<std::string, std::vector<std::size_t>> nodes;
  for (std::size_t i = 0; i < procedure.model->parts.size(); ++i) {
    nodes[procedure.model->parts[i].name].push_back(i);
  }
  Procedure drawn = procedure;
  drawn.steps.clear();
  const auto add = [&](const std::string& name, const std::vector<std::size_t>& parts,
                       const std::string& count) {
    procedure::StepText text{.title = name, .body = count, .question = {}, .pictures = {}};
    drawn.steps.push_back(
        {.id = name, .parts = parts, .text = {{procedure.languages.front(), std::move(text)}}});
  };
  constexpr std::size_t kFew = 4;
  for (const auto& [name, parts] : nodes) {
    if (parts.size() == 1 || parts.size() > kFew) {
      add(name, parts, parts.size() > 1 ? fmt::format("×{}", parts.size()) : "");
      continue;
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
      add(fmt::format("{}#{}", name, i + 1), {parts[i]},
          fmt::format("{} / {}: {}", i + 1, parts.size(), name));
    }
  }
  return drawn;
}

/// The step's movie, as its first frame, and the pictures of its text.
std::vector<hal::Image> illustrationsOf(const Procedure& procedure, std::size_t step,
                                        const std::string& language,
                                        const std::filesystem::path& folder) {
  std::vector<hal::Image> all;
  if (const auto& movie = procedure.steps[step].movie) {
    if (auto poster = moviePoster(folder / movie->file, kIllustrationRows)) {
      all.push_back(*std::move(poster));
    }
  }
  for (const procedure::StepPicture& each : procedure.text(step, language).pictures) {
    const auto picture = hal::readPictureRgb(folder / each.file);
    if (!picture) continue;  // it was there when the procedure was read
    all.push_back(scaledRgb(picture->view(), sizeOfRows(picture->size(), kIllustrationRows)));
  }
  return all;
}

/// As many columns as let the sheet be no higher than an image may be.
int stepColumns(std::size_t steps, int tileHeight) {
  const int rows = std::max(1, hal::kMaxSidePixels / (tileHeight + kStepSheetGap));
  const int needed = (static_cast<int>(steps) + rows - 1) / rows;
  if (needed > kMaxStepColumns) {
    throw hal::Failure({.kind = hal::ErrorKind::kUnsupported,
                        .subject = "preview",
                        .problem = fmt::format("{} steps do not fit on one sheet", steps),
                        .remedy = fmt::format("at most {} steps", rows * kMaxStepColumns)});
  }
  return std::max(kStepColumns, needed);
}

}  // namespace

int previewProcedure(const ProcedurePreviewOptions& options) {
  const Interrupt interrupt;
  const procedure::ProcedureReading reading = procedure::readProcedureFolder(options.folder);
  if (!reading.faults.empty()) throw reading.faults.front();
  warnOfLikelyMistakes(reading, options.folder);
  const Procedure& loaded = reading.procedure;
  const Procedure procedure = options.nodes ? stepsOfNodes(loaded) : loaded;
  const std::string language = stepLanguage(options, procedure);
  std::vector<NamedPath> read;
  for (const std::string& file : procedure.files) {
    read.push_back({"a file of the procedure", options.folder / file});
  }
  refuseCollisions(read, {{"--output", options.output}});
  int textRows = 0;
  for (std::size_t i = 0; i < procedure.steps.size(); ++i) {
    textRows = std::max(textRows, stepTextRows(procedure, i, language, kStepPicture.width));
  }
  const int columns = stepColumns(procedure.steps.size(), kStepPicture.height + textRows);
  hal::PendingFile file = orThrow(hal::PendingFile::create(options.output));
  StepPictures pictures(procedure, kStepPicture, options.nodes);
  hal::SteadyClock clock;
  Progress progress("drawing", procedure.steps.size(), clock);
  std::vector<present::LabelledImage> tiles;
  std::set<std::size_t> off;  // in the order of the file
  for (std::size_t i = 0; i < procedure.steps.size(); ++i) {
    if (const int signal = Interrupt::received(); signal != 0) {
      printError(fmt::format("interrupted by {}; nothing was written", signalName(signal)));
      return kSignalExitBase + signal;
    }
    const procedure::Step& step = procedure.steps[i];
    for (const std::size_t part : step.fits) off.erase(part);
    const hal::Image picture = pictures.draw(i, off);
    off.insert(step.removes.begin(), step.removes.end());
    tiles.push_back(
        {.image = stepTile(procedure, i, language, picture,
                           illustrationsOf(procedure, i, language, options.folder), textRows),
         .label = step.id});
    progress.advance();
  }
  const hal::Image sheet = present::labelledSheet(tiles, columns);
  orThrow(file.write(orThrow(hal::encodePng(sheet.view()))));
  orThrow(file.publish());
  writeText(stdout, fmt::format("drew {} {}: {}\n", tiles.size(), options.nodes ? "nodes" : "steps",
                                options.output.string()));
  return 0;
}

}  // namespace pleinair::app
