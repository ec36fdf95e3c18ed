// Compares drawn models with a CPU rasteriser: ids, depth, normals and toon bands, per pixel.
#include <cmath>
#include <string>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include "tests/gpu/scene/scene_gl_test.h"
#include "tests/oracles/raster_oracle.h"

namespace pleinair::scene {
namespace {

constexpr hal::FrameSize kSize{200, 150};
constexpr double kEdgePx = 0.02;       // a rasteriser's 8 bits below the pixel, and float vertices
constexpr double kBandMargin = 0.004;  // intensities near the toon shader's thresholds

struct RasterCase {
  std::string name;
  tracking::Distortion distortion;
};

class SceneRaster : public SceneGlTest, public testing::WithParamInterface<RasterCase> {
 protected:
  static tracking::CameraModel camera() {
    return {{.fx = 190.0, .fy = 193.0, .cx = 103.7, .cy = 71.2}, GetParam().distortion, kSize};
  }
};

/// A tilted gear, with boxes in front of it and through it.
Scene mixedScene() {
  Scene scene;
  const auto add = [&](ModelSource source, const glm::dvec3& at, double turnDeg, double scale) {
    SceneModel model;
    model.model =
        std::make_shared<const Model>(withShortEdges(modelOf(source).value(), 0.02, 1'000'000));
    model.source = std::move(source);
    model.attachFromModel = glm::scale(
        glm::rotate(glm::translate(glm::dmat4(1.0), at), glm::radians(turnDeg), {0.3, 0.5, 0.8}),
        glm::dvec3(scale));
    model.srgb = {0.9F, 0.55F, 0.25F};
    model.focus = static_cast<float>(scene.models.size()) / 4.0F;
    scene.models.push_back(std::move(model));
  };
  add(GearSource{}, {0.0, 0.0, 0.0}, 11.0, 1.0);
  add(BoxSource{{0.03, 0.02, 0.05}}, {0.02, -0.03, 0.01}, 35.0, 1.0);
  add(BoxSource{{0.3, 0.2, 0.1}}, {-0.05, 0.03, 0.0}, -70.0, 0.15);
  scene.light.frame = Light::Frame::kCamera;
  scene.light.shadow = 0.0F;  // the background is compared too
  return scene;
}

glm::dmat4 aslant() {
  return glm::rotate(glm::translate(glm::dmat4(1.0), {0.003, 0.004, 0.16}), glm::radians(140.0),
                     {1.0, 0.15, 0.1});
}

TEST_P(SceneRaster, ShowsWhatTheOracleShows) {
  const Scene scene = mixedScene();
  ArFrameRenderer renderer(library_, scene);
  const gpu::Texture picture = plainPicture(kSize);
  const ArFrame& frame = compose(renderer, picture, camera(), {.cameraFromWorld = aslant()});

  std::vector<oracles::PlacedMesh> placed;
  for (const SceneModel& model : scene.models) {
    placed.push_back({&model.model->surfaces[0].mesh, aslant() * model.attachFromModel});
  }
  const auto expected = oracles::rasterise(placed, camera());
  const auto ids = support::readR32ui(*frame.ids);
  const auto depth = readDepth(*frame.depth);
  hal::Image colour = support::readRgba8(*frame.colour);
  hal::Image normalFocus = support::readRgba8(*frame.normalFocus);
  const double near = frame.nearMetres;
  const double far = frame.farMetres;
  const glm::dvec3 light = glm::dvec3(1.0, -1.0, -1.0) * scene.light.towardLight;

  std::array<int, 4> seen{};
  std::array<int, 3> bands{};
  int judged = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const oracles::RasterPixel& pixel = expected[i];
    if (pixel.edgeDistancePx < kEdgePx) continue;
    ++judged;
    const std::string where =
        std::to_string(i % kSize.width) + "," + std::to_string(i / kSize.width);
    ASSERT_EQ(ids[i], pixel.id) << where;
    const std::uint32_t object = pixel.id >> kTriangleBits;
    ++seen[object];
    const auto rgba = colour.plane(0).subspan(4 * i, 4);
    const auto normal = normalFocus.plane(0).subspan(4 * i, 4);
    EXPECT_EQ(rgba[3], 255);
    if (object == 0) {
      EXPECT_EQ(depth[i], 1.0F) << where;
      EXPECT_TRUE(std::ranges::equal(rgba.first(3), kGround)) << where;
      EXPECT_TRUE(std::ranges::equal(normal, std::array{128, 128, 128, 0})) << where;
      continue;
    }
    const double metres =
        2.0 * far * near / (far + near - (2.0 * double{depth[i]} - 1.0) * (far - near));
    EXPECT_NEAR(metres, pixel.depthMetres, 3e-5) << where;
    for (int c = 0; c < 3; ++c) {
      const double coded = 255.0 * (0.5 * pixel.cameraNormal[c] + 0.5);
      EXPECT_NEAR(normal[static_cast<std::size_t>(c)], coded, 1.01) << where;
    }
    // 127.5 may be rounded either way.
    EXPECT_NEAR(normal[3], 255.0F * scene.models[object - 1].focus, 0.51F) << where;
    const double intensity = glm::dot(light, pixel.cameraNormal);
    if (std::abs(intensity - 0.7) < kBandMargin || std::abs(intensity - 0.2) < kBandMargin)
      continue;
    const double band = oracles::toonBand(intensity);
    ++bands[band == 1.0 ? 0 : band == 0.4 ? 1 : 2];
    for (int c = 0; c < 3; ++c) {
      const double coded = 255.0 * band * double{scene.models[object - 1].srgb[c]};
      EXPECT_NEAR(rgba[static_cast<std::size_t>(c)], coded, 0.6) << where;
    }
  }
  // check that the image contains everything
  EXPECT_GT(judged, static_cast<int>(0.85 * static_cast<double>(kSize.pixels())));
  for (const int count : seen) EXPECT_GT(count, 200);
  for (const int count : bands) EXPECT_GT(count, 200);
}

INSTANTIATE_TEST_SUITE_P(
    Lenses, SceneRaster,
    testing::Values(RasterCase{"None", {}}, RasterCase{"Barrel", {.k1 = -0.25, .k2 = 0.05}},
                    RasterCase{"Pincushion", {.k1 = 0.2, .p1 = 0.004, .p2 = -0.003}},
                    RasterCase{
                        "Rational",
                        {.k1 = 0.4, .k2 = -0.1, .k3 = 0.02, .k4 = 0.6, .k5 = 0.1, .k6 = 0.01}}),
    [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace pleinair::scene
