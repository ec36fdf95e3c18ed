#pragma once

#include <map>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "pipeline/tracking/camera/camera_model.h"
#include "pipeline/tracking/pose/tag.h"
#include "pipeline/tracking/pose/tracker.h"

namespace pleinair::tracking {

/// Ground truth of the sequence desk_6dof: a camera over a desk with five tags.
struct DeskSequence {
  struct Frame {
    glm::dmat4 cameraFromWorld{1.0};
    std::map<int, TagCornersPx> corners;  ///< tagCorners()' order, pixel centres at +0.5
  };

  std::string moviePath;
  CameraModel camera;
  std::vector<TagMarker> markers;  ///< with their poses in the world
  std::vector<Frame> frames;
};

bool hasDeskSequence();
DeskSequence readDeskSequence();

}  // namespace pleinair::tracking
