#pragma once

#include <string>
#include <variant>
#include <vector>

#include <glm/vec3.hpp>

namespace pleinair::calibration {

/// A checkerboard by its inner corners, where four squares meet: OpenCV's count.
struct Checkerboard {
  int columns = 9;
  int rows = 6;
  double squareMetres = 0.025;
};

/// Kalibr's AprilGrid: tags of tag36h11 with ids that count from the lower left one to the right,
/// row by row upwards; between them a gap of `spacing` tag edges, with a black square at each tag's
/// corners. A grid that counts downwards is the same one seen from behind, and fits as well.
struct AprilGrid {
  int columns = 6;
  int rows = 6;
  double tagEdgeMetres = 0.03;
  double spacing = 0.3;
  int firstId = 0;
};

/// Two corners of a board between which black meets white along a straight line.
struct BoardEdge {
  int from = 0;
  int to = 0;
  bool isAlongX = false;
  /// How far on either side of it the board stays black and white, in lengths of the edge.
  double clearance = 0.0;
};

/// A flat target with corners that detectors find. The board frame is the tag frame's
/// (tag_frame.h): origin at the centre, x right, y down, z into the board; metres.
class Board {
 public:
  using Kind = std::variant<Checkerboard, AprilGrid>;

  /// Preconditions: 3 corners or 1 tag a side at least, positive lengths and spacing.
  explicit Board(Kind kind);

  const Kind& kind() const { return kind_; }
  /// By id: a checkerboard's row by row from the upper left; four a tag, in the order of
  /// tracking::tagCorners().
  const std::vector<glm::dvec3>& corners() const { return corners_; }
  const std::vector<BoardEdge>& edges() const { return edges_; }
  /// Fewer corners than this are no sighting.
  int fewestCorners() const;
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
