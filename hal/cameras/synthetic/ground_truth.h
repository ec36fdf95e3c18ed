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
  std::array<glm::dvec2, 4> cornersPx{};  ///< in AprilTag's order; may lie outside the image
  bool isInside = false;   ///< whether the tag and its white border are completely in the image
  bool isVisible = false;  ///< inside, facing the camera, and not occluded
};

/// The true state of a frame. With a rolling shutter, the pose is that of the middle row
/// (SyntheticCamera::cameraFromWorld() gives each row's), and the corners are where they appear.
struct GroundTruth {
  PinholeIntrinsics intrinsics;
  glm::dmat4 cameraFromWorld{1};  ///< OpenCV's camera frame; world: z up from the bench, metres
  std::vector<TagTruth> tags;
};

/// The motion of a surface point from one frame to another.
struct FlowVector {
  glm::dvec2 px{0};      ///< position in the second frame − position in the first
  bool visible = false;  ///< in the second frame: inside the image and not occluded
};

/// The flow at every pixel centre of the first frame, or of every n-th pixel of every n-th row, row
/// by row.
struct FlowField {
  FrameSize size;  ///< of the field
  std::vector<glm::vec2> px;
  std::vector<std::uint8_t> visible;  ///< 1 or 0
};

/// Where a frame shows things that move by themselves (the arm, a figure), at every pixel centre,
/// or at that of every n-th pixel of every n-th row, row by row. A thing that rests stays in the
/// mask: in no shot does one rest for 4 s, after which a painter may take it for background.
struct MovingMask {
  FrameSize size;                   ///< of the mask
  std::vector<std::uint8_t> bytes;  ///< 255 where the nearest surface is of such a thing, else 0
};

namespace synthetic {

GroundTruth truthOf(const Exposure& exposure, const Geometry& geometry);

/// The flow at `pixel` of the first frame; zero and not visible if no surface is seen there.
FlowVector flowBetween(const Exposure& first, const Exposure& second, const Geometry& geometry,
                       glm::dvec2 pixel);
FlowField flowFieldBetween(const Exposure& first, const Exposure& second, const Geometry& geometry,
                           int everyNth);
MovingMask movingMaskOf(const Exposure& exposure, const Geometry& geometry, int everyNth);

}  // namespace synthetic
}  // namespace pleinair::hal
