#include "tests/reports/painter/coherence_parts.h"

#include <array>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "firmware_app/offline/measured_engine.h"
#include "pipeline/measure/measurement.h"
#include "pipeline/styles/registry.h"

namespace pleinair {
namespace {

constexpr std::array<CoherenceVariant, 9> kVariants{{
    {"the painter", "", ""},
    {"– no warp", "warp", "false"},
    {"– no history", "history", "false"},
    {"– no hysteresis", "hysteresis", "false"},
    {"– no fades", "fades", "false"},
    {"coherence 0", "coherence", "0"},
    {"– 0.25", "coherence", "0.25"},
    {"– 0.75", "coherence", "0.75"},
    {"– 1", "coherence", "1"},
}};

std::string turnoverText(const std::optional<measure::AnchorSummary>& inside) {
  return inside ? fmt::format("{:.2f}", inside->innerTurnoverPercent) : "–";
}

void printRow(std::string_view name, const measure::Report& report) {
  std::string line = fmt::format("| {} |", name);
  for (const measure::MeasureColumn& column : measure::measureColumns()) {
    line += " " + measure::textOf(column, report.measures[measure::Subject::kPainting]) + " |";
  }
  fmt::print("{} {} | {} |\n", line, turnoverText(report.inside), turnoverText(report.insideStill));
  std::fflush(stdout);  // the next line takes minutes
}

void printInput(const std::string& title, const OpenInput& open, const MeasuredLength& length) {
  fmt::print("\n**{}**\n\n| |", title);
  for (const measure::MeasureColumn& column : measure::measureColumns()) {
    fmt::print(" {} |", column.name);
  }
  fmt::print(" turnover, % | still |\n|---|");
  for (std::size_t i = 0; i < measure::measureColumns().size(); ++i) fmt::print("---|");
  fmt::print("---|---|\n");
  CoherenceParts parts(open, length);
  for (const CoherenceVariant& each : kVariants) printRow(each.name, parts.measured(each));
}

}  // namespace

std::span<const CoherenceVariant> coherenceVariants() {
  return kVariants;
}

CoherenceParts::CoherenceParts(OpenInput open, const MeasuredLength& length)
    : open_(std::move(open)), length_(length) {
  const hal::FrameFormat format = open_()->format();
  painter_ = std::make_unique<Painter>(PainterOptions{.pictureSize = format.size,
                                                      .scene = {},
                                                      .style = "painterly",
                                                      .tracksTags = false,
                                                      .expectedFormat = format});
}

measure::Report CoherenceParts::measured(const CoherenceVariant& variant) {
  PaintParameters parameters = painter_->defaultParameters();
  if (!variant.parameter.empty()) {
    parameters.style =
        parameters.style.with(std::string(variant.parameter), std::string(variant.value));
  }
  painter_->reset();
  const std::unique_ptr<measure::MeasuredInput> input = open_();
  app::MeasuredEngine engine(*painter_, parameters, input->format().size);
  std::optional<measure::Report> report =
      hal::orThrow(measure::measure(*input, engine,
                                    {.style = "painterly",
                                     .coherence = styles::styleKind("painterly").coherence,
                                     .settings = std::string(variant.name),
                                     .frames = length_.frames,
                                     .settle = length_.settle,
                                     .stillFrames = length_.stillFrames,
                                     .stillSettle = length_.stillSettle}));
  return std::move(*report);
}

void printCoherenceParts(const std::filesystem::path& photograph, hal::FrameSize size,
                         const MeasuredLength& length) {
  const std::uint64_t frames = length.settle + length.frames;
  const auto moved = [&](const measure::PhotographMotion& motion) {
    return [=] {
      return hal::orThrow(
          measure::openPhotograph(photograph, {.size = size, .motion = motion, .frames = frames}));
    };
  };
  const std::string name = photograph.stem().string();
  fmt::print(
      "The painter's coherence by parts, {}x{}: {} frames after {}, a still of {} after {}. "
      "Turnover: births and\ndeaths away from the border, of all layers' marks, a frame.\n",
      size.width, size.height, length.frames, length.settle, length.stillFrames,
      length.stillSettle);
  printInput(name + ", pan by (-1.5, -0.5) px a frame", moved({.pan = {-1.5, -0.5}}), length);
  printInput(name + ", roll by 1° a frame", moved({.rollDegrees = 1.0}), length);
  printInput(name + ", zoom by 1 % a frame", moved({.zoomPercent = 1.0}), length);
  printInput(
      "workbench, walkaround",
      [&] { return hal::orThrow(measure::openWorkbench({.size = size, .frameCount = frames})); },
      length);
}

}  // namespace pleinair
