#include <limits>

#include <glm/ext/matrix_transform.hpp>
#include <gmock/gmock.h>

#include "pipeline/scene/description/scene.h"
#include "tests/gpu/scene/scene_gl_test.h"

namespace pleinair::scene {
namespace {

using support::readR32ui;
using support::readRgba8;

constexpr hal::FrameSize kSize{160, 120};

tracking::CameraModel plainCamera(hal::FrameSize size = kSize) {
  return {{.fx = 200.0, .fy = 200.0, .cx = 80.0, .cy = 60.0}, {}, size};
}

/// The columns and rows that an object covers, as half-open intervals.
struct Extent {
  int left = std::numeric_limits<int>::max();
  int right = 0;
  int top = std::numeric_limits<int>::max();
  int bottom = 0;
  friend bool operator==(const Extent&, const Extent&) = default;
};

Extent extentOf(const gpu::Texture& idTexture, std::uint32_t object) {
  const auto ids = readR32ui(idTexture);
  Extent extent;
  for (int y = 0; y < idTexture.size().height; ++y) {
    for (int x = 0; x < idTexture.size().width; ++x) {
      const auto i = static_cast<std::size_t>(y * idTexture.size().width + x);
      if (ids[i] >> kTriangleBits != object) continue;
      extent = {std::min(extent.left, x), std::max(extent.right, x + 1), std::min(extent.top, y),
                std::max(extent.bottom, y + 1)};
    }
  }
  return extent;
}

class ArFrameTest : public SceneGlTest {
 protected:
  /// A flat box 0.2 m to the tag's right and 0.1 m above it, 0.1 × 0.06 m.
  static Scene signPost(std::optional<int> tagId) {
    Scene scene;
    scene.tags.push_back({.id = 4, .edgeMetres = 0.1});
    scene.models.push_back(placed(BoxSource{{0.1, 0.06, 0.001}}, tagId));
    scene.models[0].attachFromModel = glm::translate(glm::dmat4(1.0), {0.2, 0.1, 0.0});
    return scene;
  }
};

// an upright tag seen from the front has no rotation in tracking's frame
const glm::dmat4 kOneMetreAhead = glm::translate(glm::dmat4(1.0), {0.0, 0.0, 1.0});
// the nearer face is at 0.999 m: 80 + 200 · 0.15 / 0.999 = 110.03, and so on
constexpr Extent kRightAndUp{110, 130, 34, 46};

TEST_F(ArFrameTest, AttachesToATagAsItsAuthorSeesIt) {
  ArFrameRenderer renderer(library_, signPost(4));
  const gpu::Texture picture = plainPicture(kSize);
  const std::array sightings{TagSighting{.id = 4, .cameraFromTag = kOneMetreAhead}};
  const ArFrame& frame = compose(renderer, picture, plainCamera(), {.tags = sightings});
  EXPECT_EQ(extentOf(*frame.ids, 1), kRightAndUp);
  EXPECT_EQ(frame.sequence, 7u);
  EXPECT_EQ(frame.captureTime, hal::TimePoint(hal::Duration(9)));
  EXPECT_EQ(frame.size(), kSize);
}

TEST_F(ArFrameTest, AFocusGoesWithItsTagAndStaysWhereItWasLast) {
  Scene scene = signPost(4);
  scene.foci.push_back({.tagId = 4,
                        .attachFromCentre = {0.2, 0.1, 0.0},
                        .radiusMetres = 0.05,
                        .falloffMetres = 0.1,
                        .strength = 0.5});
  ArFrameRenderer renderer(library_, scene);
  const gpu::Texture picture = plainPicture(kSize);
  EXPECT_TRUE(compose(renderer, picture, plainCamera(), {}).foci.empty()) << "never seen";
  const std::array sightings{TagSighting{.id = 4, .cameraFromTag = kOneMetreAhead}};
  const auto expectPlace = [](const ArFrame& frame) {
    ASSERT_EQ(frame.foci.size(), 1U);
    EXPECT_NEAR(frame.foci[0].px.x, 80.0F + 200.0F * 0.2F, 1e-3F);
    EXPECT_NEAR(frame.foci[0].px.y, 60.0F - 200.0F * 0.1F, 1e-3F);
    EXPECT_NEAR(frame.foci[0].radiusPx, 10.0F, 1e-3F);
    EXPECT_NEAR(frame.foci[0].falloffPx, 20.0F, 1e-3F);
    EXPECT_EQ(frame.foci[0].strength, 0.5F);
  };
  expectPlace(compose(renderer, picture, plainCamera(), {.tags = sightings}));
  expectPlace(compose(renderer, picture, plainCamera(), {}));
  renderer.reset();
  EXPECT_TRUE(compose(renderer, picture, plainCamera(), {}).foci.empty()) << "forgotten";
}

TEST_F(ArFrameTest, FindsAHiddenTagWhereTheWorldHasIt) {
  Scene scene = signPost(4);
  // the world's origin is 0.3 m left of the tag
  scene.tags[0].worldFromTag = glm::translate(glm::dmat4(1.0), {0.3, 0.0, 0.0}) * kAttachFromTag;
  ArFrameRenderer renderer(library_, scene);
  const gpu::Texture picture = plainPicture(kSize);
  const glm::dmat4 cameraFromWorld =
      glm::translate(glm::dmat4(1.0), {-0.3, 0.0, 1.0}) * kTagFromAttach;
  const ArFrame& hidden =
      compose(renderer, picture, plainCamera(), {.cameraFromWorld = cameraFromWorld});
  EXPECT_EQ(extentOf(*hidden.ids, 1), kRightAndUp);
  // a tag that is seen counts with its own pose: someone has moved it
  const glm::dmat4 elsewhere = glm::translate(glm::dmat4(1.0), {0.1, 0.2, 1.0});
  const std::array sightings{TagSighting{.id = 4, .cameraFromTag = elsewhere}};
  const ArFrame& seen = compose(renderer, picture, plainCamera(),
                                {.cameraFromWorld = cameraFromWorld, .tags = sightings});
  const Extent moved = extentOf(*seen.ids, 1);
  EXPECT_EQ(moved.left, kRightAndUp.left + 20);
  EXPECT_EQ(moved.top, kRightAndUp.top + 40);
}

TEST_F(ArFrameTest, AttachesToTheWorld) {
  ArFrameRenderer renderer(library_, signPost(std::nullopt));
  const gpu::Texture picture = plainPicture(kSize);
  const ArFrame& frame = compose(renderer, picture, plainCamera(),
                                 {.cameraFromWorld = kOneMetreAhead * kTagFromAttach});
  EXPECT_EQ(extentOf(*frame.ids, 1), kRightAndUp);
}

TEST_F(ArFrameTest, HandsOutTheCameraPictureItselfWhereNoModelIsSeen) {
  ArFrameRenderer renderer(library_, signPost(4));
  const gpu::Texture picture = plainPicture(kSize);
  const std::array sightings{TagSighting{.id = 4, .cameraFromTag = kOneMetreAhead}};
  compose(renderer, picture, plainCamera(), {.tags = sightings});
  const ArFrame& frame = compose(renderer, picture, plainCamera(), {});
  EXPECT_EQ(frame.colour, &picture);
  EXPECT_THAT(readR32ui(*frame.ids), testing::Each(0u));
  EXPECT_THAT(readDepth(*frame.depth), testing::Each(1.0F));
  hal::Image normals = readRgba8(*frame.normalFocus);
  EXPECT_TRUE(std::ranges::equal(normals.plane(0).first(4), std::array{128, 128, 128, 0}));
  EXPECT_LT(frame.nearMetres, frame.farMetres);
}

TEST_F(ArFrameTest, NeedsNoModels) {
  ArFrameRenderer renderer(library_, Scene{});
  renderer.warmUp({1, 1});
  const gpu::Texture picture = plainPicture({1, 1});
  const ArFrame& frame = compose(renderer, picture, assumedCamera({1, 1}), {});
  EXPECT_EQ(frame.colour, &picture);
  EXPECT_EQ(readR32ui(*frame.ids), std::vector{0u});
  EXPECT_EQ(frame.normalFocus->size(), (hal::FrameSize{1, 1}));
}

/// Three textures of the picture's size would take 12 bytes a pixel.
TEST_F(ArFrameTest, WithoutModelsItsSurfacesAreASingleTexel) {
  ArFrameRenderer renderer(library_, Scene{});
  const gpu::Texture picture = plainPicture(kSize);
  const ArFrame& frame = compose(renderer, picture, plainCamera(), {});
  constexpr hal::FrameSize kTexel{1, 1};
  EXPECT_EQ(frame.colour->size(), kSize);
  EXPECT_EQ(frame.ids->size(), kTexel);
  EXPECT_EQ(frame.depth->size(), kTexel);
  EXPECT_EQ(frame.normalFocus->size(), kTexel);
  EXPECT_THAT(readR32ui(*frame.ids), testing::Each(0u));
  EXPECT_EQ(renderer.snapshot().size(), kSize);
}

TEST_F(ArFrameTest, DrawsModelsOntoASinglePixel) {
  ArFrameRenderer renderer(library_, signPost(std::nullopt));
  const gpu::Texture picture = plainPicture({1, 1});
  const glm::dmat4 ahead = glm::translate(glm::dmat4(1.0), {-0.2, 0.1, 0.5}) * kTagFromAttach;
  const ArFrame& frame =
      compose(renderer, picture, assumedCamera({1, 1}), {.cameraFromWorld = ahead});
  // the pixel sees ±0.29 m of that plane, and the box at its centre
  EXPECT_EQ(readR32ui(*frame.ids)[0] >> kTriangleBits, 1u);
}

TEST_F(ArFrameTest, FollowsTheSizeOfThePicture) {
  ArFrameRenderer renderer(library_, signPost(4));
  renderer.warmUp({64, 64});
  const std::array sightings{TagSighting{.id = 4, .cameraFromTag = kOneMetreAhead}};
  const gpu::Texture picture = plainPicture(kSize);
  EXPECT_EQ(compose(renderer, picture, plainCamera(), {.tags = sightings}).size(), kSize);
  const hal::FrameSize half{80, 60};
  const gpu::Texture small = plainPicture(half);
  const ArFrame& frame =
      compose(renderer, small, fittedCamera(plainCamera(), half), {.tags = sightings});
  EXPECT_EQ(frame.ids->size(), half);
  EXPECT_EQ(extentOf(*frame.ids, 1), (Extent{55, 65, 17, 23}));
}

TEST_F(ArFrameTest, DrawsNothingOfWhatIsBehindTheCamera) {
  ArFrameRenderer renderer(library_, signPost(std::nullopt));
  const gpu::Texture picture = plainPicture(kSize);
  const glm::dmat4 behind = glm::translate(glm::dmat4(1.0), {-0.2, 0.1, -1.0});
  EXPECT_EQ(compose(renderer, picture, plainCamera(), {.cameraFromWorld = behind}).colour,
            &picture);
}

TEST_F(ArFrameTest, CutsWhatReachesBehindTheCameraAtTheHorizon) {
  // a floor 1 m below the camera, 40 m in front of and behind it, under lenses that fold far
  // outside
  for (const double k1 : {0.0, -0.3, 0.3}) {
    Scene scene;
    scene.models.push_back(placed(BoxSource{{80.0, 80.0, 0.01}}));
    ArFrameRenderer renderer(library_, scene);
    const gpu::Texture picture = plainPicture(kSize);
    const glm::dmat4 below = glm::translate(glm::dmat4(1.0), {0.0, 1.01, 0.0}) *
                             glm::rotate(glm::dmat4(1.0), glm::radians(90.0), {1.0, 0.0, 0.0});
    const tracking::CameraModel camera({.fx = 200.0, .fy = 200.0, .cx = 80.0, .cy = 60.0},
                                       {.k1 = k1}, kSize);
    const ArFrame& frame = compose(renderer, picture, camera, {.cameraFromWorld = below});
    const auto ids = readR32ui(*frame.ids);
    for (int y = 0; y < kSize.height; ++y) {
      const auto row = static_cast<std::size_t>(y * kSize.width);
      for (std::size_t x = 0; x < 160; ++x) {
        if (y < 60) {
          ASSERT_EQ(ids[row + x], 0u) << k1 << ": " << x << "," << y;
        } else if (y > 68) {  // the far edge is at 60 + 200 / 40
          ASSERT_EQ(ids[row + x] >> kTriangleBits, 1u) << k1 << ": " << x << "," << y;
        }
      }
    }
  }
}

TEST_F(ArFrameTest, DoesNotFoldWhatIsFarAsideIntoThePicture) {
  // at 62° off the axis the polynomial gives x = -0.158, which is column 48
  Scene scene;
  scene.models.push_back(placed(BoxSource{{0.1, 0.1, 0.1}}));
  ArFrameRenderer renderer(library_, scene);
  const gpu::Texture picture = plainPicture(kSize);
  const tracking::CameraModel camera({.fx = 200.0, .fy = 200.0, .cx = 80.0, .cy = 60.0},
                                     {.k1 = -0.3}, kSize);
  EXPECT_NEAR(camera.project({1.9, 0.0, 1.0}).x, 48.0, 1.0);
  const ArFrame& frame =
      compose(renderer, picture, camera,
              {.cameraFromWorld = glm::translate(glm::dmat4(1.0), {1.9, 0.0, 1.0})});
  EXPECT_EQ(frame.colour->size(), kSize);
  EXPECT_THAT(readR32ui(*frame.ids), testing::Each(0u));
}

TEST_F(ArFrameTest, LightsFromWhereTheSceneSays) {
  Scene scene = signPost(4);
  scene.models[0].attachFromModel = glm::dmat4(1.0);
  scene.models[0].srgb = {1.0F, 1.0F, 1.0F};
  const gpu::Texture picture = plainPicture(kSize);
  const std::array sightings{TagSighting{
      .id = 4, .cameraFromTag = glm::rotate(kOneMetreAhead, glm::radians(60.0), {0.0, 1.0, 0.0})}};
  const auto centreRed = [&](const Light& light) {
    scene.light = light;
    ArFrameRenderer renderer(library_, scene);
    const ArFrame& frame = compose(renderer, picture, plainCamera(), {.tags = sightings});
    hal::Image colour = readRgba8(*frame.colour);
    return int{colour.row(0, 60)[80 * 4]};
  };
  // the face is turned by 60° from the viewer, to the left
  EXPECT_EQ(centreRed({Light::Frame::kCamera, {0.0, 0.0, 1.0}}), 102);
  EXPECT_EQ(centreRed({Light::Frame::kCamera, {-1.0, 0.0, 0.0}}), 255);
  EXPECT_NEAR(centreRed({Light::Frame::kCamera, {1.0, 0.0, 0.0}}), 25.5, 0.5);
  EXPECT_EQ(centreRed({Light::Frame::kAttached, {0.0, 0.0, 1.0}}), 255);
  EXPECT_NEAR(centreRed({Light::Frame::kAttached, {1.0, 0.0, 0.0}}), 25.5, 0.5);
}

}  // namespace
}  // namespace pleinair::scene
