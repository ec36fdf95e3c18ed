// Compares drawn materials, textures and parts with the CPU rasteriser and plain arithmetic.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "pipeline/scene/builtin/builtin_box.h"
#include "tests/gpu/scene/scene_gl_test.h"
#include "tests/oracles/raster_oracle.h"
#include "tests/oracles/texture_oracle.h"

namespace pleinair::scene {
namespace {

constexpr hal::FrameSize kSize{160, 120};

tracking::CameraModel camera() {
  return {{.fx = 200.0, .fy = 200.0, .cx = 80.0, .cy = 60.0}, {}, kSize};
}

/// 0.4 m in front of the camera, tilted.
glm::dmat4 aslant() {
  return glm::rotate(glm::translate(glm::dmat4(1.0), {0.01, 0.0, 0.4}), 0.7, {0.9, 0.3, 0.1});
}

/// A square of 0.2 m in z = 0 that faces −z, with its texture repeated `times` times.
Mesh square(float times = 1.0F) {
  Mesh mesh;
  for (const glm::vec2& at : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)}) {
    mesh.vertices.push_back({.position = glm::vec3(0.2F * (at - 0.5F), 0.0F),
                             .normal = {0.0F, 0.0F, -1.0F},
                             .texture = times * (at - 0.25F)});
  }
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  return mesh;
}

/// An image whose texels are all different.
std::shared_ptr<const hal::Image> motley(hal::FrameSize size) {
  auto image = std::make_shared<hal::Image>(
      hal::FrameFormat{.pixelFormat = hal::PixelFormat::kRgba8, .size = size});
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const auto row = image->row(0, y);
      const auto i = static_cast<std::size_t>(4 * x);
      row[i] = static_cast<std::uint8_t>(20 + (53 * x + 17 * y) % 230);
      row[i + 1] = static_cast<std::uint8_t>(255 * ((x + y) % 2));
      row[i + 2] = static_cast<std::uint8_t>((29 * x * y + 90 * y) % 256);
      row[i + 3] = static_cast<std::uint8_t>(x < size.width / 2 ? 255 : 40);
    }
  }
  return image;
}

class ModelDrawing : public SceneGlTest {
 protected:
  /// A scene lit from the camera: surfaces that face it are in the brightest band.
  static Scene sceneOf(Model model) {
    Scene scene;
    SceneModel placed;
    placed.model = std::make_shared<const Model>(std::move(model));
    placed.srgb = {1.0F, 1.0F, 1.0F};
    scene.models.push_back(std::move(placed));
    scene.light = {Light::Frame::kCamera, {0.0, 0.0, 1.0}};
    return scene;
  }
  struct Drawn {
    hal::Image colour;
    std::vector<std::uint32_t> ids;
    hal::Image normals;
    glm::ivec3 rgbAt(int x, int y) {
      const auto p = colour.row(0, y).subspan(static_cast<std::size_t>(4 * x), 3);
      return {p[0], p[1], p[2]};
    }
  };
  Drawn draw(const Scene& scene, const glm::dmat4& cameraFromWorld,
             hal::Duration after = hal::Duration::zero()) {
    ArFrameRenderer renderer(library_, scene);
    const gpu::Texture picture = plainPicture(kSize);
    const hal::TimePoint first(hal::Duration(5'000));
    renderer.compose(picture, camera(), {.cameraFromWorld = cameraFromWorld}, 1, first);
    const ArFrame& frame =
        renderer.compose(picture, camera(), {.cameraFromWorld = cameraFromWorld}, 2, first + after);
    return {support::readRgba8(*frame.colour), support::readR32ui(*frame.ids),
            support::readRgba8(*frame.normalFocus)};
  }
};

class ModelTextures : public ModelDrawing,
                      public testing::WithParamInterface<std::pair<TextureEdge, TextureEdge>> {};

TEST_P(ModelTextures, AreSampledLinearlyInLinearLight) {
  // 5 × 3 texels over the square, repeated more than twice: magnified, with every edge in view
  Model model = singlePartModel("square", square(2.3F));
  model.textures.push_back(
      {.picture = motley({5, 3}), .across = GetParam().first, .down = GetParam().second});
  model.materials[0].texture = 0;
  model.materials[0].baseColour = {0.9F, 0.6F, 0.8F, 1.0F};
  model.surfaces[0].mesh.vertices[2].colour = {0.3F, 1.0F, 0.5F, 1.0F};
  const Scene scene = sceneOf(model);
  Drawn drawn = draw(scene, aslant());
  const oracles::PlacedMesh placed{&scene.models[0].model->surfaces[0].mesh, aslant()};
  const auto expected = oracles::rasterise({&placed, 1}, camera());
  int judged = 0;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const oracles::RasterPixel& pixel = expected[static_cast<std::size_t>(y * kSize.width + x)];
      if (pixel.id == 0 || pixel.edgeDistancePx < 0.02) continue;
      ++judged;
      const glm::dvec3 linear = oracles::sampleLinear(model.textures[0], pixel.texture) *
                                glm::dvec3(pixel.colour) *
                                glm::dvec3(model.materials[0].baseColour);
      const glm::ivec3 seen = drawn.rgbAt(x, y);
      for (int c = 0; c < 3; ++c) {
        // With 8 bits below the texel, the least that GL allows, samples are off by up to a 256th
        // of a step between texels, across and down, which sRGB enlarges in the dark by the slope
        // of its code; and the result is rounded.
        const double slope = 255.0 * 1.055 / 2.4 * std::pow(linear[c], 1.0 / 2.4 - 1.0);
        const double tolerance = std::clamp(0.51 + slope / 128.0, 2.5, 8.0);
        ASSERT_NEAR(seen[c], 255.0 * oracles::srgbOf(linear[c]), tolerance) << x << ',' << y;
      }
    }
  }
  EXPECT_GT(judged, 4000);
}

INSTANTIATE_TEST_SUITE_P(Edges, ModelTextures,
                         testing::Values(std::pair(TextureEdge::kRepeat, TextureEdge::kClamp),
                                         std::pair(TextureEdge::kMirror, TextureEdge::kRepeat),
                                         std::pair(TextureEdge::kClamp, TextureEdge::kMirror)));

TEST_F(ModelDrawing, ShowsFarTexturesAsTheirMeanLight) {
  // a checkerboard of black and white, far finer than pixels
  Model model = singlePartModel("square", square(40.0F));
  hal::Image checks({.pixelFormat = hal::PixelFormat::kRgba8, .size = {64, 64}});
  for (std::size_t i = 0; i < 64 * 64; ++i) {
    const auto value = static_cast<std::uint8_t>((i + i / 64) % 2 == 0 ? 0 : 255);
    std::ranges::fill(checks.plane(0).subspan(4 * i, 4), value);
  }
  model.textures.push_back({.picture = std::make_shared<const hal::Image>(checks)});
  model.materials[0].texture = 0;
  Drawn drawn = draw(sceneOf(model), glm::translate(glm::dmat4(1.0), {0.0, 0.0, 0.6}));
  for (int x = 60; x < 100; ++x) {
    EXPECT_NEAR(drawn.rgbAt(x, 60).x, 188, 2) << x;  // half the light, not half the code
  }
}

TEST_F(ModelDrawing, LeavesHolesWhereCoverageIsLow) {
  Model model = singlePartModel("square", square());
  for (MeshVertex& vertex : model.surfaces[0].mesh.vertices) vertex.texture += 0.25F;
  model.textures.push_back({.picture = motley({2, 2}), .across = TextureEdge::kClamp});
  model.materials[0].texture = 0;
  model.materials[0].coverageCutoff = 0.5F;
  const glm::dmat4 ahead = glm::translate(glm::dmat4(1.0), {0.0, 0.0, 0.4});
  Drawn drawn = draw(sceneOf(model), ahead);
  EXPECT_NE(drawn.ids[60 * 160 + 50], 0u);
  EXPECT_EQ(drawn.ids[60 * 160 + 110], 0u);
  EXPECT_EQ(drawn.rgbAt(110, 60), glm::ivec3(kGround[0], kGround[1], kGround[2]));
  model.materials[0].coverageCutoff = 0.0F;
  EXPECT_NE(draw(sceneOf(model), ahead).ids[60 * 160 + 110], 0u);
}

TEST_F(ModelDrawing, ShowsDoubleSidedSurfacesFromBehindWithTheirNormalsTurned) {
  Model model = singlePartModel("square", square());
  const glm::dmat4 behind = glm::rotate(glm::translate(glm::dmat4(1.0), {0.0, 0.0, 0.4}),
                                        std::numbers::pi, {0.0, 1.0, 0.0});
  EXPECT_EQ(draw(sceneOf(model), behind).ids[60 * 160 + 80], 0u);
  model.materials[0].isDoubleSided = true;
  Drawn drawn = draw(sceneOf(model), behind);
  EXPECT_NE(drawn.ids[60 * 160 + 80], 0u);
  EXPECT_EQ(drawn.rgbAt(80, 60), glm::ivec3(255));
  EXPECT_LE(drawn.normals.row(0, 60)[4 * 80 + 2], 1);  // faces the camera
}

TEST_F(ModelDrawing, TurnsMirroredAndFlattenedPartsTheRightWayOut) {
  for (const glm::dvec3& scale : {glm::dvec3(-1.0, 1.0, 1.0), glm::dvec3(1.0, 1.0, -1.0),
                                  glm::dvec3(1.0, 1.0, 1e-9), glm::dvec3(2.0, 0.5, 1.0)}) {
    Model model = singlePartModel("box", boxMesh({0.1, 0.1, 0.1}));
    model.parts[0].modelFromPart = glm::scale(glm::dmat4(1.0), scale);
    // its upper face towards the camera
    const glm::dmat4 above = glm::rotate(glm::translate(glm::dmat4(1.0), {0.0, 0.0, 0.4}),
                                         std::numbers::pi, {1.0, 0.0, 0.0});
    Drawn drawn = draw(sceneOf(model), above);
    ASSERT_NE(drawn.ids[60 * 160 + 80], 0u) << scale.x << ' ' << scale.z;
    EXPECT_EQ(drawn.rgbAt(80, 60), glm::ivec3(255)) << scale.x << ' ' << scale.z;
  }
}

TEST_F(ModelDrawing, TurnsPartsByCaptureTime) {
  Model turning = singlePartModel("box", boxMesh({0.2, 0.05, 0.03}));
  turning.parts[0].radiansPerSecond = 2.0 * std::numbers::pi;
  Model turned = turning;
  turned.parts[0].radiansPerSecond = 0.0;
  turned.parts[0].modelFromPart = glm::rotate(glm::dmat4(1.0), 0.2 * std::numbers::pi, {0, 0, 1});
  const auto after = std::chrono::milliseconds(100);
  const Drawn moving = draw(sceneOf(turning), aslant(), after);
  EXPECT_EQ(moving.ids, draw(sceneOf(turned), aslant()).ids);
  EXPECT_EQ(draw(sceneOf(turning), aslant()).ids,
            draw(sceneOf(turning), aslant(), std::chrono::seconds(3)).ids);
  EXPECT_NE(moving.ids, draw(sceneOf(turning), aslant()).ids);
  EXPECT_EQ(moving.ids, draw(sceneOf(turning), aslant(), after).ids);  // the same again
}

TEST_F(ModelDrawing, TimeStartsAgainAfterAReset) {
  Model turning = singlePartModel("box", boxMesh({0.2, 0.05, 0.03}));
  turning.parts[0].radiansPerSecond = 2.0 * std::numbers::pi;
  ArFrameRenderer renderer(library_, sceneOf(turning));
  const gpu::Texture picture = plainPicture(kSize);
  const auto idsAt = [&](hal::Duration time) {
    return support::readR32ui(
        *renderer.compose(picture, camera(), {.cameraFromWorld = aslant()}, 1, hal::TimePoint(time))
             .ids);
  };
  const auto first = idsAt(std::chrono::seconds(5));
  EXPECT_NE(idsAt(std::chrono::milliseconds(5100)), first);
  renderer.reset();
  EXPECT_EQ(idsAt(std::chrono::milliseconds(5100)), first);
}

TEST_F(ModelDrawing, NumbersTrianglesByPart) {
  // two adjacent parts share a surface
  Model model = singlePartModel("left", boxMesh({0.05, 0.05, 0.05}));
  model.parts[0].modelFromPart = glm::translate(glm::dmat4(1.0), {-0.08, 0.0, 0.0});
  model.parts.push_back(model.parts[0]);
  model.parts[1].name = "right";
  model.parts[1].modelFromPart = glm::translate(glm::dmat4(1.0), {0.08, 0.0, 0.0});
  numberParts(model);
  const Drawn drawn = draw(sceneOf(model), glm::translate(glm::dmat4(1.0), {0.0, 0.0, 0.4}));
  const auto partAt = [&](std::size_t x) {
    return partOfTriangle(model, drawn.ids[60 * 160 + x] & (kMaxTriangles - 1))->name;
  };
  EXPECT_EQ(partAt(40), "left");
  EXPECT_EQ(partAt(120), "right");
}

TEST_F(ModelDrawing, TakesModelsWithNothingInThem) {
  Drawn drawn = draw(sceneOf(Model{}), aslant());
  EXPECT_THAT(drawn.ids, testing::Each(0u));
}

}  // namespace
}  // namespace pleinair::scene
