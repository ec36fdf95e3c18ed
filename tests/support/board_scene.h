#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <glm/mat4x4.hpp>

#include "hal/image.h"
#include "pipeline/calibration/board.h"
#include "pipeline/calibration/board_detector.h"
#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::support {

struct BoardPictureOptions {
  int samplesPerSide = 4;  ///< of a pixel: its square is integrated over samplesPerSide² points
  double black = 30.0;
  double white = 215.0;
  double background = 110.0;
  double blurSigmaPx = 0.0;
  double noiseSigma = 0.0;  ///< grey levels
  std::uint32_t noiseSeed = 1;
  /// A print whose length across is that of the board times this.
  double stretchX = 1.0;
};

/// Draws grey pictures of one board through one lens: paper a square (or a gap and a bit) wider
/// than the board, on an even background. The camera's rays are found once. One thread at a time.
class BoardRenderer {
 public:
  BoardRenderer(const calibration::Board& board, const tracking::CameraModel& camera);
  ~BoardRenderer();
  BoardRenderer(const BoardRenderer&) = delete;
  BoardRenderer& operator=(const BoardRenderer&) = delete;

  hal::Image render(const glm::dmat4& cameraFromBoard,
                    const BoardPictureOptions& options = {}) const;

 private:
  class Print;
  tracking::CameraModel camera_;
  std::unique_ptr<const Print> print_;
  std::vector<glm::dvec2> rays_;  ///< of pixel corners, on z = 1; far away where there is none
};

/// How a board is held: its centre is seen at `at` (0…1 of the picture), it spans `span` of the
/// picture's width when it faces the camera, and is turned about the vertical (positive: its left
/// side nearer), the horizontal (positive: its upper side nearer) and the optical axis; radians.
struct BoardHold {
  glm::dvec2 at{0.5};
  double span = 0.5;
  double yaw = 0.0;
  double pitch = 0.0;
  double roll = 0.0;
};
glm::dmat4 cameraFromBoard(const calibration::Board& board, const tracking::CameraModel& camera,
                           const BoardHold& hold);

/// What somebody who calibrates well does: the board in the middle, tilted each way, near and far,
/// and in every corner. All of it in the picture.
std::vector<BoardHold> goodTour(const calibration::Board& board,
                                const tracking::CameraModel& camera);

/// The board as a detector without fault but noise would see it: its corners that are in the
/// picture.
calibration::BoardSighting idealSighting(const calibration::Board& board,
                                         const tracking::CameraModel& camera,
                                         const glm::dmat4& cameraFromBoard, double noisePx = 0.0,
                                         std::uint32_t seed = 1);

/// How far apart two cameras see the same rays: the largest distance over the first one's picture,
/// border to border, once the second is turned such that they agree best (a turn goes into poses).
double rayErrorPx(const tracking::CameraModel& truth, const tracking::CameraModel& estimate);

}  // namespace pleinair::support
