// Anchors on real things whose models are known (occluders): they keep their points of the surface,
// go on in the image where the pose is lost or less certain than the image, and stay behind movers.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "pipeline/scene/models/model_pose.h"
#include "tests/gpu/marks/anchor_life_fixture.h"
#include "tests/gpu/marks/wall_and_disc.h"
#include "tests/oracles/surface_oracle.h"

namespace pleinair::marks {
namespace {

using tracking::ImageMotion;

constexpr double kMaxSlipPx = 0.05;

bool isReal(const Anchor& anchor) {
  return anchor.isAlive() && anchor.surface >> scene::kTriangleBits >= scene::kRealObject;
}

scene::Scene realThing(scene::Model model) {
  scene::Scene scene;
  scene::SceneModel placed;
  placed.isOccluder = true;
  placed.playback.clip = model.rig.clips.empty() ? std::nullopt : std::optional<std::size_t>(0);
  placed.model = std::make_shared<const scene::Model>(std::move(model));
  scene.models.push_back(std::move(placed));
  return scene;
}

scene::Scene realBox() {
  scene::Scene scene = boxScene();
  scene.models.front().isOccluder = true;
  return scene;
}

/// A camera that goes around.
glm::dmat4 poseAround(int frame) {
  const double t = 0.01 * frame;
  return glm::rotate(glm::translate(glm::dmat4(1.0), {0.012 - 0.1 * t, 0.05 * t, 0.42 - 0.1 * t}),
                     0.72 + 0.3 * t, {0.9, 0.3, 0.1});
}

/// How far anchors are from the points that they were born on.
class PointSlips {
 public:
  void add(const std::vector<Anchor>& anchors, const oracles::PosedModel& posed,
           const tracking::CameraModel& camera) {
    born_.resize(anchors.size());
    for (std::size_t slot = 0; slot < anchors.size(); ++slot) {
      const Anchor& each = anchors[slot];
      if (!isReal(each)) continue;
      Born& born = born_[slot];
      if (each.isBorn()) {
        born = {.surface = each.surface,
                .point = oracles::pointBehind(posed, each.surface & (scene::kMaxTriangles - 1),
                                              camera, glm::dvec2(each.px))};
        continue;
      }
      if (!born.point || !each.isStaying()) continue;
      const glm::dvec2 expected = camera.project(oracles::cameraPoint(posed, *born.point));
      worst_ = std::max(worst_, glm::distance(glm::dvec2(each.px), expected));
      otherTriangles_ += each.surface == born.surface ? 0 : 1;
      otherSources_ += each.source() == MotionSource::kSurface ? 0 : 1;
      ++count_;
    }
  }
  double worst() const { return worst_; }
  int count() const { return count_; }
  int otherTriangles() const { return otherTriangles_; }
  int otherSources() const { return otherSources_; }

 private:
  struct Born {
    std::uint32_t surface = 0;
    std::optional<oracles::TrianglePoint> point;
  };
  std::vector<Born> born_;
  double worst_ = 0.0;
  int count_ = 0;
  int otherTriangles_ = 0;
  int otherSources_ = 0;
};

class OnRealThings : public AnchorLife {
 protected:
  /// Sixty frames of a camera that goes around a real thing, of which the image says that it pans;
  /// `told` is what the poses say, `pose` what is true.
  template <class Pose>
  PointSlips aroundIt(const scene::Scene& scene, const ImageMotion& measured, Pose told) {
    useScene(scene);
    PointSlips slips;
    const hal::TimePoint start = time_ + kStep;
    for (int i = 0; i < 60; ++i) {
      const std::vector<Anchor> anchors = next(measured, {.cameraFromWorld = told(i)});
      const scene::SceneModel& only = scene.models[0];
      oracles::PosedModel posed{.model = only.model.get(), .cameraFromModel = poseAround(i)};
      const hal::Duration elapsed = time_ - start;
      poseModel(*only.model, scene::momentOf(only.model->rig, only.playback, elapsed), elapsed,
                posed.pose);
      slips.add(anchors, posed, camera());
    }
    return slips;
  }
};

class RealModels : public OnRealThings, public testing::WithParamInterface<scene::Model (*)()> {};

TEST_P(RealModels, KeepTheirAnchorsOnTheirTriangles) {
  const PointSlips slips = aroundIt(realThing(GetParam()()), panning(-0.6, 0.3), poseAround);
  ASSERT_GT(slips.count(), 1000);
  EXPECT_LT(slips.worst(), kMaxSlipPx);
  EXPECT_EQ(slips.otherTriangles(), 0);
  EXPECT_EQ(slips.otherSources(), 0);
  RecordProperty("worst_px", std::to_string(slips.worst()));
}

INSTANTIATE_TEST_SUITE_P(Models, RealModels,
                         testing::Values(&scene::turningGears, &scene::swingingBoxes,
                                         &scene::bendingArm, &scene::breathingBall));

/// The control of the slips above: poses that lag by a frame are seen.
TEST_F(OnRealThings, PosesOfThePreviousFrameAreSeenAsSlip) {
  const PointSlips slips = aroundIt(realThing(scene::turningGears()), panning(-0.6, 0.3),
                                    [](int i) { return poseAround(i - 1); });
  EXPECT_GT(slips.worst(), 4.0 * kMaxSlipPx);
}

tracking::PoseCovariance covarianceOf(double radians, double metres) {
  tracking::PoseCovariance covariance{};
  for (std::size_t i = 0; i < 6; ++i) {
    const double sigma = i < 3 ? radians : metres;
    covariance[7 * i] = sigma * sigma;
  }
  return covariance;
}

/// Half a pixel of jitter, before a camera and a thing that stand.
TEST_F(OnRealThings, AnUncertainPoseMovesNothingThatTheImageSaysIsStill) {
  useScene(realBox());
  const auto poses = [](int i) {
    scene::PoseSet set = boxAt(160.0 + (i % 2 == 0 ? 0.4 : -0.4));
    set.worldCovariance = covarianceOf(1e-3, 8e-4);
    return set;
  };
  next({}, poses(0));
  const std::vector<Anchor> first = next(panning(0.0, 0.0), poses(1));
  std::vector<Anchor> last;
  for (int i = 2; i < 30; ++i) last = next(panning(0.0, 0.0), poses(i));
  int compared = 0;
  for (std::size_t slot = 0; slot < first.size(); ++slot) {
    if (!isReal(first[slot]) || !first[slot].isStaying()) continue;
    // Those beside the outline may lose it.
    if (glm::distance(first[slot].px.x, 160.0F) > 34.0F) continue;
    if (glm::distance(first[slot].px.y, 118.0F) > 34.0F) continue;
    ASSERT_EQ(last[slot].seed, first[slot].seed);
    ASSERT_EQ(last[slot].px, first[slot].px);
    ASSERT_EQ(last[slot].surface, first[slot].surface);
    ++compared;
  }
  EXPECT_GT(compared, 100);
}

/// It moves by itself before a wall that stands, and nothing but its pose tells it.
TEST_F(OnRealThings, ThePoseCarriesWhatTheImageDoesNotTell) {
  useScene(realBox());
  const auto poses = [](int i) {
    scene::PoseSet set = boxAt(120.0 + 2.0 * i);
    set.worldCovariance = covarianceOf(2e-4, 2e-4);
    return set;
  };
  next({}, poses(0));
  const std::vector<Anchor> first = next(panning(0.0, 0.0), poses(1));
  std::vector<Anchor> last;
  for (int i = 2; i < 30; ++i) last = next(panning(0.0, 0.0), poses(i));
  int compared = 0;
  for (std::size_t slot = 0; slot < first.size(); ++slot) {
    if (!isReal(first[slot]) || !first[slot].isStaying()) continue;
    if (glm::distance(first[slot].px, glm::vec2(122.0F, 118.0F)) > 34.0F) continue;
    ASSERT_EQ(last[slot].seed, first[slot].seed);
    ASSERT_LT(glm::distance(last[slot].px, first[slot].px + glm::vec2(56.0F, 0.0F)), 0.05F);
    ++compared;
  }
  EXPECT_GT(compared, 100);
}

/// Whether the centre of its pixel may be on the other side of the box's outline.
bool isOnOutline(glm::vec2 px, float middle) {
  constexpr float kHalf = 36.4F;
  const glm::vec2 away = glm::abs(glm::abs(px - glm::vec2(middle, 118.0F)) - kHalf);
  return std::min(away.x, away.y) < 2.0F;
}

TEST_F(OnRealThings, ALostPoseMovesAndEndsNothing) {
  // A model that stays in sight, so that the frames without the box have ids.
  scene::Scene scene = realBox();
  scene.models.front().tagId = 0;
  scene.tags.push_back({.id = 0});
  scene.models.push_back(boxScene().models.front());
  scene.models.back().attachFromModel = glm::translate(glm::dmat4(1.0), {-0.2, -0.15, 0.0});
  useScene(scene);
  const scene::PoseSet world = boxAt(162.0);
  std::vector<scene::TagSighting> tags(1);
  const auto withBox = [&](double x) {
    scene::PoseSet poses = world;
    tags[0].cameraFromTag = *boxAt(x).cameraFromWorld * scene::kTagFromAttach;
    poses.tags = tags;
    return poses;
  };
  const ImageMotion pan = panning(-0.5, 0.0);
  next({}, withBox(160.0));
  std::vector<Anchor> before = next(pan, withBox(159.5));
  int onBox = 0;
  for (const Anchor& each : before) onBox += isReal(each) && each.isStaying() ? 1 : 0;
  ASSERT_GT(onBox, 100);
  for (int i = 0; i < 12; ++i) {
    const bool isLost = i >= 2 && i < 8;
    const std::vector<Anchor> now = next(pan, isLost ? world : withBox(159.5 - 0.5 * (i + 1)));
    EXPECT_LE(births(now, 8.0F), 12) << i << ": beside outlines";
    int real = 0;
    for (std::size_t slot = 0; slot < now.size(); ++slot) {
      if (!before[slot].isStaying() || !isWithin(before[slot].px, 4.0F)) continue;
      if (glm::distance(before[slot].px, glm::vec2(42.0F, 28.0F)) < 60.0F) continue;  // the model
      if (isOnOutline(before[slot].px, 159.5F - 0.5F * static_cast<float>(i))) continue;
      ASSERT_TRUE(now[slot].isStaying()) << i << ": " << now[slot].state;
      ASSERT_EQ(now[slot].seed, before[slot].seed);
      const glm::vec2 moved = now[slot].px - before[slot].px;
      ASSERT_LT(glm::distance(moved, glm::vec2(-0.5F, 0.0F)), 0.01F) << i;
      real += isReal(now[slot]) && now[slot].isOnSurface() ? 1 : 0;
    }
    EXPECT_EQ(isLost, real == 0) << i;
    EXPECT_GT(real, isLost ? -1 : onBox / 2) << i << ": they have points of the surface again";
    before = now;
  }
}

/// What has come before other things hides their anchors.
TEST_F(OnRealThings, ARealThingThatComesHidesWhatIsBehind) {
  useScene(realBox());
  next({}, boxAt(60.0));
  for (int i = 1; i < 30; ++i) {
    const double x = 60.0 + 4.0 * i;
    for (const Anchor& each : next(panning(0.0, 0.0), boxAt(x))) {
      if (!each.isStaying() || isReal(each)) continue;
      const bool isBehind = std::abs(each.px.x - static_cast<float>(x)) < 33.0F &&
                            std::abs(each.px.y - 118.0F) < 33.0F;
      ASSERT_FALSE(isBehind) << i;
    }
  }
}

TEST_F(OnRealThings, TheFarSideIsHidden) {
  useScene(realThing(scene::breathingBall()));
  constexpr float kInside = 12.0F;  // px around the middle, where nothing but the ball is seen
  const auto turned = [](int i) {
    return scene::PoseSet{.cameraFromWorld =
                              glm::rotate(glm::translate(glm::dmat4(1.0), {0.0, 0.0, 0.5}),
                                          0.08 * i, {0.1, 1.0, 0.0})};
  };
  int hidden = 0;
  for (int i = 0; i < 40; ++i) {
    for (const Anchor& each : next(panning(0.0, 0.0), turned(i))) {
      if (!isReal(each) || glm::distance(each.px, glm::vec2(162.0F, 118.0F)) > kInside) continue;
      hidden += (each.state & Anchor::kHidden) != 0 ? 1 : 0;
    }
  }
  EXPECT_GT(hidden, 30);
}

}  // namespace
}  // namespace pleinair::marks
