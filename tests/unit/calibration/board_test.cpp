#include "pipeline/calibration/board.h"

#include <algorithm>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pleinair::calibration {
namespace {

TEST(Board, CheckerboardIsAGridAboutItsCentre) {
  const Board board(Checkerboard{.columns = 4, .rows = 3, .squareMetres = 0.02});
  ASSERT_EQ(board.corners().size(), 12u);
  EXPECT_NEAR(glm::distance(board.corners()[0], glm::dvec3(-0.03, -0.02, 0.0)), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(board.corners()[1], glm::dvec3(-0.01, -0.02, 0.0)), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(board.corners()[11], glm::dvec3(0.03, 0.02, 0.0)), 0.0, 1e-12);
  EXPECT_EQ(board.edges().size(), 3u * 3u + 4u * 2u);
  EXPECT_EQ(board.minCorners(), 12);
  for (const BoardEdge& edge : board.edges()) {
    const glm::dvec3 along = board.corners()[static_cast<std::size_t>(edge.to)] -
                             board.corners()[static_cast<std::size_t>(edge.from)];
    EXPECT_NEAR(glm::length(along), 0.02, 1e-12);
    EXPECT_EQ(edge.isAlongX, along.y == 0.0);
  }
}

TEST(Board, AprilGridCountsFromTheLowerLeftUpwards) {
  const Board board(AprilGrid{.columns = 3, .rows = 2, .tagEdgeMetres = 0.1, .spacing = 0.3});
  ASSERT_EQ(board.corners().size(), 24u);
  const auto centre = [&](std::size_t tag) {
    return (board.corners()[tag * 4] + board.corners()[tag * 4 + 2]) / 2.0;
  };
  // y points down.
  EXPECT_NEAR(glm::distance(centre(0), glm::dvec3(-0.13, 0.065, 0.0)), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(centre(2), glm::dvec3(0.13, 0.065, 0.0)), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(centre(3), glm::dvec3(-0.13, -0.065, 0.0)), 0.0, 1e-12);
  // A tag's first corner is its lower left one.
  EXPECT_NEAR(glm::distance(board.corners()[0], glm::dvec3(-0.18, 0.115, 0.0)), 0.0, 1e-12);
  EXPECT_EQ(board.edges().size(), 24u);
}

TEST(Board, SaysWhatItIs) {
  EXPECT_EQ(Board(Checkerboard{9, 6, 0.025}).text(),
            "checkerboard of 9x6 inner corners, squares of 25 mm");
  EXPECT_EQ(Board(AprilGrid{6, 5, 0.0308, 0.3, 7}).text(),
            "AprilGrid of 6x5 tags from id 7, edges of 30.8 mm, spacing 0.3");
}

}  // namespace
}  // namespace pleinair::calibration
