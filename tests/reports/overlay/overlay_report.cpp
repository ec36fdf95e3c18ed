// Prints the overlay's table of docs/measured.md as Markdown, and plots the true and the predicted
// error, and how far the overlay is shown, over each film: `overlay_report PAGE.html`. Needs a GPU,
// or a software one: two minutes.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "pipeline/measure/report/report_plots.h"
#include "tests/reports/overlay/label_walkaround.h"
#include "tests/reports/overlay/truth_film.h"

namespace pleinair::overlay_truth {
namespace {

constexpr const char* kHead = R"(<!doctype html><meta charset="utf-8"><title>The overlay</title>
<style>body { margin: 2rem auto; max-width: 76rem; font: 16px/1.5 sans-serif; }
.plots { display: grid; grid-template-columns: repeat(auto-fill, minmax(22rem, 1fr)); gap: 1rem; }
svg { border: 1px solid #d8dce1; width: 100%; } .grid { stroke: #d8dce1; }
.tick, .label { fill: #68707a; font-size: 10px; } .title { font-size: 12px; font-weight: 600; }
.line { fill: none; stroke-width: 1.6; } .error { stroke: #b3261e; } .predicted { stroke: #3d6f99; }
.shown { stroke: #2d7a46; stroke-width: 3; } .x { stroke: #b5452c; } .y { stroke: #3d6f99; }
</style><h1>The overlay against true poses</h1>
<p>Red: true error at the worst of the step's parts, px (cut at 8; gaps: no place, or another
machine). Blue: predicted, one standard deviation. Green: how far it is shown, 1 is wholly.</p>
<div class="plots">
)";

std::vector<std::uint64_t> numbered(std::size_t count) {
  std::vector<std::uint64_t> numbers(count);
  for (std::size_t i = 0; i < count; ++i) numbers[i] = i;
  return numbers;
}

std::string plotOf(const std::string& name, const std::vector<Moment>& moments) {
  static constexpr double kMostPx = 8.0;
  const auto cut = [](double px) {
    return std::isfinite(px) ? std::optional(std::min(px, kMostPx)) : std::nullopt;
  };
  measure::PlotLine error{.name = "true error", .style = "error", .values = {}};
  measure::PlotLine predicted{.name = "predicted error", .style = "predicted", .values = {}};
  measure::PlotLine shown{.name = "shown", .style = "shown", .values = {}};
  for (const Moment& each : moments) {
    error.values.push_back(each.errorPx ? cut(*each.errorPx) : std::nullopt);
    predicted.values.push_back(cut(each.predictedPx));
    shown.values.push_back(each.opacity);
  }
  return measure::plotSvg({.title = name, .unit = "px; share"}, numbered(moments.size()),
                          {error, predicted, shown});
}

std::string labelPlot() {
  LabelWalkaround walk(false);
  walk.play(60);
  std::vector<LabelTrack> tracks = std::move(walk.tracks.front().completed);
  tracks.push_back(std::move(walk.tracks.front()));
  const LabelTrack& longest =
      *std::ranges::max_element(tracks, {}, [](const LabelTrack& each) { return each.x.size(); });
  const auto lineOf = [](const char* name, const std::vector<double>& values) {
    return measure::PlotLine{.name = name, .style = name, .values = {values.begin(), values.end()}};
  };
  const std::string title = fmt::format("a label against its place on the machine: {:.2f} px/s",
                                        longest.driftPxPerSecond());
  std::printf("\n%s, for %zu frames\n", title.c_str(), longest.x.size());
  return measure::plotSvg({.title = title, .unit = "px"}, numbered(longest.x.size()),
                          {lineOf("x", longest.x), lineOf("y", longest.y)});
}

int run(const std::string& file) {
  std::string page = kHead;
  std::printf(
      "| film | wrong by more than 5 px, shown | right within 2 px, shown |\n|---|---|---|\n");
  Counts all;
  for (const NamedFilm& each : truthFilms()) {
    const std::vector<Moment> moments = play(each.film);
    const Counts counts = countsOf(moments);
    std::printf("| %s | %d of %d | %d of %d |\n", each.name.c_str(), counts.wrongAndShown,
                counts.wrong, counts.rightAndShown, counts.right);
    std::fflush(stdout);
    all.wrongAndShown += counts.wrongAndShown;
    all.wrong += counts.wrong;
    all.rightAndShown += counts.rightAndShown;
    all.right += counts.right;
    page += plotOf(each.name, moments);
  }
  std::printf("| all | %d of %d | %d of %d |\n", all.wrongAndShown, all.wrong, all.rightAndShown,
              all.right);
  page += labelPlot() + "</div>\n";
  std::ofstream out(file, std::ios::binary);
  out << page;
  return out.flush() ? 0 : 1;
}

}  // namespace
}  // namespace pleinair::overlay_truth

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: overlay_report PAGE.html\n");
    return 1;
  }
  try {
    return pleinair::overlay_truth::run(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "overlay_report: %s\n", error.what());
    return 1;
  }
}
