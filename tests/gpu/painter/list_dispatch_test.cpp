// Programs that run over lists do the same whichever way they are dispatched.
#include "pipeline/gpu/programs/list_dispatch.h"

#include <memory>
#include <variant>

#include <gtest/gtest.h>

#include "hal/cameras/synthetic/synthetic_camera.h"
#include "tests/gpu/painter/painter_fixture.h"

namespace pleinair {
namespace {

constexpr hal::FrameSize kListPicture{318, 238};
constexpr std::uint64_t kArmComes = 30;  // the frame
constexpr int kListFrames = 10;

/// A box on the bench's first tag, over which the arm reaches.
scene::Scene boxBeforeTheArm(const hal::GroundTruth& truth) {
  scene::Scene scene;
  scene.camera = {{.fx = truth.intrinsics.fx,
                   .fy = truth.intrinsics.fy,
                   .cx = truth.intrinsics.cx,
                   .cy = truth.intrinsics.cy},
                  {},
                  kListPicture};
  const hal::BenchTag& tag = truth.tags.at(0).tag;
  scene.tags.push_back({.id = tag.id, .edgeMetres = tag.edgeMetres});
  const scene::BoxSource box{glm::dvec3(0.05)};
  scene.models.push_back(
      {.name = "box",
       .source = box,
       .model = std::make_shared<const scene::Model>(scene::modelOf(box).value()),
       .tagId = tag.id,
       .srgb = {0.1F, 0.2F, 0.9F}});
  return scene;
}

class ListDispatchTest : public PainterTest, public testing::WithParamInterface<const char*> {
 protected:
  /// Pictures of the workbench, from just before the arm comes on.
  static std::vector<std::uint8_t> paintedWith(gpu::ListDispatch how) {
    hal::SteppedClock clock;
    hal::SyntheticCamera camera({.size = kListPicture, .shot = hal::SyntheticShot::kOccluder},
                                clock);
    hal::orThrow(camera.start({}));
    Painter painter({.pictureSize = kListPicture,
                     .scene = boxBeforeTheArm(camera.truth(0)),
                     .style = GetParam(),
                     .listDispatch = how});
    std::vector<std::uint8_t> all;
    for (std::uint64_t i = 0; i < kArmComes + kListFrames; ++i) {
      hal::NextFrame next = camera.next(hal::kNoDeadline);
      if (i < kArmComes) continue;
      const auto picture = painted(painter, std::get<hal::CapturedFrame>(std::move(next)));
      all.insert(all.end(), picture.begin(), picture.end());
    }
    return all;
  }
};

TEST_P(ListDispatchTest, BothPaintTheSame) {
  const auto indirect = paintedWith(gpu::ListDispatch::kIndirect);
  const auto allGroups = paintedWith(gpu::ListDispatch::kAllGroups);
  EXPECT_EQ(indirect, allGroups);
}

INSTANTIATE_TEST_SUITE_P(Styles, ListDispatchTest,
                         testing::Values("painterly", "watercolor", "hatching"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST(ListDispatch, AsksV3dForNoIndirectOne) {
  EXPECT_EQ(gpu::fasterListDispatch({.renderer = "V3D 4.2.14.0"}), gpu::ListDispatch::kAllGroups);
  EXPECT_EQ(gpu::fasterListDispatch({.renderer = "llvmpipe (LLVM 15.0.7, 256 bits)"}),
            gpu::ListDispatch::kIndirect);
}

}  // namespace
}  // namespace pleinair
