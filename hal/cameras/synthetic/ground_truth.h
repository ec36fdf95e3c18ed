#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "hal/cameras/synthetic/render/exposure.h"
#include "hal/cameras/synthetic/world/bench_tags.h"
#include "hal/cameras/synthetic/world/geometry.h"
#include "hal/pixel_format.h"

namespace pleinair::hal {

struct TagTruth {
  BenchTag tag;
  std::array<glm::dvec2, 4> cornersPx{};  ///< in AprilTag's order; may lie outside the picture
  bool isInside = false;                  ///< whether the white border, too, is all in the picture
  bool isVisible = false;  ///< inside, seen from its front, and nothing before any part of it
};

/// What was true when a frame was taken. With a rolling shutter, the pose is the middle row's
/// (SyntheticCamera::cameraFromWorld() has each row's), while corners are where they appear.
struct GroundTruth {
  PinholeIntrinsics intrinsics;
  glm::dmat4 cameraFromWorld{1};  ///< OpenCV's camera frame; world: z up from the bench, metres
  std::vector<TagTruth> tags;
};

/// How a surface point moves from one frame to another.
struct FlowVector {
  glm::dvec2 px{0};      ///< position in the second frame − position in the first
  bool visible = false;  ///< in the second frame: inside the picture, not behind anything
};

/// The flow at every pixel centre of the first frame, or of every n-th pixel of every n-th row, row
/// by row.
struct FlowField {
  FrameSize size;  ///< of the field
  std::vector<glm::vec2> px;
  std::vector<std::uint8_t> visible;  ///< 1 or 0
};

namespace synthetic {

GroundTruth truthOf(const Exposure& exposure, const Geometry& geometry);

/// The flow at `pixel` of the first frame; zero and not visible where nothing is seen there.
FlowVector flowBetween(const Exposure& first, const Exposure& second, const Geometry& geometry,
                       glm::dvec2 pixel);
FlowField flowFieldBetween(const Exposure& first, const Exposure& second, const Geometry& geometry,
                           int everyNth);

}  // namespace synthetic
}  // namespace pleinair::hal
