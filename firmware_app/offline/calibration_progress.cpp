#include "firmware_app/offline/calibration_progress.h"

#include <array>
#include <cstdio>
#include <string_view>

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "firmware_app/cli/standard_streams.h"

namespace pleinair::app {
namespace {

using calibration::Coverage;
using calibration::Tilt;
using calibration::ViewOutcome;
using calibration::ViewSelector;

constexpr hal::Duration kRedrawPeriod = std::chrono::milliseconds(250);
constexpr hal::Duration kReportPeriod = std::chrono::seconds(5);

std::string_view outcomeText(ViewOutcome outcome) {
  switch (outcome) {
    case ViewOutcome::kTaken:
      return "taken";
    case ViewOutcome::kNoBoard:
      return "the board is not completely visible";
    case ViewOutcome::kBlurred:
      return "blurred: hold it still, or add light";
    case ViewOutcome::kMoving:
      return "moving: hold it still";
    case ViewOutcome::kNothingNew:
      break;
  }
  return "nothing new";
}

std::string nextStepText(const ViewSelector& selector) {
  if (selector.counts().withBoard == 0) return "show the whole board";
  if (const auto request = selector.coverage().missingViews()) return *request;
  return selector.isComplete() ? "enough" : "show it in a few more ways";
}

std::string viewsText(const ViewSelector& selector) {
  const std::size_t views = selector.views().size();
  return fmt::format("{} {}", views, views == 1 ? "view" : "views");
}

std::string cellsText(const Coverage& coverage, int row) {
  std::string text;
  for (int column = 0; column < calibration::kCellColumns; ++column) {
    const int views = coverage.viewsInCell(column, row);
    text += views == 0 ? ". " : views < Coverage::kWantedPerCell ? "o " : "O ";
  }
  return text;
}

std::string tiltsText(const Coverage& coverage) {
  constexpr std::array<std::string_view, calibration::kTilts> kNames{"left", "right", "upper",
                                                                     "lower"};
  std::string text = "side nearer:";
  for (std::size_t tilt = 0; tilt < kNames.size(); ++tilt) {
    text += fmt::format(" {} {}", kNames.at(tilt), coverage.viewsWith(static_cast<Tilt>(tilt)));
  }
  return text;
}

}  // namespace

std::vector<std::string> coveragePanel(const ViewSelector& selector, ViewOutcome last) {
  const Coverage& coverage = selector.coverage();
  const calibration::ViewCounts& counts = selector.counts();
  const std::array<std::string, calibration::kCellRows> beside{
      fmt::format("{}; the board in {} of {} pictures", viewsText(selector), counts.withBoard,
                  counts.pictures),
      tiltsText(coverage),
      fmt::format("{:.0f} % of the picture reached", coverage.coveredShare() * 100.0),
      selector.sharpestEdgePx() > 0.0
          ? fmt::format("sharpest edges {:.1f} px", selector.sharpestEdgePx())
          : std::string(),
      fmt::format("now:  {}", outcomeText(last)),
      fmt::format("next: {}", nextStepText(selector))};
  std::vector<std::string> lines;
  lines.reserve(calibration::kCellRows);
  for (int row = 0; row < calibration::kCellRows; ++row) {
    lines.push_back(cellsText(coverage, row) + "  " + beside.at(static_cast<std::size_t>(row)));
  }
  return lines;
}

CalibrationProgress::CalibrationProgress(const hal::Clock& clock)
    : clock_(clock), told_(clock.now()), isTerminal_(isatty(STDERR_FILENO) != 0) {}

void CalibrationProgress::advance(const ViewSelector& selector, ViewOutcome outcome) {
  const hal::TimePoint now = clock_.now();
  if (isTerminal_) {
    if (drawnLines_ > 0 && outcome != ViewOutcome::kTaken && now - told_ < kRedrawPeriod) return;
    draw(coveragePanel(selector, outcome));
  } else {
    if (now - told_ < kReportPeriod) return;
    tell(selector);
  }
  told_ = now;
}

void CalibrationProgress::interrupt() {
  if (drawnLines_ == 0) return;
  writeText(stderr,
            fmt::format("\x1b[{}A\x1b[J", drawnLines_));  // cursor up, then clear from there on
  std::fflush(stderr);
  drawnLines_ = 0;
}

void CalibrationProgress::draw(const std::vector<std::string>& lines) {
  std::string text = drawnLines_ > 0 ? fmt::format("\x1b[{}A", drawnLines_) : std::string();
  for (const std::string& line : lines) text += line + "\x1b[K\n";
  writeText(stderr, text);
  std::fflush(stderr);
  drawnLines_ = lines.size();
}

void CalibrationProgress::tell(const ViewSelector& selector) {
  std::string line =
      fmt::format("{} views; next: {}", selector.views().size(), nextStepText(selector));
  if (line == lastLine_) return;
  spdlog::info("{}", line);
  lastLine_ = std::move(line);
}

}  // namespace pleinair::app
