#pragma once

#include <vector>

#include "pipeline/calibration/lens_fit.h"
#include "tests/support/board_scene.h"

namespace pleinair::calibration {

/// The views of a tour through a lens without error but noise.
inline std::vector<FitView> idealViews(const Board& board, const tracking::CameraModel& camera,
                                       const std::vector<support::BoardHold>& tour, double noisePx,
                                       std::uint32_t seed = 1) {
  std::vector<FitView> views;
  for (const support::BoardHold& hold : tour) {
    const auto sighting = support::idealSighting(
        board, camera, support::cameraFromBoard(board, camera, hold), noisePx, seed++);
    FitView view;
    for (const SightedCorner& corner : sighting.corners) {
      view.push_back({board.corners()[static_cast<std::size_t>(corner.id)], corner.px});
    }
    views.push_back(std::move(view));
  }
  return views;
}

/// The board facing the camera, at many positions.
inline std::vector<support::BoardHold> frontalTour() {
  std::vector<support::BoardHold> tour;
  for (const double y : {0.25, 0.5, 0.75}) {
    for (const double x : {0.25, 0.4, 0.6, 0.75}) tour.push_back({.at = {x, y}, .span = 0.4});
  }
  return tour;
}

}  // namespace pleinair::calibration
