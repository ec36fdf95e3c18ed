#include "firmware_app/sheets/tag_sheets.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "hal/error.h"
#include "hal/overloaded.h"
#include "pipeline/tracking/pose/tag_family.h"

namespace pleinair::app {
namespace {

constexpr double kMmPerMetre = 1000.0;
constexpr double kGapMm = 7.0;
constexpr double kLabelMm = 6.0;

/// What the rulers leave of a page.
PaperRect roomOn(const PaperSize& paper) {
  constexpr double kLeft = 20.0;
  constexpr double kTop = 10.0;
  constexpr double kRight = 10.0;
  constexpr double kBottom = 20.0;
  return {kLeft, kTop, paper.widthMm - kLeft - kRight, paper.heightMm - kTop - kBottom};
}

hal::Failure tooLarge(const std::string& what, double widthMm, double heightMm,
                      const PaperSize& paper, const std::string& smaller = "make it smaller") {
  const PaperRect room = roomOn(paper);
  return hal::Failure(
      hal::Error{.kind = hal::ErrorKind::kInvalidArgument,
                 .subject = what,
                 .problem = fmt::format("needs {:.0f} x {:.0f} mm with its white border, and the "
                                        "paper has room for {:.0f} x {:.0f} mm",
                                        widthMm, heightMm, room.width, room.height),
                 .remedy = smaller + ", or a larger --paper, such as a3"});
}

/// The black cells of a tag whose first one, at the upper left, begins at (x, y).
void addCells(const tracking::TagBitmap& bitmap, double x, double y, double cellMm, int first,
              int end, std::vector<PaperRect>& cells) {
  for (int row = first; row < end; ++row) {
    for (int column = first; column < end; ++column) {
      int run = column;
      while (run < end && !bitmap.whiteAt(row, run)) ++run;
      if (run == column) continue;
      cells.push_back({x + (column - first) * cellMm, y + (row - first) * cellMm,
                       (run - column) * cellMm, cellMm});
      column = run;
    }
  }
}

/// Four pairs of short lines outside of a square's corners.
void addCutMarks(PrintedPages& pages, double x, double y, double side) {
  constexpr double kLengthMm = 2.5;
  constexpr double kAwayMm = 0.5;
  for (const double right : {0.0, 1.0}) {
    for (const double low : {0.0, 1.0}) {
      const double atX = x + right * side;
      const double atY = y + low * side;
      const double outX = right > 0 ? 1 : -1;
      const double outY = low > 0 ? 1 : -1;
      pages.line(atX + outX * kAwayMm, atY, atX + outX * (kAwayMm + kLengthMm), atY);
      pages.line(atX, atY + outY * kAwayMm, atX, atY + outY * (kAwayMm + kLengthMm));
    }
  }
}

/// Lays tags out row by row.
class TagLayout {
 public:
  explicit TagLayout(PaperSize paper) : pages_(paper), room_(roomOn(paper)) {}

  void add(const PrintedTag& tag) {
    const tracking::TagBitmap bitmap = tracking::tagBitmap(tag.family, tag.id);
    const double edge = tag.edgeMetres * kMmPerMetre;
    const double cell = edge / bitmap.edgeCells;
    const double side = cell * bitmap.cells;
    const std::string name = fmt::format("{} · id {} · edge {:g} mm", tag.family, tag.id, edge);
    if (side > room_.width || side + kLabelMm > room_.height) {
      throw tooLarge(name, side, side + kLabelMm, pages_.paper());
    }
    makeRoom(side);
    std::vector<PaperRect> cells;
    addCells(bitmap, x_, y_, cell, 0, bitmap.cells, cells);
    pages_.fill(cells);
    addCutMarks(pages_, x_, y_, side);
    pages_.text(x_ + 1.0, y_ + side + 4.0, std::min(3.2, side / 14.0), name);
    x_ += side + kGapMm;
    rowMm_ = std::max(rowMm_, side + kLabelMm + kGapMm);
    isEmpty_ = false;
  }

  std::vector<std::uint8_t> finish() {
    endPage();
    return pages_.finish();
  }

 private:
  void makeRoom(double side) {
    constexpr double kRounding = 1e-6;
    if (x_ + side > room_.x + room_.width + kRounding) {
      x_ = room_.x;
      y_ += rowMm_;
      rowMm_ = 0;
    }
    if (y_ + side + kLabelMm > room_.y + room_.height + kRounding) endPage();
  }

  void endPage() {
    if (isEmpty_) return;
    pages_.rulers();
    pages_.endPage();
    x_ = room_.x;
    y_ = room_.y;
    rowMm_ = 0;
    isEmpty_ = true;
  }

  PrintedPages pages_;
  PaperRect room_;
  double x_ = room_.x;
  double y_ = room_.y;
  double rowMm_ = 0;
  bool isEmpty_ = true;
};

/// A board from its upper left corner, its white border included.
struct BoardDrawing {
  double widthMm = 0;
  double heightMm = 0;
  std::vector<PaperRect> cells;
};

/// The white around a board, which detectors need.
constexpr double kBoardBorderMm = 5.0;

BoardDrawing drawn(const calibration::Checkerboard& board) {
  const double square = board.squareMetres * kMmPerMetre;
  BoardDrawing drawing{.widthMm = (board.columns + 1) * square + 2 * kBoardBorderMm,
                       .heightMm = (board.rows + 1) * square + 2 * kBoardBorderMm};
  for (int row = 0; row <= board.rows; ++row) {
    for (int column = row % 2; column <= board.columns; column += 2) {
      drawing.cells.push_back(
          {kBoardBorderMm + column * square, kBoardBorderMm + row * square, square, square});
    }
  }
  return drawing;
}

BoardDrawing drawn(const calibration::AprilGrid& grid) {
  const double edge = grid.tagEdgeMetres * kMmPerMetre;
  const double gap = edge * grid.spacing;
  const double pitch = edge + gap;
  const auto side = [&](int tags) { return tags * pitch + gap + 2 * kBoardBorderMm; };
  BoardDrawing drawing{.widthMm = side(grid.columns), .heightMm = side(grid.rows)};
  for (int row = 0; row <= grid.rows; ++row) {
    for (int column = 0; column <= grid.columns; ++column) {
      const double x = kBoardBorderMm + column * pitch;
      const double y = kBoardBorderMm + row * pitch;
      drawing.cells.push_back({x, y, gap, gap});
      if (row == grid.rows || column == grid.columns) continue;
      // Ids count from the lower left.
      const int id = grid.firstId + (grid.rows - 1 - row) * grid.columns + column;
      const tracking::TagBitmap bitmap = tracking::tagBitmap("tag36h11", id);
      const int border = (bitmap.cells - bitmap.edgeCells) / 2;
      addCells(bitmap, x + gap, y + gap, edge / bitmap.edgeCells, border, border + bitmap.edgeCells,
               drawing.cells);
    }
  }
  return drawing;
}

/// "give --square 0.023 or less": the largest whole millimetre that fits, either way round.
std::string fittingBoardText(const calibration::Board& board, const BoardDrawing& drawing,
                             const PaperSize& paper) {
  constexpr double kRounding = 1e-9;
  double scale = 0;
  for (const PaperSize& turned : {paper, PaperSize{paper.heightMm, paper.widthMm}}) {
    const PaperRect room = roomOn(turned);
    const double across =
        (room.width - 2 * kBoardBorderMm) / (drawing.widthMm - 2 * kBoardBorderMm);
    const double down =
        (room.height - kLabelMm - 2 * kBoardBorderMm) / (drawing.heightMm - 2 * kBoardBorderMm);
    scale = std::max(scale, std::min(across, down));
  }
  const auto* grid = std::get_if<calibration::AprilGrid>(&board.kind());
  const double side = grid != nullptr
                          ? grid->tagEdgeMetres
                          : std::get<calibration::Checkerboard>(board.kind()).squareMetres;
  const double millimetres = std::floor(side * scale * kMmPerMetre + kRounding);
  if (millimetres < 1) return "make it smaller";
  return fmt::format("give {} {:g} or less", grid != nullptr ? "--tag-edge" : "--square",
                     millimetres / kMmPerMetre);
}

}  // namespace

std::optional<PaperSize> paperOf(const std::string& text) {
  static constexpr std::array<std::pair<std::string_view, PaperSize>, 5> kPapers{
      {{"a4", {210, 297}},
       {"a3", {297, 420}},
       {"a2", {420, 594}},
       {"letter", {215.9, 279.4}},
       {"tabloid", {279.4, 431.8}}}};
  for (const auto& [name, size] : kPapers) {
    if (text == name) return size;
  }
  const std::size_t by = text.find('x');
  if (by == std::string::npos) return std::nullopt;
  PaperSize paper;
  const auto read = [](std::string_view digits, double& side) {
    const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), side);
    constexpr double kLeast = 130;  // the rulers
    constexpr double kMost = 5000;
    return status == std::errc() && end == digits.data() + digits.size() && side >= kLeast &&
           side <= kMost;
  };
  const std::string_view whole = text;
  if (!read(whole.substr(0, by), paper.widthMm) || !read(whole.substr(by + 1), paper.heightMm)) {
    return std::nullopt;
  }
  return paper;
}

std::vector<std::uint8_t> tagSheets(const std::vector<PrintedTag>& tags, PaperSize paper) {
  TagLayout layout(paper);
  for (const PrintedTag& tag : tags) layout.add(tag);
  return layout.finish();
}

std::vector<std::uint8_t> boardSheet(const calibration::Board& board, PaperSize paper) {
  const BoardDrawing drawing =
      std::visit([](const auto& kind) { return drawn(kind); }, board.kind());
  const auto fits = [&](const PaperSize& size) {
    const PaperRect room = roomOn(size);
    return drawing.widthMm <= room.width && drawing.heightMm + kLabelMm <= room.height;
  };
  if (!fits(paper)) {
    const PaperSize turned{paper.heightMm, paper.widthMm};
    if (!fits(turned)) {
      throw tooLarge(board.text(), drawing.widthMm, drawing.heightMm + kLabelMm, paper,
                     fittingBoardText(board, drawing, paper));
    }
    paper = turned;
  }
  const PaperRect room = roomOn(paper);
  PrintedPages pages(paper);
  std::vector<PaperRect> cells = drawing.cells;
  for (PaperRect& each : cells) {
    each.x += room.x;
    each.y += room.y;
  }
  pages.fill(cells);
  pages.text(room.x + kBoardBorderMm, room.y + drawing.heightMm + 3.0, 3.2, board.text());
  pages.rulers();
  pages.endPage();
  return pages.finish();
}

}  // namespace pleinair::app
