#include "firmware_app/repair_station/seen_tags.h"

#include <gmock/gmock.h>

namespace pleinair::app {
namespace {

TEST(MachinePlace, IsWhereTheSceneHasTheModel) {
  scene::SceneModel machine{.tagId = 3};
  machine.attachFromModel[3][0] = 0.5;
  const MachinePlace place = machinePlaceOf(machine);
  EXPECT_TRUE(place.isKnown);
  EXPECT_EQ(place.tagId, 3);
  EXPECT_EQ(place.attachFromModel[3][0], 0.5);
}

class PoseQualityTest : public testing::Test {
 protected:
  static tracking::TrackedTag tag(int id, double sigmaMetres, bool isCarried = false) {
    tracking::TrackedTag tag{.id = id, .cameraFromTag = glm::dmat4(1.0)};
    tag.corners = {{{10, 60}, {60, 60}, {60, 10}, {10, 10}}};
    tag.covariance[35] = sigmaMetres * sigmaMetres;
    if (isCarried) tag.source = tracking::PoseSource::kCarried;
    return tag;
  }
};

TEST_F(PoseQualityTest, IsOfTheMachinesTagAndNotOfTheBoards) {
  const std::vector<tracking::TrackedTag> tags{tag(3, 0.0008), tag(7, 0.05, true)};
  const SeenTags seen = seenTagsOf({.tags = tags}, {640, 480}, {});
  const auto machine = poseQualityOf({.isKnown = true, .tagId = 3}, seen);
  EXPECT_EQ(machine->source, "seen");
  EXPECT_NEAR(*machine->sigmaMillimetres, 0.8, 1e-9);
  EXPECT_FALSE(machine->rmsPx);
  EXPECT_EQ(poseQualityOf({.isKnown = true, .tagId = 7}, seen)->source, "carried");
  EXPECT_EQ(poseQualityOf({.isKnown = true, .tagId = 9}, seen)->source, "none");
  EXPECT_EQ(poseQualityOf({.isKnown = true}, seen)->source, "none") << "no world is seen";
  EXPECT_FALSE(poseQualityOf({}, seen));
  ASSERT_EQ(seen.tags().size(), 1U) << "a carried tag is not shown";
  EXPECT_NEAR(seen.tags()[0].edgeShare, 50.0 / 480, 1e-9);
}

TEST_F(PoseQualityTest, OfTheWorldHasItsError) {
  tracking::TrackingResult tracking;
  tracking.cameraFromWorld = glm::dmat4(1.0);
  tracking.worldRmsPx = 0.3;
  tracking.worldTranslationSigmaMetres = 0.002;
  const auto quality = poseQualityOf({.isKnown = true}, seenTagsOf(tracking, {640, 480}, {}));
  EXPECT_EQ(quality->rmsPx, 0.3);
  EXPECT_NEAR(*quality->sigmaMillimetres, 2.0, 1e-9);
}

}  // namespace
}  // namespace pleinair::app
