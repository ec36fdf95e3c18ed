#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "hal/cameras/synthetic/render/shot.h"
#include "hal/clock.h"
#include "hal/image.h"
#include "pipeline/tracking/camera/camera_model.h"
#include "pipeline/tracking/pose/tag.h"

namespace pleinair::tracking {

/// An image with its ground truth.
struct TruthFrame {
  hal::Image luma;
  hal::TimePoint time;
  glm::dmat4 cameraFromWorld{1.0};
  std::map<int, TagCornersPx> corners;  ///< tagCorners()' order; may lie outside the picture
  std::set<int> visible;                ///< completely in the image and not occluded
};

/// Images with known poses, held in memory.
struct TruthSequence {
  std::string name;
  CameraModel camera;
  std::vector<TagMarker> markers;  ///< with their places in the world
  std::vector<TruthFrame> frames;

  const TagMarker& marker(int id) const;
};

/// desk_6dof: a camera in free motion over a desk, with motion blur. Precondition:
/// hasDeskSequence().
TruthSequence readDesk();

/// virtual_camera: a photograph under hand shake, rotation and zoom. A Tracker has one calibration,
/// so each image is resampled to the first one's focal length; the world is the photograph's
/// camera. The file's tag poses were themselves measured in the photograph. Precondition:
/// hasVirtualCamera().
TruthSequence readVirtualCamera();
bool hasVirtualCamera();

struct WorkbenchTake {
  hal::SyntheticShot shot = hal::SyntheticShot::kWalkaround;
  std::size_t frameCount = 90;
  hal::FrameSize size{640, 480};
  double noiseSigma = 2.0;
};

TruthSequence filmWorkbench(const WorkbenchTake& take);

}  // namespace pleinair::tracking
