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
  int samplesPerSide = 4;  ///< per pixel: its area is integrated over samplesPerSide² points
  double black = 30.0;
  double white = 215.0;
  double background = 110.0;
  double blurSigmaPx = 0.0;
  double noiseSigma = 0.0;  ///< grey levels
  std::uint32_t noiseSeed = 1;
  /// Ratio of the print's width to the board's nominal width.
  double stretchX = 1.0;
};

/// Renders grey images of one board through one lens: paper a square (or a gap and a margin) wider
/// than the board, on an even background. The camera's rays are computed once. One thread at a
/// time.
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
  std::vector<glm::dvec2> rays_;  ///< of pixel corners, on z = 1; far away if there is none
};

/// The pose of a held board: its centre appears at `at` (0…1 of the image), and it covers `span` of
/// the image's width when it faces the camera. It is turned about the vertical (positive: left side
/// nearer), the horizontal (positive: upper side nearer) and the optical axis; radians.
struct BoardHold {
  glm::dvec2 at{0.5};
  double span = 0.5;
  double yaw = 0.0;
  double pitch = 0.0;
  double roll = 0.0;
};
glm::dmat4 cameraFromBoard(const calibration::Board& board, const tracking::CameraModel& camera,
                           const BoardHold& hold);

/// The poses of a good calibration: the board in the middle, tilted each way, near and far, and in
/// every corner, always completely in the image.
std::vector<BoardHold> calibrationPoses(const calibration::Board& board,
                                        const tracking::CameraModel& camera);

/// The result of a perfect detector with noise: the board's corners that are in the image.
calibration::BoardSighting idealSighting(const calibration::Board& board,
                                         const tracking::CameraModel& camera,
                                         const glm::dmat4& cameraFromBoard, double noisePx = 0.0,
                                         std::uint32_t seed = 1);

/// The largest distance, over the image, at which two cameras see the same ray, after the rotation
/// of the second that gives the best agreement (poses absorb a rotation).
double rayErrorPx(const tracking::CameraModel& truth, const tracking::CameraModel& estimate);

}  // namespace pleinair::support
