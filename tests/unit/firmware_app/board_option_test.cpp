#include "firmware_app/cli/board_option.h"

#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/error.h"

namespace pleinair::app {
namespace {

using testing::HasSubstr;

std::string refusalOf(const BoardOption& option) {
  try {
    boardOf(option);
  } catch (const hal::Failure& error) {
    EXPECT_EQ(error.error().kind, hal::ErrorKind::kInvalidArgument);
    return error.what();
  }
  return "taken";
}

TEST(BoardOption, MakesBoards) {
  const auto checkerboard = boardOf({.kind = "checkerboard:9x6", .square = 0.03});
  const auto& squares = std::get<calibration::Checkerboard>(checkerboard.kind());
  EXPECT_EQ(squares.columns, 9);
  EXPECT_EQ(squares.rows, 6);
  EXPECT_EQ(squares.squareMetres, 0.03);
  const auto aprilGrid = boardOf({.kind = "aprilgrid:5x7", .tagEdge = 0.04, .firstId = 12});
  const auto& tags = std::get<calibration::AprilGrid>(aprilGrid.kind());
  EXPECT_EQ(tags.columns, 5);
  EXPECT_EQ(tags.rows, 7);
  EXPECT_EQ(tags.spacing, 0.3);
  EXPECT_EQ(tags.firstId, 12);
}

TEST(BoardOption, RefusesOthers) {
  for (const char* kind :
       {"", "checkerboard", "checkerboard:9", "checkerboard:9x", "checkerboard:2x6",
        "checkerboard:9x6x3", "checkerboard:-9x6", "charuco:9x6", "aprilgrid:1x6"}) {
    EXPECT_THAT(refusalOf({.kind = kind, .square = 0.03, .tagEdge = 0.03}),
                HasSubstr("--board: found \"" + std::string(kind) + "\"; allowed: checkerboard:"));
  }
  EXPECT_THAT(refusalOf({.kind = "checkerboard:9x6"}), HasSubstr("--square: is missing"));
  EXPECT_THAT(refusalOf({.kind = "checkerboard:9x6", .square = -1.0}), HasSubstr("found -1"));
  EXPECT_THAT(refusalOf({.kind = "checkerboard:9x6", .square = 0.1, .spacing = 0.3}),
              HasSubstr("--spacing: is of no checkerboard"));
  EXPECT_THAT(refusalOf({.kind = "aprilgrid:6x6"}), HasSubstr("--tag-edge: is missing"));
  EXPECT_THAT(refusalOf({.kind = "aprilgrid:6x6", .square = 0.1}),
              HasSubstr("--square: is of no aprilgrid"));
  EXPECT_THAT(refusalOf({.kind = "aprilgrid:6x6", .tagEdge = 0.1, .spacing = 0.0}),
              HasSubstr("--spacing: found 0"));
  EXPECT_THAT(refusalOf({.kind = "aprilgrid:6x6", .tagEdge = 0.1, .firstId = 552}),
              HasSubstr("allowed: 0 to 551"));
}

}  // namespace
}  // namespace pleinair::app
