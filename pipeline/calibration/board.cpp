#include "pipeline/calibration/board.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include <fmt/format.h>

#include "hal/overloaded.h"
#include "pipeline/tracking/pose/tag.h"

namespace pleinair::calibration {
namespace {

constexpr double kSquareClearance = 0.45;  // of a checkerboard's square
constexpr double kTagBorder = 1.0 / 8.0;   // of a tag36h11's edge

}  // namespace

Board::Board(Kind kind) : kind_(kind) {
  std::visit([this](const auto& board) { lay(board); }, kind_);
}

void Board::lay(const Checkerboard& board) {
  assert(board.columns >= 3 && board.rows >= 3 && board.squareMetres > 0.0);
  const glm::dvec3 centre((board.columns - 1) / 2.0, (board.rows - 1) / 2.0, 0.0);
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      const int id = row * board.columns + column;
      corners_.push_back((glm::dvec3(column, row, 0.0) - centre) * board.squareMetres);
      if (column + 1 < board.columns) edges_.push_back({id, id + 1, true, kSquareClearance});
      if (row + 1 < board.rows) {
        edges_.push_back({id, id + board.columns, false, kSquareClearance});
      }
    }
  }
}

void Board::lay(const AprilGrid& grid) {
  assert(grid.columns >= 1 && grid.rows >= 1 && grid.firstId >= 0);
  assert(grid.tagEdgeMetres > 0.0 && grid.spacing > 0.0);
  const double pitch = grid.tagEdgeMetres * (1.0 + grid.spacing);
  const double clearance = 0.8 * std::min(kTagBorder, grid.spacing);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const glm::dvec3 centre((column - (grid.columns - 1) / 2.0) * pitch,
                              ((grid.rows - 1) / 2.0 - row) * pitch, 0.0);
      const int first = static_cast<int>(corners_.size());
      for (const glm::dvec3& corner : tracking::tagCorners(grid.tagEdgeMetres)) {
        corners_.push_back(centre + corner);
      }
      for (int side = 0; side < 4; ++side) {
        edges_.push_back({first + side, first + (side + 1) % 4, side % 2 == 0, clearance});
      }
    }
  }
}

int Board::minCorners() const {
  constexpr int kTags = 6;  // of a grid that may be partly outside of the image
  return std::min(kTags * 4, static_cast<int>(corners_.size()));
}

std::string Board::text() const {
  return std::visit(
      hal::Overloaded{
          [](const Checkerboard& board) {
            return fmt::format("checkerboard of {}x{} inner corners, squares of {:g} mm",
                               board.columns, board.rows, board.squareMetres * 1e3);
          },
          [](const AprilGrid& grid) {
            return fmt::format("AprilGrid of {}x{} tags from id {}, edges of {:g} mm, spacing {:g}",
                               grid.columns, grid.rows, grid.firstId, grid.tagEdgeMetres * 1e3,
                               grid.spacing);
          }},
      kind_);
}

}  // namespace pleinair::calibration
