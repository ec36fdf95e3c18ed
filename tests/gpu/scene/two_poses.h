#pragma once

#include <chrono>

#include <glm/ext/matrix_transform.hpp>
#include <glm/mat4x4.hpp>

#include "hal/clock.h"
#include "hal/pixel_format.h"
#include "pipeline/scene/builtin/builtin_box.h"
#include "pipeline/tracking/camera/camera_model.h"
#include "tests/gpu/scene/moving_models.h"

namespace pleinair::scene {

// Two frames, a thirtieth of a second apart, and their scene.

inline constexpr hal::FrameSize kTwoPosesSize{240, 180};

inline const hal::TimePoint kPrevious{std::chrono::milliseconds(400)};
inline const hal::TimePoint kCurrent{std::chrono::milliseconds(433)};

inline glm::dmat4 previousAslant() {
  return glm::rotate(glm::translate(glm::dmat4(1.0), {0.012, -0.004, 0.42}), 0.72, {0.9, 0.3, 0.1});
}
/// The pose after a movement of the hand: about 5 px, and 0.6° of turn.
inline glm::dmat4 currentAslant() {
  return glm::rotate(glm::translate(glm::dmat4(1.0), {0.004, 0.001, 0.415}), 0.73,
                     {0.9, 0.31, 0.1});
}

inline Model staticBox() {
  return singlePartModel("box", boxMesh({0.16, 0.12, 0.08}));
}

inline constexpr tracking::Distortion kBarrel{.k1 = -0.25, .k2 = 0.05, .p1 = 0.003, .p2 = -0.002};

}  // namespace pleinair::scene
