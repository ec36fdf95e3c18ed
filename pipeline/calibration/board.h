#pragma once

#include <string>
#include <variant>
#include <vector>

#include <glm/vec3.hpp>

namespace pleinair::calibration {

/// A checkerboard, described by its inner corners, where four squares meet (as OpenCV counts).
struct Checkerboard {
  int columns = 9;
  int rows = 6;
  double squareMetres = 0.025;
};

/// Kalibr's AprilGrid: tags of tag36h11 whose ids count from the lower left one to the right, row
/// by row upwards; between them is a gap of `spacing` tag edges, with a black square at each tag's
/// corners. A grid that counts downwards is the same grid seen from behind and also works.
struct AprilGrid {
  int columns = 6;
  int rows = 6;
  double tagEdgeMetres = 0.03;
  double spacing = 0.3;
  int firstId = 0;
};

/// Two corners of a board with a straight black-and-white edge between them.
struct BoardEdge {
  int from = 0;
  int to = 0;
  bool isAlongX = false;
  /// Distance on either side of the edge that stays black or white, in lengths of the edge.
  double clearance = 0.0;
};

/// A flat target whose corners detectors find. The board frame is the tag frame (tag.h): origin at
/// the centre, x right, y down, z into the board; metres.
class Board {
 public:
  using Kind = std::variant<Checkerboard, AprilGrid>;

  /// Preconditions: at least 3 corners or 1 tag per side, positive lengths and spacing.
  explicit Board(Kind kind);

  const Kind& kind() const { return kind_; }
  /// By id: those of a checkerboard row by row from the upper left; four per tag, in the order of
  /// tracking::tagCorners().
  const std::vector<glm::dvec3>& corners() const { return corners_; }
  const std::vector<BoardEdge>& edges() const { return edges_; }
  /// Least number of corners that count as a sighting.
  int minCorners() const;
  /// "checkerboard of 9x6 inner corners, squares of 25 mm".
  std::string text() const;

 private:
  void lay(const Checkerboard& board);
  void lay(const AprilGrid& grid);

  Kind kind_;
  std::vector<glm::dvec3> corners_;
  std::vector<BoardEdge> edges_;
};

}  // namespace pleinair::calibration
