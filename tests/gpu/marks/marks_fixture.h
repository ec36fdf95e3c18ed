#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "pipeline/marks/anchors/anchor_set.h"
#include "pipeline/marks/marks_shaders.h"
#include "pipeline/marks/motion_field.h"
#include "tests/gpu/scene/scene_gl_test.h"

namespace pleinair::marks {

/// Where a homography takes a point.
inline glm::dvec2 moved(const glm::dmat3& h, glm::dvec2 px) {
  const glm::dvec3 p = h * glm::dvec3(px, 1.0);
  return {p.x / p.z, p.y / p.z};
}

/// Pictures of a scene whose motion the test makes up, and the anchors that live in it.
class MarksTest : public scene::SceneGlTest {
 protected:
  static constexpr hal::FrameSize kSize{320, 240};
  static constexpr hal::Duration kStep = std::chrono::milliseconds(33);

  void SetUp() override {
    SceneGlTest::SetUp();
    if (IsSkipped()) return;
    library_.add(gpu::marksShaders());
    picture_ = plainPicture(kSize);
  }

  static tracking::CameraModel camera(hal::FrameSize size = kSize) {
    return {{.fx = 300.0, .fy = 302.0, .cx = 162.0, .cy = 118.0}, {}, size};
  }

  /// The next frame, whose picture moved so.
  scene::ArFrame compose(scene::ArFrameRenderer& renderer, const scene::PoseSet& poses,
                         tracking::ImageMotion motion) {
    motion.frameSize = picture_.size();
    motion.sinceSequence = sequence_;
    motion_ = motion;
    ++sequence_;
    time_ += kStep;
    scene::ArFrame frame = renderer.compose(picture_, camera(picture_.size()), poses, sequence_,
                                            time_, {.surfaces = true, .measuredMotion = true});
    frame.measuredMotion = scene::MeasuredMotion{.motion = &motion_};
    return frame;
  }

  static std::vector<Anchor> alive(const AnchorSet& set) {
    std::vector<Anchor> all = set.read();
    std::erase_if(all, [](const Anchor& each) { return !each.isAlive(); });
    return all;
  }

  gpu::Texture picture_;
  tracking::ImageMotion motion_;
  std::uint64_t sequence_ = 0;
  hal::TimePoint time_;
};

}  // namespace pleinair::marks
