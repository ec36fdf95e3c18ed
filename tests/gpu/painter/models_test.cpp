#include <cmath>

#include <glm/vec2.hpp>

#include "tests/gpu/painter/painter_fixture.h"
#include "tests/support/tag_scene.h"

namespace pleinair {
namespace {

constexpr hal::FrameSize kFrame{320, 240};
constexpr double kFocalPx = 300.0;
constexpr double kTagMetres = 0.1;
constexpr double kBoxMetres = 0.05;
constexpr double kAheadMetres = 0.5;
/// Half of the box's picture: of its face towards the camera, which hides the rest of it.
constexpr double kHalfBoxPx = kFocalPx * kBoxMetres / 2.0 / (kAheadMetres - kBoxMetres);

tracking::CameraModel camera() {
  return {{.fx = kFocalPx, .fy = kFocalPx, .cx = 160.0, .cy = 120.0}, {}, kFrame};
}

/// A tag that faces the camera, in the middle of the picture.
hal::CapturedFrame tagFrame() {
  const support::SceneTag tag{
      .id = 3, .edgeMetres = kTagMetres, .worldFromTag = support::poseOf({}, {0, 0, kAheadMetres})};
  const hal::Image grey = support::renderTags(camera(), glm::dmat4(1.0), {&tag, 1});
  return frameOf(support::neutralPicture(grey, hal::PixelFormat::kI420), 0);
}

scene::Scene boxOnTheTag() {
  scene::Scene scene;
  scene.camera = camera();
  scene.tags.push_back({.id = 3, .edgeMetres = kTagMetres});
  scene.light.shadow = 0.0F;  // which would fall beside it
  const scene::BoxSource box{glm::dvec3(kBoxMetres)};
  scene.models.push_back(
      {.name = "box",
       .source = box,
       .model = std::make_shared<const scene::Model>(scene::modelOf(box).value()),
       .tagId = 3,
       .srgb = {0.1F, 0.2F, 0.9F}});
  return scene;
}

/// Expects two RGB8 pictures to differ where a square around the middle is, and only there. Within
/// a pixel of its sides, either may be.
void expectOnlyABoxBetween(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b,
                           hal::FrameSize size, double halfSidePx) {
  ASSERT_EQ(a.size(), b.size());
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double across = std::abs(x + 0.5 - 0.5 * size.width);
      const double down = std::abs(y + 0.5 - 0.5 * size.height);
      const double beyond = std::max(across, down) - halfSidePx;
      if (std::abs(beyond) < 1.0) continue;
      const auto at = 3 * static_cast<std::size_t>(y * size.width + x);
      const bool differs = a[at] != b[at] || a[at + 1] != b[at + 1] || a[at + 2] != b[at + 2];
      ASSERT_EQ(differs, beyond < 0.0) << x << ' ' << y;
    }
  }
}

TEST_F(PainterTest, PutsAModelOnItsTag) {
  Painter painter({.pictureSize = kFrame, .scene = boxOnTheTag()});
  const auto ar = painted(painter, tagFrame(), "ar");
  const auto camera = painted(painter, tagFrame(), "camera");
  expectOnlyABoxBetween(ar, camera, kFrame, kHalfBoxPx);
}

TEST_F(PainterTest, PutsAModelOnItsTagInPicturesOfAnotherShape) {
  constexpr hal::FrameSize kSquare{160, 160};  // 1.5 frame pixels each, cut at the sides
  Painter painter({.pictureSize = kSquare, .scene = boxOnTheTag()});
  const auto ar = painted(painter, tagFrame(), "ar");
  const auto camera = painted(painter, tagFrame(), "camera");
  expectOnlyABoxBetween(ar, camera, kSquare, kHalfBoxPx / 1.5);
}

TEST_F(PainterTest, TellsWhatItTracked) {
  Painter painter({.pictureSize = {32, 24}, .scene = boxOnTheTag()});
  const auto picture = painter.paint(tagFrame(), painter.defaultParameters());
  ASSERT_TRUE(picture);
  ASSERT_EQ(picture->tracking.tags.size(), 1u);
  const tracking::TrackedTag& tag = picture->tracking.tags[0];
  EXPECT_EQ(tag.id, 3);
  EXPECT_NEAR(tag.corners[0].x, 130.0, 0.3);  // of the frame, whatever the picture's size
  EXPECT_NEAR(tag.corners[0].y, 150.0, 0.3);
  ASSERT_TRUE(tag.cameraFromTag);
  EXPECT_NEAR((*tag.cameraFromTag)[3].z, kAheadMetres, 0.005);
}

TEST_F(PainterTest, PaintsModelsToo) {
  Painter bare({.pictureSize = kFrame});
  Painter withBox({.pictureSize = kFrame, .scene = boxOnTheTag()});
  const auto without = painted(bare, tagFrame());
  const auto with = painted(withBox, tagFrame());
  const auto middle = 3 * static_cast<std::size_t>(120 * kFrame.width + 160);
  // the box is blue, the tag is not
  EXPECT_GT(with[middle + 2], with[middle] + 40);
  EXPECT_LT(std::abs(without[middle + 2] - without[middle]), 40);
}

TEST_F(PainterTest, ShowsNoModelWithoutTracking) {
  Painter painter({.pictureSize = kFrame, .scene = boxOnTheTag(), .tracksTags = false});
  EXPECT_EQ(painted(painter, tagFrame(), "ar"), painted(painter, tagFrame(), "camera"));
  const auto picture = painter.paint(tagFrame(), painter.defaultParameters());
  ASSERT_TRUE(picture);
  EXPECT_TRUE(picture->tracking.tags.empty());
}

}  // namespace
}  // namespace pleinair
