#include "firmware_app/scene/scene_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pleinair::app {
namespace {

using testing::Eq;
using testing::HasSubstr;
using testing::Optional;

scene::Scene sceneWithTags(const std::vector<int>& ids) {
  scene::Scene scene;
  for (const int id : ids) scene.tags.push_back({.id = id});
  return scene;
}

void attachModel(scene::Scene& scene, int id) {
  scene.models.emplace_back();
  scene.models.back().tagId = id;
}

TEST(UnseenTagsWarning, NamesTheTagsThatCarryModels) {
  scene::Scene scene = sceneWithTags({0, 1, 40, 41});
  attachModel(scene, 1);
  attachModel(scene, 40);
  EXPECT_THAT(unseenTagsWarning(scene, {0, 1, 2}),
              Optional(Eq("tag 40 of the scene was never seen; seen: 0, 1, 2")));
  attachModel(scene, 41);
  EXPECT_THAT(unseenTagsWarning(scene, {0, 1}),
              Optional(Eq("tags 40, 41 of the scene were never seen; seen: 0, 1")));
}

TEST(UnseenTagsWarning, NamesAllTagsWhereNoneWasSeen) {
  EXPECT_THAT(unseenTagsWarning(sceneWithTags({3, 4}), {7}),
              Optional(Eq("tags 3, 4 of the scene were never seen; seen: 7")));
  EXPECT_THAT(unseenTagsWarning(sceneWithTags({3}), {}),
              Optional(Eq("tag 3 of the scene was never seen; seen: none")));
}

TEST(UnseenTagsWarning, IsSilentWhereNothingIsAmiss) {
  EXPECT_FALSE(unseenTagsWarning(scene::Scene{}, {}));
  EXPECT_FALSE(unseenTagsWarning(sceneWithTags({3, 4}), {4}));
}

TEST(UnseenTagsWarning, LeavesOutTheOthersOfASingleFrame) {
  scene::Scene scene = sceneWithTags({0, 4});
  attachModel(scene, 4);
  EXPECT_TRUE(unseenTagsWarning(scene, {0}));
  EXPECT_FALSE(unseenTagsWarning(scene, {0}, true));
  EXPECT_TRUE(unseenTagsWarning(scene, {}, true));
}

TEST(BlackViewWarning, NamesAViewOfMotionOfASingleFrame) {
  scene::Scene scene = sceneWithTags({0});
  attachModel(scene, 0);
  EXPECT_THAT(blackViewWarning(scene, "motion", true), Optional(HasSubstr("--frames 2")));
  EXPECT_THAT(blackViewWarning(scene, "motion_error", true), Optional(HasSubstr("one frame")));
  EXPECT_FALSE(blackViewWarning(scene, "depth", true));
}

TEST(BlackViewWarning, NamesAViewOfModelsThatAreNotThere) {
  EXPECT_THAT(blackViewWarning(scene::Scene{}, "motion"), Optional(HasSubstr("the view motion")));
  EXPECT_FALSE(blackViewWarning(scene::Scene{}, "anchors"));
  EXPECT_FALSE(blackViewWarning(scene::Scene{}, ""));
  scene::Scene scene = sceneWithTags({0});
  attachModel(scene, 0);
  EXPECT_FALSE(blackViewWarning(scene, "motion"));
}

TEST(AssumedCameraWarning, SaysTheFieldOfView) {
  scene::Scene scene = sceneWithTags({0});
  EXPECT_THAT(assumedCameraWarning(scene, {640, 480}), Optional(HasSubstr(" 60° ")));
  scene.camera = scene::assumedCamera({640, 480});
  EXPECT_FALSE(assumedCameraWarning(scene, {640, 480}));
  EXPECT_FALSE(assumedCameraWarning(scene::Scene{}, {640, 480}));
}

}  // namespace
}  // namespace pleinair::app
