#include "firmware_app/overlay/instruction_panel.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "firmware_app/overlay/card.h"
#include "firmware_app/overlay/step_movie.h"
#include "hal/media/picture_file.h"
#include "pipeline/overlay/reserved_colours.h"
#include "pipeline/procedure/words.h"

namespace pleinair::app {
namespace {

using procedure::Procedure;
using procedure::Step;

constexpr Rgb kGround{24, 26, 30};
constexpr Rgb kWhite{255, 255, 255};
constexpr Rgb kMuted{190, 194, 200};
constexpr Rgb kBlack{20, 20, 20};
constexpr Rgb kAmber{255, 205, 70};
constexpr std::uint8_t kGroundAlpha = 226;

/// Sizes for an output of this width.
struct Measures {
  explicit Measures(int width, double share = 1.0)
      : scale(share * std::clamp(width / 640.0, 0.55, 6.0)) {}
  double scale;
  int px(double atUsualWidth) const {
    return std::max(1, static_cast<int>(atUsualWidth * scale + 0.5));
  }
};

int mostHeight(hal::FrameSize output) {
  return 2 * output.height / 5;
}

// Safety colours of ISO 3864-4 and ANSI Z535.1: red, orange, yellow, blue.
std::pair<Rgb, Rgb> inkAndGroundOf(procedure::WarningLevel level) {
  switch (level) {
    case procedure::WarningLevel::kDanger:
      return {kWhite, Rgb{200, 16, 24}};
    case procedure::WarningLevel::kWarning:
      return {kBlack, Rgb{250, 135, 30}};
    case procedure::WarningLevel::kCaution:
      return {kBlack, Rgb{250, 210, 30}};
    case procedure::WarningLevel::kNotice:
      return {kWhite, Rgb{0, 85, 160}};
  }
  return {kBlack, kWhite};
}

/// A line or a paragraph of a column.
struct Line {
  hal::Image ink;
  Rgb colour = kWhite;
  bool hasBox = false;  ///< a check box stands before it
  bool isTicked = false;
};

struct Column {
  int x = 0;
  int width = 0;
  std::vector<Line> lines;

  int height(const Measures& m) const {
    int sum = 0;
    for (const Line& each : lines) sum += each.ink.size().height + m.px(4);
    return sum;
  }
  void add(const std::string& text, int px, const Rgb& colour, const char* font = "Sans") {
    if (!text.empty()) lines.push_back({.ink = inkOfText(text, px, width, font), .colour = colour});
  }
};

void drawColumn(Card& card, const Column& column, int top, const Measures& m) {
  int y = top;
  for (const Line& line : column.lines) {
    int x = column.x;
    if (line.hasBox) {
      const int side = m.px(14);
      card.border({x, y + m.px(3), side, side}, m.px(2), line.colour);
      if (line.isTicked) {
        card.fill({x + m.px(4), y + m.px(7), side - m.px(8), side - m.px(8)}, line.colour, 255);
      }
      x += side + m.px(7);
    }
    card.ink(line.ink, x, y, line.colour);
    y += line.ink.size().height + m.px(4);
  }
}

/// The first picture of a step's text, small; nothing where there is none that can be read.
std::optional<hal::Image> pictureOf(const procedure::StepText& text,
                                    const std::filesystem::path& folder, int rows,
                                    int mostColumns) {
  if (text.pictures.empty()) return std::nullopt;
  const auto read = hal::readPictureRgb(folder / text.pictures.front().file);
  if (!read) return std::nullopt;
  return scaledRgb(read->view(), sizeOfRows(read->size(), rows, mostColumns));
}

Column mainColumn(const StepShown& shown, int x, int width, const Measures& m) {
  Column column{.x = x, .width = width, .lines = {}};
  const Procedure& procedure = *shown.procedure;
  const procedure::Words& words = procedure::wordsIn(shown.language);
  if (shown.step == procedure::kEnd) {
    column.add(std::string(shown.isAborted ? words.aborted : words.theEnd), m.px(21), kWhite,
               "Sans Bold");
    return column;
  }
  const procedure::StepText& text = procedure.text(shown.step, shown.language);
  column.add(text.title, m.px(20), kWhite, "Sans Bold");
  if (!text.body.empty()) column.add(procedure::plainText(text.body), m.px(15), kWhite);
  return column;
}

Column sideColumn(const StepShown& shown, int x, int width, const Measures& m) {
  Column column{.x = x, .width = width, .lines = {}};
  const Procedure& procedure = *shown.procedure;
  const procedure::Words& words = procedure::wordsIn(shown.language);
  if (shown.step != procedure::kEnd) {
    const Step& step = procedure.steps[shown.step];
    if (step.torque)
      column.add(procedure::withDecimals(step.torque->text, shown.language), m.px(20), kAmber,
                 "Sans Bold");
    if (!step.tools.empty()) {
      std::vector<std::string> names;
      for (const std::size_t each : step.tools) {
        names.push_back(translated(procedure, procedure.tools[each].name, shown.language));
      }
      column.add(fmt::format("{}: {}", words.tools, fmt::join(names, ", ")), m.px(13), kMuted);
    }
  }
  if (!shown.request.empty()) {
    const bool hasCheck = shown.step != procedure::kEnd && procedure.steps[shown.step].check;
    const int textWidth = width - (hasCheck ? m.px(21) : 0);
    column.lines.push_back({.ink = inkOfText(shown.request, m.px(14), textWidth, "Sans Bold"),
                            .colour = hasCheck ? kAmber : kMuted,
                            .hasBox = hasCheck,
                            .isTicked = shown.isDone});
  }
  return column;
}

/// A panel, and how high it would be with all of its text.
struct Panel {
  InstructionPanel panel;
  int wholeHeight = 0;
};

/// A line over the whole width.
struct Bar {
  hal::Image ink;
  Rgb colour, ground;
};

std::vector<Bar> barsOf(const StepShown& shown, int width, const Measures& m) {
  const Procedure& procedure = *shown.procedure;
  const procedure::Words& words = procedure::wordsIn(shown.language);
  std::vector<Bar> bars;
  const auto addBar = [&](const std::string& line, const Rgb& colour, const Rgb& ground) {
    bars.push_back({inkOfText(line, m.px(16), width, "Sans Bold"), colour, ground});
  };
  if (shown.step != procedure::kEnd) {
    for (const std::size_t each : procedure.steps[shown.step].warnings) {
      const procedure::Warning& warning = procedure.warnings[each];
      const auto [ink, ground] = inkAndGroundOf(warning.level);
      addBar(fmt::format("⚠ {}  {}", procedure::wordOf(words, warning.level),
                         translated(procedure, warning.text, shown.language)),
             ink, ground);
    }
  }
  if (!shown.notice.empty()) addBar(shown.notice, kBlack, kAmber);
  return bars;
}

Panel panelOf(const StepShown& shown, const std::filesystem::path& folder, hal::FrameSize output,
              const Measures& m) {
  const Procedure& procedure = *shown.procedure;
  const bool isEnd = shown.step == procedure::kEnd;
  const int margin = m.px(9);
  const std::vector<Bar> bars = barsOf(shown, output.width - 2 * margin, m);
  int barsHeight = 0;
  for (const Bar& bar : bars) barsHeight += bar.ink.size().height + m.px(6);

  const std::string number =
      isEnd ? "" : fmt::format("{}/{}", shown.step + 1, procedure.steps.size());
  const hal::Image numberInk = inkOfText(number, m.px(19), output.width, "Sans Bold");
  const int numberWidth = isEnd ? 0 : numberInk.size().width + m.px(14);
  const int sideWidth = 31 * output.width / 100;
  const int left = margin + numberWidth + (isEnd ? 0 : m.px(8));
  const int pictureRows = std::min(m.px(84), mostHeight(output) - barsHeight - 2 * margin);
  const int sideX = output.width - sideWidth - margin;
  // Text has at least half of what is beside tools and torque.
  const int pictureColumns = std::max(1, (sideX - left - margin) / 2 - margin);
  std::optional<hal::Image> picture;
  hal::FrameSize pictureSize;
  const bool hasMovie = !isEnd && procedure.steps[shown.step].movie && pictureRows > 0;
  if (hasMovie) {
    pictureSize = sizeOfRows(procedure.steps[shown.step].movie->size, pictureRows, pictureColumns);
  } else if (!isEnd && pictureRows > 0) {
    picture =
        pictureOf(procedure.text(shown.step, shown.language), folder, pictureRows, pictureColumns);
    if (picture) pictureSize = picture->size();
  }
  const int pictureWidth = pictureSize.width == 0 ? 0 : pictureSize.width + margin;
  const Column text = mainColumn(shown, left, std::max(1, sideX - pictureWidth - left - margin), m);
  const Column side = sideColumn(shown, sideX, sideWidth, m);

  const int body = std::max(
      {text.height(m), side.height(m), numberInk.size().height + m.px(8), pictureSize.height});
  const int wholeHeight = barsHeight + body + 2 * margin;
  const int height = std::min(wholeHeight, mostHeight(output));
  Card card({output.width, height});
  card.fill({0, 0, output.width, height}, kGround, kGroundAlpha);
  int y = 0;
  for (const Bar& bar : bars) {
    const int rows = bar.ink.size().height + m.px(6);
    card.fill({0, y, output.width, rows}, bar.ground, 255);
    card.ink(bar.ink, margin, y + m.px(3), bar.colour);
    y += rows;
  }
  const int top = y + margin;
  if (!isEnd) {
    card.fill({margin, top, numberWidth, numberInk.size().height + m.px(6)}, overlay::kReservedRgb,
              255);
    card.ink(numberInk, margin + m.px(7), top + m.px(3), kWhite);
  }
  drawColumn(card, text, top, m);
  const CardArea place{sideX - pictureWidth, top, pictureSize.width, pictureSize.height};
  if (picture) card.paste(*picture, place.x, place.y);
  if (hasMovie) card.fill(place, kBlack, 255);
  drawColumn(card, side, top, m);
  Panel panel{.panel = {.image = card.take(), .movie = {}}, .wholeHeight = wholeHeight};
  if (hasMovie) {
    panel.panel.movie = overlay::MoviePlace{.topLeft = {place.x, place.y}, .size = pictureSize};
  }
  return panel;
}

}  // namespace

InstructionPanel instructionPanel(const StepShown& shown, const std::filesystem::path& folder,
                                  hal::FrameSize output) {
  Panel panel;
  for (const double share : {1.0, 0.9, 0.8, 0.7}) {  // a long text in smaller letters
    panel = panelOf(shown, folder, output, Measures(output.width, share));
    if (panel.wholeHeight <= mostHeight(output)) break;
  }
  return std::move(panel.panel);
}

hal::Image stepMarker(const std::string& number, const std::string& text, int outputWidth) {
  const Measures m(outputWidth);
  const hal::Image digits = inkOfText(number, m.px(19), outputWidth, "Sans Bold");
  const int pad = m.px(6);
  const int numberWidth = std::max(digits.size().width + 2 * pad, digits.size().height + pad);
  const int height = digits.size().height + pad;
  const hal::Image words =
      text.empty() ? hal::Image() : inkOfText(text, m.px(15), outputWidth / 2, "Sans Bold");
  const int wordsWidth = text.empty() ? 0 : words.size().width + 2 * pad;
  Card card({numberWidth + wordsWidth, height});
  card.fill({0, 0, card.size().width, height}, kGround, 240);
  card.fill({0, 0, numberWidth, height}, overlay::kReservedRgb, 255);
  card.ink(digits, (numberWidth - digits.size().width) / 2, pad / 2, kWhite);
  if (!text.empty()) {
    card.ink(words, numberWidth + pad, (height - words.size().height) / 2, kWhite);
  }
  card.border({0, 0, card.size().width, height}, m.px(1), overlay::kCasingRgb);
  return card.take();
}

hal::Image doubtBadge(const std::string& text, int outputWidth) {
  const Measures m(outputWidth);
  const int pad = m.px(8);
  const hal::Image ink = inkOfText(text, m.px(16), outputWidth / 2, "Sans Bold");
  Card card({ink.size().width + 2 * pad, ink.size().height + 2 * pad});
  const CardArea all{0, 0, card.size().width, card.size().height};
  card.fill(all, kGround, 235);
  card.border(all, m.px(2), kAmber);
  card.ink(ink, pad, pad, kAmber);
  return card.take();
}

}  // namespace pleinair::app
