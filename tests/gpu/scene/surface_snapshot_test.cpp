// Snapshots of surfaces: where each pixel's point is, in its own frame and in others, against
// points that the CPU poses and projects.
#include "pipeline/scene/render/surface_snapshot.h"

#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/gpu/scene/moving_models.h"
#include "tests/gpu/scene/scene_gl_test.h"
#include "tests/gpu/scene/two_poses.h"
#include "tests/oracles/surface_oracle.h"

namespace pleinair::scene {
namespace {

using std::chrono::milliseconds;

constexpr hal::FrameSize kSize = kTwoPosesSize;
constexpr hal::TimePoint kFirst{milliseconds(100)};
constexpr hal::TimePoint kTenLater{milliseconds(433)};

struct Case {
  std::string name;
  Model (*make)();
  tracking::Distortion lens;
};

class SurfaceSnapshots : public SceneGlTest, public testing::WithParamInterface<Case> {
 protected:
  static tracking::CameraModel camera() {
    return {{.fx = 260.0, .fy = 262.0, .cx = 122.3, .cy = 88.4}, GetParam().lens, kSize};
  }

  static Scene sceneOf(Model model) {
    Scene scene;
    SceneModel placed;
    placed.playback.clip = model.rig.clips.empty() ? std::nullopt : std::optional<std::size_t>(0);
    placed.model = std::make_shared<const Model>(std::move(model));
    scene.models.push_back(std::move(placed));
    return scene;
  }

  static oracles::PosedModel posedAt(const Scene& scene, hal::TimePoint time,
                                     const glm::dmat4& cameraFromModel) {
    const SceneModel& model = scene.models[0];
    oracles::PosedModel posed{.model = model.model.get(), .cameraFromModel = cameraFromModel};
    const hal::Duration elapsed = time.time_since_epoch();
    poseModel(*model.model, momentOf(model.model->rig, model.playback, elapsed), elapsed,
              posed.pose);
    return posed;
  }

  SurfaceSnapshot snapshotAt(ArFrameRenderer& renderer, hal::TimePoint time,
                             const glm::dmat4& cameraFromWorld) {
    renderer.compose(picture_, camera(), {.cameraFromWorld = cameraFromWorld}, ++sequence_, time,
                     {.surfaces = true});
    return renderer.snapshot();
  }

  gpu::Texture picture_;
  std::uint64_t sequence_ = 0;
};

/// Counts pixels whose place in a snapshot is further than `allowed` px from an expected one.
struct Errors {
  int judged = 0;
  int wrong = 0;
  int unknown = 0;
};

template <class Expected>
Errors errorsOf(const SurfaceSnapshot& shown, const SurfaceSnapshot& elsewhere, double allowed,
                const Expected& expected) {
  Errors errors;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const std::uint32_t id = shown.id(x, y);
      if (id == 0) continue;
      const std::optional<glm::dvec2> right = expected(id, glm::dvec2(x + 0.5, y + 0.5));
      if (!right) continue;
      ++errors.judged;
      const std::optional<glm::dvec2> found = elsewhere.place(id, shown.barycentrics(x, y));
      errors.unknown += found ? 0 : 1;
      errors.wrong += found && glm::distance(*found, *right) <= allowed ? 0 : 1;
    }
  }
  return errors;
}

TEST_P(SurfaceSnapshots, PutAPixelsPointWhereItIsAndWhereItWillBe) {
  picture_ = plainPicture(kSize);
  const Scene scene = sceneOf(GetParam().make());
  ArFrameRenderer renderer(library_, scene);
  snapshotAt(renderer, {}, glm::dmat4(1.0));  // time starts here
  const SurfaceSnapshot first = snapshotAt(renderer, kFirst, previousAslant());
  snapshotAt(renderer, hal::TimePoint(milliseconds(300)), glm::dmat4(1.0));  // another in between
  const SurfaceSnapshot later = snapshotAt(renderer, kTenLater, currentAslant());

  // Rounding of barycentrics, and the lens within a triangle.
  const double allowed = GetParam().lens.k1 == 0.0 ? 0.02 : 0.1;
  const Errors itself = errorsOf(first, first, allowed,
                                 [](std::uint32_t, glm::dvec2 px) { return std::optional(px); });
  EXPECT_GT(itself.judged, 3000);
  EXPECT_LE(itself.wrong, itself.judged / 200);  // pixels exactly on a triangle's edge
  EXPECT_EQ(itself.unknown, 0);

  const oracles::PosedModel before = posedAt(scene, kFirst, previousAslant());
  const oracles::PosedModel after = posedAt(scene, kTenLater, currentAslant());
  const auto placeOf = [&](const oracles::PosedModel& then) {
    return [&](std::uint32_t id, glm::dvec2 px) -> std::optional<glm::dvec2> {
      const auto point = oracles::pointBehind(before, id & (kMaxTriangles - 1U), camera(), px);
      if (!point) return std::nullopt;
      return camera().project(oracles::cameraPoint(then, *point));
    };
  };
  const Errors moved = errorsOf(first, later, allowed, placeOf(after));
  EXPECT_GT(moved.judged, 3000);
  EXPECT_LE(moved.wrong, moved.judged / 200);
  EXPECT_EQ(moved.unknown, 0);

  // The control: where the model was before is not where it is.
  const Errors forgotten = errorsOf(first, later, allowed, placeOf(before));
  EXPECT_GT(forgotten.wrong, forgotten.judged * 9 / 10);
}

INSTANTIATE_TEST_SUITE_P(Models, SurfaceSnapshots,
                         testing::Values(Case{"Static", staticBox, {}},
                                         Case{"Turning", turningGears, {}},
                                         Case{"Skinned", bendingArm, {}},
                                         Case{"SkinnedThroughALens", bendingArm, kBarrel},
                                         Case{"Morphed", breathingBall, {}}),
                         [](const auto& instance) { return instance.param.name; });

class SurfaceSnapshotsOf : public SceneGlTest {};

TEST_F(SurfaceSnapshotsOf, AFrameWithoutModelsShowTheCamerasImage) {
  Scene scene;
  SceneModel placed;
  placed.model = std::make_shared<const Model>(staticBox());
  scene.models.push_back(std::move(placed));
  ArFrameRenderer renderer(library_, scene);
  const gpu::Texture picture = plainPicture(kSize);
  const tracking::CameraModel camera({.fx = 260.0, .fy = 262.0, .cx = 122.3, .cy = 88.4}, {},
                                     kSize);
  renderer.compose(picture, camera, {}, 1, {}, {.surfaces = true});  // the world is not seen
  const SurfaceSnapshot snapshot = renderer.snapshot();
  EXPECT_EQ(snapshot.size(), kSize);
  EXPECT_EQ(snapshot.id(120, 90), 0u);
  EXPECT_FALSE(snapshot.place(1U << kTriangleBits, {0.3F, 0.3F}));
}

}  // namespace
}  // namespace pleinair::scene
