// Compares shadows on a plane with rays cast on the CPU.
#include <algorithm>
#include <array>
#include <cmath>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "tests/gpu/scene/scene_gl_test.h"

namespace pleinair::scene {
namespace {

constexpr hal::FrameSize kSize{320, 240};
constexpr double kFocal = 400.0;
constexpr double kSoftness = 0.13;  // as in contact_shadow.cpp
constexpr int kTag = 4;
constexpr glm::dvec3 kBox{0.06, 0.06, 0.05};
constexpr double kTexel = 0.0015;  // of the map for that box, m

tracking::CameraModel camera() {
  return {{.fx = kFocal, .fy = kFocal, .cx = 160.0, .cy = 120.0}, {}, kSize};
}

/// A camera one metre straight above.
const glm::dmat4 kAbove = glm::translate(glm::dmat4(1.0), {0.0, 0.0, 1.0});

/// All of the plane's light comes from the key light.
Lighting keyAlone(const glm::vec3& toward) {
  const glm::vec3 unit = glm::normalize(toward);
  return {.towardKey = unit,
          .key = glm::vec3(1.0F / unit.z),
          .sky = glm::vec3(0.0F),
          .ground = glm::vec3(0.0F),
          .white = glm::vec3(1.0F)};
}

Lighting skyAlone() {
  return {.key = glm::vec3(0.0F), .sky = glm::vec3(1.0F), .white = glm::vec3(1.0F)};
}

/// The share of a light with a tent profile that the box blocks at a point of the plane.
double keptOff(const glm::dvec2& at, const glm::dvec2& shear) {
  constexpr int kRays = 24, kHeights = 60;
  const auto tentPoint = [](int i) {  // evenly spaced in probability
    const double u = (i + 0.5) / kRays;
    return u < 0.5 ? std::sqrt(2.0 * u) - 1.0 : 1.0 - std::sqrt(2.0 * (1.0 - u));
  };
  const auto isBlocked = [&](const glm::dvec2& spread) {
    for (int k = 0; k < kHeights; ++k) {
      const double height = kBox.z * (k + 0.5) / kHeights;
      const glm::dvec2 on = at - height * (shear + kSoftness * spread);
      if (std::abs(on.x) < 0.5 * kBox.x && std::abs(on.y) < 0.5 * kBox.y) return true;
    }
    return false;
  };
  int blocked = 0;
  for (int i = 0; i < kRays; ++i) {
    for (int j = 0; j < kRays; ++j) {
      if (isBlocked({tentPoint(i), tentPoint(j)})) ++blocked;
    }
  }
  return static_cast<double>(blocked) / (kRays * kRays);
}

class ContactShadowTest : public SceneGlTest {
 protected:
  static Scene boxOnTag() {
    Scene scene;
    scene.tags.push_back({.id = kTag, .edgeMetres = 0.1});
    scene.models.push_back(placed(BoxSource{kBox}, kTag));
    scene.light.shadow = 1.0F;
    return scene;
  }
  static gpu::Texture whitePicture() {
    hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = kSize});
    std::ranges::fill(image.plane(0), std::uint8_t{255});
    return support::textureOf(image.view());
  }
  const ArFrame& drawn(ArFrameRenderer& renderer, const Lighting& light,
                       const glm::dmat4& cameraFromTag = kAbove) {
    const std::array sightings{TagSighting{.id = kTag, .cameraFromTag = cameraFromTag}};
    const std::array lights{PlaceLighting{.tagId = kTag, .light = light}};
    return renderer.compose(white_, camera(), {.tags = sightings}, 1, hal::TimePoint{}, {}, lights);
  }
  /// A composed image.
  struct Shown {
    hal::Image colour;
    std::vector<std::uint32_t> ids;

    explicit Shown(const ArFrame& frame)
        : colour(support::readRgba8(*frame.colour)), ids(support::readR32ui(*frame.ids)) {}
    bool isCamera(const glm::ivec2& px) const {
      return ids[static_cast<std::size_t>(px.y * kSize.width + px.x)] == 0;
    }
    /// The blocked share of the light.
    double missing(const glm::ivec2& px) {
      const double coded = colour.row(0, px.y)[static_cast<std::size_t>(4 * px.x)] / 255.0;
      return 1.0 - std::pow(coded, 2.2);
    }
  };
  /// At a point of the plane, seen from above.
  static glm::ivec2 pixelAbove(const glm::dvec2& at) {
    return {static_cast<int>(160.0 + kFocal * at.x), static_cast<int>(120.0 - kFocal * at.y)};
  }
  static glm::dvec2 pointBelow(const glm::ivec2& px) {
    return {(px.x + 0.5 - 160.0) / kFocal, (120.0 - px.y - 0.5) / kFocal};
  }

  void SetUp() override {
    SceneGlTest::SetUp();
    if (!IsSkipped()) white_ = whitePicture();
  }
  gpu::Texture white_;
};

TEST_F(ContactShadowTest, KeepsOffTheLightThatRaysMeet) {
  for (const glm::vec3& toward :
       {glm::vec3(-1, 0, 1), glm::vec3(0.5F, 0.7F, 1.0F), glm::vec3(0, 0, 1)}) {
    ArFrameRenderer renderer(library_, boxOnTag());
    Shown shown(drawn(renderer, keyAlone(toward)));
    const glm::dvec2 shear = -glm::dvec2(toward) / double{toward.z};
    double sum = 0.0, largest = 0.0;
    int count = 0;
    for (int y = 80; y < 160; y += 3) {
      for (int x = 120; x < 200; x += 3) {
        if (!shown.isCamera({x, y})) continue;
        const double error = std::abs(shown.missing({x, y}) - keptOff(pointBelow({x, y}), shear));
        sum += error;
        largest = std::max(largest, error);
        ++count;
      }
    }
    ASSERT_GT(count, 200);
    EXPECT_LT(sum / count, 0.03) << toward.x;
    EXPECT_LT(largest, 0.3) << toward.x;
  }
}

/// Half dark at the shadow of the top's far edge, and sharper close to the box.
TEST_F(ContactShadowTest, PenumbraeLieAtTheEdgeAndGrowWithHeight) {
  ArFrameRenderer renderer(library_, boxOnTag());
  Shown shown(drawn(renderer, keyAlone({-1, 0, 1})));
  const auto widthAndMiddle = [&](const glm::dvec2& from, const glm::dvec2& step) {
    double first = -1.0, half = -1.0;
    for (int i = 0; i < 60; ++i) {
      const double missing = shown.missing(pixelAbove(from + (i + 0.5) * step));
      if (first < 0.0 && missing < 0.85) first = i;
      if (half < 0.0 && missing < 0.5) half = i;
      if (missing < 0.15) return std::pair((i - first) * glm::length(step), half);
    }
    return std::pair(1e9, -1.0);
  };
  const double px = 1.0 / kFocal;
  const auto [farWidth, farHalf] = widthAndMiddle({0.045, 0.0}, {px, 0.0});
  EXPECT_NEAR(0.045 + farHalf * px, 0.03 + kBox.z, 2.0 * kTexel + px);
  // Close to the box's foot the caster is low; at the shadow's end it is high.
  const auto [nearWidth, nearHalf] = widthAndMiddle({0.034, 0.0}, {0.0, px});
  const auto [highWidth, highHalf] = widthAndMiddle({0.07, 0.0}, {0.0, px});
  EXPECT_NEAR(highHalf * px, 0.03, 2.0 * kTexel + px);
  EXPECT_LT(nearWidth, highWidth);
}

TEST_F(ContactShadowTest, AmbientLightIsKeptOffCloseToTheFoot) {
  ArFrameRenderer renderer(library_, boxOnTag());
  Shown shown(drawn(renderer, skyAlone()));
  const double beside = shown.missing(pixelAbove({0.034, 0.0}));
  EXPECT_GT(beside, 0.15);
  EXPECT_LT(beside, 0.6);
  EXPECT_LT(shown.missing(pixelAbove({0.042, 0.0})), beside);
  EXPECT_LT(shown.missing(pixelAbove({0.075, 0.0})), 0.01);
  EXPECT_NEAR(shown.missing(pixelAbove({-0.034, 0.0})), beside, 0.06) << "from all sides";
}

TEST_F(ContactShadowTest, KeepsStillAndGoesWithThePlane) {
  ArFrameRenderer renderer(library_, boxOnTag());
  const Lighting light = keyAlone({-1, 0.2F, 1});
  Shown first(drawn(renderer, light));
  Shown second(drawn(renderer, light));
  EXPECT_TRUE(std::ranges::equal(first.colour.plane(0), second.colour.plane(0)));

  // A camera that moved by 16 px sees the same shadow there.
  const glm::dmat4 moved = glm::translate(kAbove, {16.0 / kFocal, 0.0, 0.0});
  Shown third(drawn(renderer, light, moved));
  for (int y = 90; y < 150; y += 7) {
    for (int x = 176; x < 215; x += 3) {
      if (!first.isCamera({x, y}) || !third.isCamera({x + 16, y})) continue;
      EXPECT_NEAR(third.missing({x + 16, y}), first.missing({x, y}), 0.012) << x << ',' << y;
    }
  }
}

/// The map's position stays while it fits; after a reset, no earlier position counts.
TEST_F(ContactShadowTest, ResetForgetsWhereItsMapWas) {
  const Lighting before = keyAlone({-0.8F, 0.1F, 1});
  const Lighting light = keyAlone({-0.6F, 0, 1});
  ArFrameRenderer fresh(library_, boxOnTag());
  Shown first(drawn(fresh, light));
  ArFrameRenderer renderer(library_, boxOnTag());
  drawn(renderer, before);
  Shown kept(drawn(renderer, light));
  EXPECT_FALSE(std::ranges::equal(kept.colour.plane(0), first.colour.plane(0)));
  renderer.reset();
  Shown again(drawn(renderer, light));
  EXPECT_TRUE(std::ranges::equal(again.colour.plane(0), first.colour.plane(0)));
  renderer.warmUp(kSize);
  Shown warm(drawn(renderer, light));
  EXPECT_TRUE(std::ranges::equal(warm.colour.plane(0), first.colour.plane(0)));
}

TEST_F(ContactShadowTest, GoesWithTheLight) {
  ArFrameRenderer renderer(library_, boxOnTag());
  Shown right(drawn(renderer, keyAlone({-1, 0, 1})));
  EXPECT_GT(right.missing(pixelAbove({0.055, 0.0})), 0.9);
  EXPECT_LT(right.missing(pixelAbove({-0.055, 0.0})), 0.01);
  Shown left(drawn(renderer, keyAlone({1, 0, 1})));
  EXPECT_LT(left.missing(pixelAbove({0.055, 0.0})), 0.01);
  EXPECT_GT(left.missing(pixelAbove({-0.055, 0.0})), 0.9);
}

TEST_F(ContactShadowTest, IsNotThereWithoutAModelOrWithoutStrength) {
  Scene scene = boxOnTag();
  scene.light.shadow = 0.0F;
  ArFrameRenderer off(library_, scene);
  Shown shown(drawn(off, keyAlone({-1, 0, 1})));
  EXPECT_EQ(shown.missing(pixelAbove({0.055, 0.0})), 0.0);

  ArFrameRenderer renderer(library_, boxOnTag());
  const ArFrame& none = renderer.compose(white_, camera(), {}, 1, hal::TimePoint{}, {}, {});
  EXPECT_EQ(none.colour, &white_);

  Scene floating = boxOnTag();
  floating.models[0].attachFromModel = glm::translate(glm::dmat4(1.0), {0.0, 0.0, 0.3});
  ArFrameRenderer high(library_, floating);
  Shown far(drawn(high, keyAlone({-1, 0, 1})));
  for (int x = 170; x < 320; x += 10) {
    if (!far.isCamera({x, 120})) continue;
    EXPECT_EQ(far.missing({x, 120}), 0.0) << x;
  }
}

/// A real object hides the shadow behind it; its own shadow is part of the camera image.
TEST_F(ContactShadowTest, OccludersHideItAndCastNone) {
  Scene scene = boxOnTag();
  scene.models.push_back(placed(BoxSource{{0.02, 0.02, 0.02}}, kTag));
  scene.models[1].attachFromModel = glm::translate(glm::dmat4(1.0), {0.055, 0.0, 0.0});
  scene.models[1].isOccluder = true;
  ArFrameRenderer renderer(library_, scene);
  Shown shown(drawn(renderer, keyAlone({-1, 0, 1})));
  EXPECT_EQ(shown.missing(pixelAbove({0.055, 0.0})), 0.0);
  EXPECT_GT(shown.missing(pixelAbove({0.055, 0.02})), 0.8);

  Scene alone = scene;
  alone.models.erase(alone.models.begin());
  ArFrameRenderer occluder(library_, alone);
  Shown none(drawn(occluder, keyAlone({-1, 0, 1})));
  EXPECT_EQ(none.missing(pixelAbove({0.075, 0.0})), 0.0);
}

TEST_F(ContactShadowTest, OfAHiddenPartIsGoneUntilThePartIsBack) {
  Scene scene = boxOnTag();
  auto model = std::make_shared<Model>(*scene.models[0].model);
  model->parts.push_back(model->parts[0]);
  model->parts[1].modelFromPart = glm::translate(glm::dmat4(1.0), {0.0, 0.15, 0.0});
  numberParts(*model);
  scene.models[0].model = model;
  ArFrameRenderer renderer(library_, scene);
  const auto missingAt = [&](const glm::dvec2& place) {
    Shown shown(drawn(renderer, keyAlone({-1, 0, 1})));
    return shown.missing(pixelAbove(place));
  };
  constexpr glm::dvec2 kFirst{0.055, 0.0}, kSecond{0.055, 0.15};
  for (int frame = 0; frame < 3; ++frame) EXPECT_GT(missingAt(kSecond), 0.8);
  renderer.hideParts(0, std::array<std::uint8_t, 2>{0, 1});
  EXPECT_EQ(missingAt(kSecond), 0.0);
  EXPECT_GT(missingAt(kFirst), 0.8);
  renderer.hideParts(0, {});
  EXPECT_GT(missingAt(kSecond), 0.8);
}

TEST_F(ContactShadowTest, LeavesWhatIsKnownOfTheGroundAlone) {
  ArFrameRenderer renderer(library_, boxOnTag());
  const ArFrame& frame = drawn(renderer, keyAlone({-1, 0, 1}));
  const Shown shown(frame);
  EXPECT_TRUE(shown.isCamera(pixelAbove({0.055, 0.0})));
  hal::Image normals = support::readRgba8(*frame.normalFocus);
  const glm::ivec2 px = pixelAbove({0.055, 0.0});
  const auto normal = normals.row(0, px.y).subspan(static_cast<std::size_t>(4 * px.x), 4);
  EXPECT_TRUE(std::ranges::equal(normal, std::array{128, 128, 128, 0}));
  EXPECT_EQ(readDepth(*frame.depth)[static_cast<std::size_t>(px.y * kSize.width + px.x)], 1.0F);
}

}  // namespace
}  // namespace pleinair::scene
