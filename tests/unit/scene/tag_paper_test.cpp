#include "pipeline/scene/light/tag_paper.h"

#include <gtest/gtest.h>

#include "tests/unit/scene/lit_tags.h"

namespace pleinair::scene {
namespace {

RoomOfTags warmRoom() {
  RoomOfTags room;
  room.key = {0.5, 0.4, 0.25};
  room.ambient = {0.2, 0.2, 0.2};
  room.tags = {placedTag(3, {}, 0, 0)};
  return room;
}

std::optional<TagPaper> read(const hal::Image& image, const Tracked& tracked) {
  return readTagPaper(LinearImage(image.view()), tracked.tags[0].corners, 8);
}

TEST(TagPaper, ReadsPaperAndInkAtAnyAngle) {
  const RoomOfTags room = warmRoom();
  for (const double down : {90.0, 50.0, 25.0}) {
    const Shot shot{.cameraFromWorld = lookingAtOrigin(0.5, down, 20.0)};
    const auto paper = read(noisy(pictureOf(room, shot), 1), trackedIn(room, shot));
    ASSERT_TRUE(paper) << down;
    EXPECT_NEAR(paper->white.r, 0.7, 0.02) << down;
    EXPECT_NEAR(paper->white.g, 0.6, 0.02) << down;
    EXPECT_NEAR(paper->white.b, 0.45, 0.02) << down;
    EXPECT_NEAR(paper->black.g, 0.03, 0.01) << down;
    EXPECT_GT(paper->confidence, 0.0F);
  }
}

TEST(TagPaper, RefusesWhatIsTooSmallCoveredOrNoPaper) {
  const RoomOfTags room = warmRoom();
  const Shot far{.cameraFromWorld = lookingAtOrigin(4.0, 60.0, 0.0)};
  EXPECT_FALSE(read(pictureOf(room, far), trackedIn(room, far)));

  const Shot near{.cameraFromWorld = lookingAtOrigin(0.5, 60.0, 0.0)};
  const Tracked tracked = trackedIn(room, near);
  hal::Image covered = pictureOf(room, near);
  ASSERT_TRUE(read(covered, tracked));
  for (int y = 0; y < covered.size().height; ++y) {  // a hand over its right half
    const auto row = covered.row(0, y);
    std::fill(row.begin() + 3 * 160, row.end(), std::uint8_t{90});
  }
  EXPECT_FALSE(read(covered, tracked));
  hal::Image blank = pictureOf(room, near);
  for (auto& byte : blank.plane(0)) byte = 128;
  EXPECT_FALSE(read(blank, tracked));
}

TEST(TagPaper, AFingerOnTheBorderDoesNotCount) {
  const RoomOfTags room = warmRoom();
  const Shot shot{.cameraFromWorld = lookingAtOrigin(0.4, 90.0, 0.0)};
  const Tracked tracked = trackedIn(room, shot);
  hal::Image image = pictureOf(room, shot);
  const auto before = read(image, tracked);
  for (int y = 150; y < 210; ++y) {  // at the lower edge
    const auto row = image.row(0, y);
    std::fill(row.begin() + 3 * 150, row.begin() + 3 * 172, std::uint8_t{60});
  }
  const auto after = read(image, tracked);
  ASSERT_TRUE(before && after);
  EXPECT_NEAR(after->white.g, before->white.g, 0.01);
}

TEST(TagPaper, KnowsTheFamiliesWithAWhiteBorder) {
  EXPECT_EQ(cellsAlongEdge("tag36h11"), 8);
  EXPECT_EQ(cellsAlongEdge("tag16h5"), 6);
  EXPECT_FALSE(cellsAlongEdge("tagStandard41h12"));
}

}  // namespace
}  // namespace pleinair::scene
