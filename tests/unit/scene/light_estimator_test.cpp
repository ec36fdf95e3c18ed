#include "pipeline/scene/light/light_estimator.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "pipeline/scene/description/scene.h"
#include "tests/support/allocation_count.h"
#include "tests/unit/scene/lit_tags.h"

namespace pleinair::scene {
namespace {

constexpr std::array<std::optional<int>, 2> kPlaces{0, std::nullopt};
constexpr std::chrono::milliseconds kFrame(33);

/// Four tags that face different ways, a warm key light from the right and cool ambient light.
RoomOfTags manyTags() {
  RoomOfTags room;
  room.towardKey = {0.7, -0.3, 0.6};
  room.key = {0.50, 0.45, 0.35};
  room.ambient = {0.20, 0.22, 0.26};
  room.tags = {placedTag(0, {0, -0.05, 0}, 0, 0), placedTag(1, {-0.1, 0.14, 0.06}, 70, -50),
               placedTag(2, {0.16, 0.08, 0.06}, 60, 50), placedTag(3, {0.0, 0.2, 0.1}, 90, 0)};
  return room;
}

RoomOfTags oneTag() {
  RoomOfTags room = manyTags();
  room.tags.resize(1);
  return room;
}

Shot from(double aroundDegrees) {
  return {.cameraFromWorld = lookingAtOrigin(0.6, 40.0, aroundDegrees)};
}

/// An estimator and its clock.
class Watching {
 public:
  explicit Watching(const RoomOfTags& room, std::optional<glm::dvec3> towardKey = std::nullopt)
      : room_(room), estimator_(room.tags, "tag36h11", kPlaces, towardKey) {}

  const Lighting& see(const Shot& shot, const Tracked& tracked) {
    return see(noisy(pictureOf(room_, shot), ++seed_), tracked);
  }
  const Lighting& see(const Shot& shot) { return see(shot, trackedIn(room_, shot)); }
  const Lighting& see(const hal::Image& image, const Tracked& tracked) {
    time_ += kFrame;
    estimator_.follow(image.view(), tracked.result(), time_);
    return estimator_.lights()[0].light;
  }
  LightEstimator& estimator() { return estimator_; }
  void wait(hal::Duration time) { time_ += time; }

 private:
  RoomOfTags room_;
  std::uint32_t seed_ = 0;
  LightEstimator estimator_;
  hal::TimePoint time_;
};

double degreesApart(const glm::vec3& a, const glm::dvec3& b) {
  const double cosine = glm::dot(glm::normalize(glm::dvec3(a)), glm::normalize(b));
  return glm::degrees(std::acos(std::min(cosine, 1.0)));
}

/// On the table, and at all other places that face up.
glm::dvec3 whiteOnTable(const RoomOfTags& room) {
  return room.ambient + room.key * glm::normalize(room.towardKey).z;
}

void expectNear(const glm::vec3& is, const glm::dvec3& should, double tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(is[c], should[c], tolerance) << "channel " << c;
}

TEST(LightEstimator, WhiteIsTheTagsPaper) {
  for (const RoomOfTags& room : {manyTags(), oneTag()}) {
    Watching watching(room);
    const Lighting& light = watching.see(from(0));
    expectNear(light.white, whiteOnTable(room), 0.02);
    expectNear(light.sky + light.key * std::max(0.0F, light.towardKey.z), whiteOnTable(room), 0.03);
    expectNear(watching.estimator().lights()[1].light.white, whiteOnTable(room), 0.03);
  }
}

TEST(LightEstimator, TagsThatFaceDifferentWaysShowTheKeyLight) {
  const RoomOfTags room = manyTags();
  Watching watching(room);
  const Lighting& light = watching.see(from(0));
  EXPECT_LT(degreesApart(light.towardKey, room.towardKey), 18.0);
  // Warm versus cool.
  EXPECT_GT(light.key.r / light.key.b, 1.15F * light.sky.r / light.sky.b);
  EXPECT_NEAR(luminanceOf(light.key) / luminanceOf(light.sky), 0.46 / 0.22, 1.0);
}

/// Negative control: light on one plane could come from any direction, so the prior decides.
TEST(LightEstimator, OneTagLeavesTheUpperLeftBehindTheViewer) {
  const RoomOfTags room = oneTag();
  Watching watching(room);
  const Lighting& light = watching.see(from(0));
  EXPECT_GT(degreesApart(light.towardKey, room.towardKey), 40.0);
  EXPECT_LT(light.towardKey.x, -0.3F);
  EXPECT_LT(light.towardKey.y, -0.1F);
  EXPECT_GT(light.towardKey.z, 0.5F);
}

TEST(LightEstimator, FindsTheLightBehindTheThings) {
  RoomOfTags room = manyTags();
  room.towardKey = {-0.2, 0.8, 0.6};
  Watching watching(room);
  EXPECT_GT(watching.see(from(0)).towardKey.y, 0.1F);
}

TEST(LightEstimator, ASlopeOfBrightnessPullsThePrior) {
  RoomOfTags room = oneTag();
  Watching even(room);
  const float before = even.see(from(0)).towardKey.x;
  room.backgroundSlope = {1.2, 0.0};  // brighter to the right
  Watching sloped(room);
  EXPECT_GT(sloped.see(from(0)).towardKey.x, before + 0.2F);
}

TEST(LightEstimator, RestsOnAStillScene) {
  const RoomOfTags room = manyTags();
  Watching watching(room);
  const Shot shot = from(10);
  const Tracked tracked = trackedIn(room, shot);
  const hal::Image picture = pictureOf(room, shot);
  Lighting rest;
  for (std::uint32_t i = 1; i < 12; ++i) rest = watching.see(noisy(picture, i), tracked);
  for (std::uint32_t i = 12; i < 40; ++i) {
    ASSERT_TRUE(watching.see(noisy(picture, i), tracked) == rest) << "frame " << i;
  }
}

TEST(LightEstimator, FollowsExposureWithinHalfASecondAndKeepsTheKey) {
  const RoomOfTags room = manyTags();
  Watching watching(room);
  Shot shot = from(0);
  const Lighting before = watching.see(shot);
  shot.gain = {0.6, 0.5, 0.4};
  const hal::Image darker = pictureOf(room, shot);
  const Tracked tracked = trackedIn(room, shot);
  const Lighting* light = &watching.see(darker, tracked);
  EXPECT_GT(light->white.g, 0.85F * before.white.g) << "not at once, else noise would flicker";
  for (int i = 0; i < 15; ++i) light = &watching.see(darker, tracked);
  expectNear(light->white, shot.gain * whiteOnTable(room), 0.03);
  EXPECT_LT(degreesApart(light->towardKey, before.towardKey), 3.0);
}

TEST(LightEstimator, AMovingCameraDoesNotTurnTheLight) {
  for (const RoomOfTags& room : {manyTags(), oneTag()}) {
    Watching watching(room);
    const Lighting before = watching.see(from(-30));
    for (double around = -30; around < 30; around += 10) {
      const Lighting& now = watching.see(from(around));
      EXPECT_LT(degreesApart(now.towardKey, before.towardKey), 12.0) << around;
      expectNear(now.white, before.white, 0.03);
    }
  }
}

TEST(LightEstimator, AHiddenTagKeepsItsLightAndTheExposuresChange) {
  const RoomOfTags room = manyTags();
  Watching watching(room);
  Shot shot = from(0);
  const Lighting before = watching.see(shot);
  Tracked hidden = trackedIn(room, shot);
  hidden.tags.clear();
  const hal::Image picture = pictureOf(room, shot);
  for (int i = 0; i < 10; ++i) expectNear(watching.see(picture, hidden).white, before.white, 0.02);
  shot.gain = glm::dvec3(0.5);
  const hal::Image darker = pictureOf(room, shot);
  const Lighting* light = nullptr;
  for (int i = 0; i < 20; ++i) light = &watching.see(darker, hidden);
  expectNear(light->white, 0.5 * whiteOnTable(room), 0.03);
  EXPECT_EQ(light->towardKey, before.towardKey);
}

/// The tag's corners are at the expected position, which something else may cover.
TEST(LightEstimator, DoesNotReadTagsThatAreCarried) {
  RoomOfTags room = manyTags();
  Watching watching(room);
  const Shot shot = from(0);
  Tracked tracked = trackedIn(room, shot);
  const Lighting before = watching.see(shot, tracked);
  room.key *= 0.4;
  room.ambient *= 0.4;
  const hal::Image darkPaper = pictureOf(room, shot);
  for (tracking::TrackedTag& tag : tracked.tags) tag.source = tracking::PoseSource::kCarried;
  for (int i = 0; i < 10; ++i) {
    EXPECT_GT(watching.see(darkPaper, tracked).white.g, 0.8F * before.white.g);
  }
  for (tracking::TrackedTag& tag : tracked.tags) tag.source = tracking::PoseSource::kSeen;
  const Lighting* seen = nullptr;
  for (int i = 0; i < 10; ++i) seen = &watching.see(darkPaper, tracked);
  expectNear(seen->white, whiteOnTable(room), 0.05);
}

TEST(LightEstimator, WithoutPaperTheWorldIsGrey) {
  RoomOfTags room = manyTags();
  room.background = {0.16, 0.15, 0.12};
  Watching watching(room);
  const Shot shot = from(0);
  Tracked none = trackedIn(room, shot);
  none.tags.clear();
  const Lighting& light = watching.see(shot, none);
  EXPECT_EQ(light.white.r, light.white.b);
  EXPECT_GT(light.white.g, 0.3F);
  EXPECT_LE(light.white.g, 1.0F);
}

TEST(LightEstimator, ADirectionThatIsKnownStays) {
  const RoomOfTags room = manyTags();
  const glm::dvec3 known = glm::normalize(glm::dvec3(-0.3, 0.8, 0.5));
  Watching watching(room, known);
  const Lighting& light = watching.see(from(0));
  EXPECT_LT(degreesApart(light.towardKey, known), 0.01);
  expectNear(light.white, whiteOnTable(room), 0.02);
}

/// Two of the paper's channels are 0 in this light.
TEST(LightEstimator, LightOfOneColourIsLight) {
  RoomOfTags room = manyTags();
  room.key = {0.0, 0.0, 0.6};
  room.ambient = {0.0, 0.0, 0.3};
  room.background = {0.0, 0.0, 0.1};
  Watching watching(room);
  const hal::Image picture = pictureOf(room, from(0));
  for (int i = 0; i < 3; ++i) {
    const Lighting& light = watching.see(picture, trackedIn(room, from(0)));
    expectNear(light.white, whiteOnTable(room), 0.02);
    for (const glm::vec3& each : {light.key, light.sky, light.ground, light.towardKey}) {
      EXPECT_TRUE(std::isfinite(each.r) && std::isfinite(each.g) && std::isfinite(each.b));
    }
  }
}

TEST(LightEstimator, ResetAndAPauseForget) {
  const RoomOfTags room = manyTags();
  const hal::Image picture = pictureOf(room, from(20));
  const Tracked tracked = trackedIn(room, from(20));
  Watching watching(room), fresh(room);
  const Lighting first = fresh.see(picture, tracked);
  Shot dark = from(0);
  dark.gain = glm::dvec3(0.4);
  watching.see(dark);
  watching.wait(std::chrono::seconds(1));
  EXPECT_EQ(watching.see(picture, tracked).white, first.white) << "of half a second ago at most";
  watching.see(dark);
  watching.estimator().reset();
  const Lighting& again = watching.see(picture, tracked);
  EXPECT_TRUE(again == first);
}

TEST(LightEstimator, AllocatesNothing) {
  const RoomOfTags room = manyTags();
  const Shot shot = from(0);
  const hal::Image image = pictureOf(room, shot);
  const Tracked tracked = trackedIn(room, shot);
  LightEstimator estimator(room.tags, "tag36h11", kPlaces);
  hal::TimePoint time;
  EXPECT_EQ(support::allocationsIn([&] {
              for (int i = 0; i < 3; ++i) {
                estimator.follow(image.view(), tracked.result(), time += kFrame);
              }
            }),
            0)
      << support::allocationSites();
}

}  // namespace
}  // namespace pleinair::scene
