#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "hal/cameras/synthetic/camera_view.h"
#include "hal/cameras/synthetic/desk_tags.h"
#include "hal/pixel_format.h"

namespace pleinair::hal {

struct TagTruth {
  DeskTag tag;
  std::array<glm::dvec2, 4> cornersPx{};  ///< in AprilTag's order; may lie outside the picture
  bool isInside = false;                  ///< whether the white border, too, is all in the picture
};

/// What was true when a frame was taken.
struct GroundTruth {
  PinholeIntrinsics intrinsics;
  glm::dmat4 cameraFromWorld{1};  ///< OpenCV's camera frame; world: z up from the desk, metres
  std::vector<TagTruth> tags;
};

/// How a surface point moves from one frame to another.
struct FlowVector {
  glm::dvec2 px{0};      ///< position in the second frame − position in the first
  bool visible = false;  ///< in the second frame: inside the picture and not behind the desk
};

/// The flow at every pixel centre of the first frame, row by row.
struct FlowField {
  FrameSize size;
  std::vector<glm::vec2> px;
  std::vector<std::uint8_t> visible;  ///< 1 or 0
};

namespace synthetic {

GroundTruth truthOf(const CameraView& view, FrameSize size);

/// The flow at `pixel` of the first view; zero and not visible where nothing is seen there.
FlowVector flowBetween(const CameraView& first, const CameraView& second, FrameSize size,
                       glm::dvec2 pixel);
FlowField flowFieldBetween(const CameraView& first, const CameraView& second, FrameSize size);

}  // namespace synthetic
}  // namespace pleinair::hal
