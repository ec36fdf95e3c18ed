#pragma once

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <vector>

#include "hal/outputs/registry.h"
#include "tests/support/board_scene.h"
#include "tests/support/tag_scene.h"

namespace pleinair::support {

struct BoardMovieOptions {
  BoardPictureOptions picture{.blurSigmaPx = 0.6, .noiseSigma = 2.0};
  int stillFrames = 3;   ///< at each hold
  int movingFrames = 3;  ///< between two holds
  double movingBlurPx = 2.5;
};

/// Writes a movie of a board that is held in each of these poses and carried from each to the next.
inline void writeBoardMovie(const std::filesystem::path& path, const calibration::Board& board,
                            const tracking::CameraModel& camera,
                            const std::vector<BoardHold>& holds,
                            const BoardMovieOptions& options = {}) {
  constexpr hal::Duration kPeriod = std::chrono::nanoseconds(std::chrono::seconds(1)) / 30;
  const BoardRenderer renderer(board, camera);
  const auto output = hal::orThrow(hal::openFileOutput(path));
  const hal::OutputFormat format =
      hal::orThrow(output->start({.size = camera.imageSize(), .framePeriod = kPeriod}));
  const auto neutral = [](const hal::Image& grey, hal::FrameFormat wanted) {
    hal::Image image(wanted);
    const hal::Image plain = neutralPicture(grey, wanted.pixelFormat);
    for (int plane = 0; plane < hal::planeCount(wanted.pixelFormat); ++plane) {
      std::ranges::copy(plain.view().planes.at(static_cast<std::size_t>(plane)).bytes,
                        image.plane(plane).begin());
    }
    return image;
  };
  int frame = 0;
  const auto write = [&](const BoardHold& hold, double moreBlur) {
    BoardPictureOptions picture = options.picture;
    picture.blurSigmaPx += moreBlur;
    picture.noiseSeed = static_cast<std::uint32_t>(frame + 1);
    const hal::Image grey = renderer.render(cameraFromBoard(board, camera, hold), picture);
    hal::orThrow(output->write(neutral(grey, format.frame).view(), kPeriod * frame));
  };
  for (std::size_t i = 0; i < holds.size(); ++i) {
    for (int still = 0; still < options.stillFrames; ++still) write(holds[i], 0.0);
    if (i + 1 == holds.size()) break;
    for (int step = 1; step <= options.movingFrames; ++step) {
      const double share = step / (options.movingFrames + 1.0);
      const BoardHold& a = holds[i];
      const BoardHold& b = holds[i + 1];
      write({.at = glm::mix(a.at, b.at, share),
             .span = glm::mix(a.span, b.span, share),
             .yaw = glm::mix(a.yaw, b.yaw, share),
             .pitch = glm::mix(a.pitch, b.pitch, share),
             .roll = glm::mix(a.roll, b.roll, share)},
            options.movingBlurPx);
    }
  }
  hal::orThrow(output->finish());
}

}  // namespace pleinair::support
