#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "firmware_app/cli/compile_notice.h"
#include "firmware_app/cli/exit_status.h"
#include "firmware_app/cli/interrupt.h"
#include "firmware_app/cli/path_collisions.h"
#include "firmware_app/cli/standard_streams.h"
#include "firmware_app/commands/commands.h"
#include "hal/cameras/recording/recording.h"
#include "hal/media/png_file.h"
#include "hal/pending_file.h"
#include "pipeline/engine/painter.h"
#include "pipeline/present/labelled_sheet.h"
#include "pipeline/styles/registry.h"

namespace pleinair::app {
namespace {

using hal::orThrow;

/// A picture is painted at this size at most, so that its marks are seen in the sheet as they are.
constexpr int kMaxTileWidth = 560;
constexpr int kMaxTileHeight = 420;
constexpr int kColumns = 4;

hal::FrameSize tileSizeOf(hal::FrameSize input) {
  const double scale = std::min({1.0, static_cast<double>(kMaxTileWidth) / input.width,
                                 static_cast<double>(kMaxTileHeight) / input.height});
  const auto side = [scale](int full) {
    return std::max(1, static_cast<int>(std::lround(full * scale)));
  };
  return {side(input.width), side(input.height)};
}

std::vector<const styles::StyleKind*> chosenStyles(const std::vector<std::string>& names) {
  std::vector<const styles::StyleKind*> chosen;
  for (const std::string& name : names) chosen.push_back(&styles::styleKind(name));
  if (!names.empty()) return chosen;
  for (const styles::StyleKind* kind : styles::styleKinds()) {
    if (!kind->looks.empty()) chosen.push_back(kind);
  }
  return chosen;
}

/// Paints the frame in each look of a style.
void addLooks(const styles::StyleKind& kind, const hal::CapturedFrame& frame, hal::FrameSize size,
              std::vector<present::LabelledImage>& tiles) {
  Painter painter({.pictureSize = size,
                   .style = std::string(kind.name),
                   .tracksTags = false,
                   .expectedFormat = frame.image.format,
                   .isCancelled = cancelledBySignal()});
  std::vector<std::pair<std::string, config::ParameterValues>> looks;
  for (const styles::Look& look : kind.looks) {
    looks.emplace_back(fmt::format("{} · {}", kind.name, look.name), kind.parametersOf(look.name));
  }
  if (looks.empty()) looks.emplace_back(std::string(kind.name), kind.defaults);
  for (auto& [label, parameters] : looks) {
    if (Interrupt::received() != 0) return;
    painter.reset();
    orThrow(painter.paint(frame, {.style = std::move(parameters), .view = {}}));
    if (tiles.empty()) tiles.push_back({orThrow(painter.cameraSnapshot()), "the input"});
    tiles.push_back({orThrow(painter.snapshot()), std::move(label)});
  }
}

}  // namespace

int showLooks(const LooksOptions& options) {
  const Interrupt interrupt;
  const std::vector<const styles::StyleKind*> kinds = chosenStyles(options.styles);
  refuseCollisions({{"--input", options.input}}, {{"--output", options.output}});
  hal::SteppedClock clock;
  const auto camera = hal::openRecording(options.input, clock, {.from = options.at});
  orThrow(camera->start({}));
  hal::PendingFile file = orThrow(hal::PendingFile::create(options.output));
  // start() has found it.
  const auto frame = std::get<hal::CapturedFrame>(camera->next(hal::kNoDeadline));
  std::vector<present::LabelledImage> tiles;
  try {
    for (const styles::StyleKind* kind : kinds) {
      addLooks(*kind, frame, tileSizeOf(frame.image.format.size), tiles);
    }
  } catch (const hal::Failure& failure) {
    if (failure.error().kind != hal::ErrorKind::kCancelled) throw;
  }
  if (const int signal = Interrupt::received(); signal != 0) {
    printError(fmt::format("interrupted by {}; nothing was written", signalName(signal)));
    return kSignalExitBase + signal;
  }
  const hal::Image sheet = present::labelledSheet(tiles, kColumns);
  orThrow(file.write(orThrow(hal::encodePng(sheet.view()))));
  orThrow(file.publish());
  writeText(stdout,
            fmt::format("painted {} looks: {}\n", tiles.size() - 1, options.output.string()));
  return 0;
}

}  // namespace pleinair::app
