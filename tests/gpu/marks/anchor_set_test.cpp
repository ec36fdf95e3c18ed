// Anchors: how many there are, and that they go with what they lie on.
#include <algorithm>
#include <cmath>
#include <memory>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "pipeline/scene/models/model_pose.h"
#include "tests/gpu/marks/marks_fixture.h"
#include "tests/gpu/scene/moving_models.h"
#include "tests/oracles/surface_oracle.h"

namespace pleinair::marks {
namespace {

tracking::ImageMotion following(const glm::dmat3& currentFromPrevious) {
  tracking::ImageMotion motion;
  motion.picture =
      tracking::ImageHomography{.currentFromPrevious = currentFromPrevious, .errorPx = 0.01};
  return motion;
}

using AnchorSetTest = MarksTest;

TEST_F(AnchorSetTest, FillsEachCellAtFirst) {
  scene::ArFrameRenderer renderer(library_, {});
  MotionField field(library_, kSize);
  AnchorSet set(library_, kSize, {});
  const scene::ArFrame frame = compose(renderer, {}, {});
  field.update(frame);
  set.advance(frame, field);
  std::vector<int> counts(40 * 30);
  for (const Anchor& each : alive(set)) {
    EXPECT_EQ(each.fade, 1.0F);
    ++counts.at(static_cast<std::size_t>(each.px.y / 8.0F) * 40 +
                static_cast<std::size_t>(each.px.x / 8.0F));
  }
  EXPECT_THAT(counts, testing::Each(2));
}

TEST_F(AnchorSetTest, GoesWithTheHomographyOfThePicture) {
  scene::ArFrameRenderer renderer(library_, {});
  MotionField field(library_, kSize);
  AnchorSet set(library_, kSize, {});
  const glm::dmat3 step(1.004, 0.003, 1e-6, -0.004, 1.003, -2e-6, -0.7, 0.4, 1.0);
  glm::dmat3 total(1.0);
  std::vector<Anchor> first;
  for (int i = 0; i < 60; ++i) {
    const scene::ArFrame frame =
        compose(renderer, {}, i == 0 ? tracking::ImageMotion{} : following(step));
    field.update(frame);
    set.advance(frame, field);
    if (i == 0) {
      first = set.read();
    } else {
      total = step * total;
    }
  }
  const std::vector<Anchor> last = set.read();
  double worst = 0.0;
  int compared = 0;
  for (std::size_t i = 0; i < last.size(); ++i) {
    if (!last[i].isAlive() || !first[i].isAlive() || last[i].seed != first[i].seed) continue;
    worst = std::max(worst,
                     glm::distance(glm::dvec2(last[i].px), moved(total, glm::dvec2(first[i].px))));
    EXPECT_EQ(last[i].source(), MotionSource::kPicture);
    ++compared;
  }
  EXPECT_GT(compared, 1000);
  EXPECT_LT(worst, 0.01);
}

class OnSurfaces : public MarksTest, public testing::WithParamInterface<scene::Model (*)()> {};

TEST_P(OnSurfaces, StaysOnItsTriangle) {
  scene::Scene scene;
  scene::SceneModel placed;
  scene::Model model = GetParam()();
  placed.playback.clip = model.rig.clips.empty() ? std::nullopt : std::optional<std::size_t>(0);
  placed.model = std::make_shared<const scene::Model>(std::move(model));
  scene.models.push_back(std::move(placed));
  scene::ArFrameRenderer renderer(library_, scene);
  MotionField field(library_, kSize);
  AnchorSet set(library_, kSize, {});
  const auto poseAt = [](int i) {
    const double t = 0.01 * i;
    return glm::rotate(glm::translate(glm::dmat4(1.0), {0.012 - 0.1 * t, 0.05 * t, 0.42 - 0.1 * t}),
                       0.72 + 0.3 * t, {0.9, 0.3, 0.1});
  };
  const hal::TimePoint start = time_ + kStep;
  double worst = 0.0;
  std::vector<double> slips;
  std::vector<std::optional<oracles::TrianglePoint>> born;
  for (int i = 0; i < 60; ++i) {
    const glm::dmat4 pose = poseAt(i);
    const scene::ArFrame frame =
        compose(renderer, {.cameraFromWorld = pose}, following(glm::dmat3(1.0)));
    field.update(frame);
    set.advance(frame, field);
    const hal::Duration elapsed = time_ - start;
    const scene::SceneModel& only = scene.models[0];
    oracles::PosedModel posed{.model = only.model.get(), .cameraFromModel = pose};
    poseModel(*only.model, scene::momentOf(only.model->rig, only.playback, elapsed), elapsed,
              posed.pose);
    // Where each was born, as a point of the mesh, and where that has gone.
    const std::vector<Anchor> anchors = set.read();
    born.resize(anchors.size());
    for (std::size_t slot = 0; slot < anchors.size(); ++slot) {
      const Anchor& each = anchors[slot];
      if (!each.isAlive() || each.surface == 0) continue;
      if (each.isBorn()) {
        born[slot] = oracles::pointBehind(posed, each.surface & (scene::kMaxTriangles - 1),
                                          camera(), glm::dvec2(each.px));
        continue;
      }
      if (!born[slot] || !each.isStaying()) continue;
      const glm::dvec2 expected = camera().project(oracles::cameraPoint(posed, *born[slot]));
      const double slip = glm::distance(glm::dvec2(each.px), expected);
      worst = std::max(worst, slip);
      slips.push_back(slip);
      EXPECT_EQ(each.source(), MotionSource::kSurface);
    }
  }
  ASSERT_GT(slips.size(), 1000U);
  std::ranges::sort(slips);
  RecordProperty("median_px", std::to_string(slips[slips.size() / 2]));
  EXPECT_LT(worst, 0.05);
  RecordProperty("worst_px", std::to_string(worst));
}

INSTANTIATE_TEST_SUITE_P(Models, OnSurfaces,
                         testing::Values(&scene::turningGears, &scene::swingingBoxes,
                                         &scene::bendingArm, &scene::breathingBall));

}  // namespace
}  // namespace pleinair::marks
