#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "config/suggestion.h"
#include "firmware_app/cli/exit_status.h"
#include "firmware_app/cli/interrupt.h"
#include "firmware_app/commands/commands.h"
#include "firmware_app/thesis/thesis_bench.h"
#include "firmware_app/thesis/thesis_figures.h"
#include "firmware_app/thesis/thesis_page.h"
#include "hal/media/png_file.h"
#include "hal/pending_file.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;
using hal::orThrow;

constexpr int kControlsWrong = 2;
constexpr const char* kPage = "thesis.html";
constexpr const char* kNumbers = "thesis.json";

/// By the name of its files, or by one of its numbers: "15" of "15_16_21".
bool isFigure(const ThesisFigureKind& kind, const std::string& name) {
  return name == kind.name || std::ranges::any_of(kind.numbers, [&](int number) {
           return name == std::to_string(number);
         });
}

std::vector<ThesisFigureKind> chosenFigures(const std::vector<std::string>& only) {
  std::vector<ThesisFigureKind> chosen;
  std::vector<std::string> names;
  for (const ThesisFigureKind& kind : thesisFigures()) names.emplace_back(kind.name);
  for (const std::string& name : only) {
    const bool isKnown = std::ranges::any_of(
        thesisFigures(), [&](const ThesisFigureKind& kind) { return isFigure(kind, name); });
    if (!isKnown) {
      throw hal::Failure(
          {.kind = hal::ErrorKind::kInvalidArgument,
           .subject = "--only",
           .problem = fmt::format("there is no figure \"{}\"", name),
           .remedy = "give " + config::listText(names) + ", or one of these numbers"});
    }
  }
  for (const ThesisFigureKind& kind : thesisFigures()) {
    const bool isChosen =
        std::ranges::any_of(only, [&](const std::string& name) { return isFigure(kind, name); });
    if (only.empty() || isChosen) chosen.push_back(kind);
  }
  return chosen;
}

void makeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder, error)) {
    throw hal::Failure({.kind = hal::ErrorKind::kInvalidArgument,
                        .subject = folder.string(),
                        .problem = "is no folder and cannot be made one",
                        .remedy = "give another --output"});
  }
}

void writeText(const fs::path& path, const std::string& text) {
  hal::PendingFile file = orThrow(hal::PendingFile::create(path));
  orThrow(file.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}));
  orThrow(file.publish());
}

ThesisEntry entryOf(const ThesisFigureKind& kind, ThesisBench& bench, const fs::path& folder) {
  const auto start = std::chrono::steady_clock::now();
  ThesisEntry entry{.kind = kind, .figure = kind.make(bench), .files = {}};
  for (std::size_t i = 0; i < entry.figure.pictures.size(); ++i) {
    entry.files.push_back(fmt::format("figure_{}_{}.png", kind.name, i + 1));
    const hal::Image image = imageOf(entry.figure.pictures[i].image);
    orThrow(hal::writePng(folder / entry.files.back(), image.view()));
  }
  entry.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::fputs(fmt::format("{:.1f} s  {}\n", entry.seconds, kind.title).c_str(), stdout);
  std::fflush(stdout);  // the next figure takes a while
  return entry;
}

}  // namespace

int makeThesisReport(const ThesisOptions& options) {
  const std::vector<ThesisFigureKind> kinds = chosenFigures(options.only);
  makeFolder(options.output);
  const Interrupt interrupt;
  const ThesisSize size = options.quick ? quickThesisSize() : ThesisSize{};
  ThesisBench bench(size, [] { return Interrupt::received() == 0; });
  ThesisReport report{
      .settings = fmt::format("{}Films of {}x{}: {} frames after {}. Painted by the style "
                              "painterly, look oil, on {}.",
                              options.quick ? "A quick report, too small to judge by. " : "",
                              size.picture.width, size.picture.height, size.frames, size.settle,
                              bench.plainPainter().contextInfo().renderer),
      .entries = {},
      .failedControls = {}};
  try {
    for (const ThesisFigureKind& kind : kinds) {
      if (Interrupt::received() != 0) throw ThesisInterrupted{};
      report.entries.push_back(entryOf(kind, bench, options.output));
    }
  } catch (const ThesisInterrupted&) {
    printError(fmt::format("interrupted by {}", signalName(Interrupt::received())));
    return kSignalExitBase + Interrupt::received();
  }
  report.failedControls = bench.failedControls();
  writeText(options.output / kNumbers, thesisJson(report));
  writeText(options.output / kPage, thesisHtml(report));
  std::fputs(fmt::format("wrote {}\n", (options.output / kPage).string()).c_str(), stdout);
  if (report.failedControls.empty()) return 0;
  printError("a negative control failed; see the report");
  return kControlsWrong;
}

}  // namespace pleinair::app
