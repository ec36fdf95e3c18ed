#include "firmware_app/procedure/step_tile.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "hal/text/text_coverage.h"
#include "pipeline/procedure/words.h"

namespace pleinair::app {
namespace {

using procedure::Outcome;
using procedure::Procedure;
using procedure::Step;
using Colour = std::array<std::uint8_t, 3>;

constexpr int kMarginPx = 10;
constexpr int kGapPx = 5;
constexpr Colour kInk{25, 25, 25};
constexpr Colour kMuted{95, 95, 95};
constexpr Colour kWhite{255, 255, 255};

/// A block of text, on a coloured bar if `ground` is not white.
struct TextBlock {
  std::string text;
  int pixels = 15;
  Colour ink = kInk;
  Colour ground = kWhite;
  std::string font = "Sans";
};

// Safety colours of ISO 3864-4 and ANSI Z535.1: red, orange, yellow, blue.
std::pair<Colour, Colour> warningColours(procedure::WarningLevel level) {
  switch (level) {
    case procedure::WarningLevel::kDanger:
      return {kWhite, Colour{190, 20, 25}};
    case procedure::WarningLevel::kWarning:
      return {kInk, Colour{245, 130, 30}};
    case procedure::WarningLevel::kCaution:
      return {kInk, Colour{250, 210, 30}};
    case procedure::WarningLevel::kNotice:
      return {kWhite, Colour{0, 85, 160}};
  }
  return {kInk, kWhite};
}

std::string checkText(const Procedure& procedure, std::size_t index, const std::string& language) {
  const Step& step = procedure.steps[index];
  const procedure::Words& words = procedure::wordsIn(language);
  const std::string& question = procedure.text(index, language).question;
  std::string text = question.empty() ? std::string(step.check->kind == procedure::CheckKind::kPhoto
                                                        ? words.photo
                                                        : words.comparison)
                                      : question;
  if (step.check->kind == procedure::CheckKind::kValue) {
    text += ": " + procedure::withDecimals(procedure::limitsText(*step.check), language);
  }
  return "☐ " + text;
}

/// "yes → 5, no → 20": a step that an outcome keeps leads to itself.
std::string branchText(const Procedure& procedure, std::size_t index, const std::string& language) {
  const Step& step = procedure.steps[index];
  const procedure::Words& words = procedure::wordsIn(language);
  std::vector<std::string> branches;
  for (const Outcome outcome : procedure::outcomesOf(step.checkKind())) {
    const auto found = step.next.find(outcome);
    const std::size_t next = found != step.next.end() ? found->second : index;
    branches.push_back(fmt::format(
        "{} → {}", procedure::wordOf(words, outcome),
        next == procedure::kEnd ? std::string(words.end) : fmt::format("{}", next + 1)));
  }
  return fmt::format("{}", fmt::join(branches, ",  "));
}

std::vector<TextBlock> blocksOf(const Procedure& procedure, std::size_t index,
                                const std::string& language) {
  const Step& step = procedure.steps[index];
  const procedure::StepText& text = procedure.text(index, language);
  const procedure::Words& words = procedure::wordsIn(language);
  std::vector<TextBlock> blocks;
  blocks.push_back(
      {.text = fmt::format("{}  {}", index + 1, text.title), .pixels = 20, .font = "Sans Bold"});
  for (const std::size_t each : step.warnings) {
    const procedure::Warning& warning = procedure.warnings[each];
    const auto [ink, ground] = warningColours(warning.level);
    blocks.push_back({.text = fmt::format("{}  {}", procedure::wordOf(words, warning.level),
                                          translated(procedure, warning.text, language)),
                      .ink = ink,
                      .ground = ground,
                      .font = "Sans Bold"});
  }
  if (!text.body.empty()) blocks.push_back({.text = procedure::plainText(text.body), .pixels = 16});
  if (!step.tools.empty()) {
    std::vector<std::string> names;
    for (const std::size_t each : step.tools) {
      names.push_back(translated(procedure, procedure.tools[each].name, language));
    }
    blocks.push_back(
        {.text = fmt::format("{}: {}", words.tools, fmt::join(names, ", ")), .ink = kMuted});
  }
  if (step.torque) {
    blocks.push_back({.text = fmt::format("{}: {}", words.torque,
                                          procedure::withDecimals(step.torque->text, language)),
                      .font = "Sans Bold"});
  }
  if (step.check) {
    blocks.push_back({.text = checkText(procedure, index, language), .font = "Sans Bold"});
    blocks.push_back({.text = branchText(procedure, index, language), .pixels = 13, .ink = kMuted});
  }
  return blocks;
}

hal::Image inkOf(const TextBlock& block, int width) {
  return hal::textCoverage(block.text, {.font = block.font,
                                        .fontPixels = block.pixels,
                                        .maxWidth = std::max(1, width - 2 * kMarginPx),
                                        .tooWide = hal::TextLayout::TooWide::kWrap});
}

void fill(hal::Image& image, int fromRow, int toRow, const Colour& colour) {
  for (int y = std::max(0, fromRow); y < std::min(toRow, image.size().height); ++y) {
    const auto row = image.row(0, y);
    for (std::size_t i = 0; i + 2 < row.size(); i += 3)
      std::ranges::copy(colour, row.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

void drawInk(hal::Image& image, const hal::Image& ink, int top, const TextBlock& block) {
  for (int y = 0; y < ink.size().height && top + y < image.size().height; ++y) {
    const auto coverage = ink.view().row(0, y);
    const auto row = image.row(0, top + y).subspan(3 * static_cast<std::size_t>(kMarginPx));
    for (std::size_t x = 0; x < coverage.size() && 3 * x + 2 < row.size(); ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        const int mixed = block.ground.at(c) * (255 - coverage[x]) + block.ink.at(c) * coverage[x];
        if (coverage[x] > 0) row[3 * x + c] = static_cast<std::uint8_t>(mixed / 255);
      }
    }
  }
}

void paste(hal::Image& image, const hal::Image& picture, int left, int top) {
  const std::size_t columns =
      static_cast<std::size_t>(std::clamp(image.size().width - left, 0, picture.size().width));
  for (int y = 0; y < picture.size().height && top + y < image.size().height; ++y) {
    const auto from = picture.view().row(0, y).first(3 * columns);
    const auto row = image.row(0, top + y);
    if (columns > 0) std::ranges::copy(from, row.begin() + 3 * left);
  }
}

}  // namespace

int stepTextRows(const Procedure& procedure, std::size_t step, const std::string& language,
                 int width) {
  int rows = kGapPx;
  for (const TextBlock& block : blocksOf(procedure, step, language)) {
    rows += inkOf(block, width).size().height + 2 * kGapPx;
  }
  const bool hasAny =
      procedure.steps[step].movie || !procedure.text(step, language).pictures.empty();
  return rows + (hasAny ? kIllustrationRows + 2 * kGapPx : 0);
}

hal::Image stepTile(const Procedure& procedure, std::size_t step, const std::string& language,
                    const hal::Image& picture, std::span<const hal::Image> illustrations,
                    int textRows) {
  const hal::FrameSize size = picture.size();
  hal::Image tile(
      {.pixelFormat = hal::PixelFormat::kRgb8, .size = {size.width, size.height + textRows}});
  fill(tile, 0, tile.size().height, kWhite);
  for (int y = 0; y < size.height; ++y) {
    std::ranges::copy(picture.view().row(0, y), tile.row(0, y).begin());
  }
  int top = size.height + kGapPx;
  for (const TextBlock& block : blocksOf(procedure, step, language)) {
    const hal::Image ink = inkOf(block, size.width);
    const int bottom = top + ink.size().height + kGapPx;
    if (block.ground != kWhite) fill(tile, top - 2, bottom - 1, block.ground);
    drawInk(tile, ink, top, block);
    top = bottom + kGapPx;
  }
  int left = kMarginPx;
  for (const hal::Image& each : illustrations) {
    paste(tile, each, left, top);
    left += each.size().width + kMarginPx;
  }
  return tile;
}

}  // namespace pleinair::app
