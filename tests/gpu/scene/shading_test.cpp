// Compares shaded models with the equations on the CPU, per pixel.
#include <cmath>
#include <string>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "pipeline/scene/light/linear_image.h"
#include "tests/gpu/scene/scene_gl_test.h"
#include "tests/oracles/raster_oracle.h"
#include "tests/oracles/shading_oracle.h"

namespace pleinair::scene {
namespace {

constexpr hal::FrameSize kSize{160, 120};

class SceneShading : public SceneGlTest {
 protected:
  static tracking::CameraModel camera() {
    return {{.fx = 190.0, .fy = 190.0, .cx = 80.0, .cy = 60.0}, {}, kSize};
  }
  static Scene gear() {
    Scene scene;
    scene.models.push_back(placed(GearSource{}));
    scene.models[0].srgb = {0.9F, 0.55F, 0.25F};
    scene.light.shadow = 0.0F;
    return scene;
  }
  static glm::dmat4 aslant() {
    return glm::rotate(glm::translate(glm::dmat4(1.0), {0.0, 0.0, 0.18}), glm::radians(140.0),
                       {1.0, 0.15, 0.1});
  }
  /// A warm key light and cool ambient light, in the attach frame.
  static Lighting evening() {
    return {.towardKey = glm::normalize(glm::vec3(-0.6F, -0.3F, 0.7F)),
            .key = {0.9F, 0.7F, 0.4F},
            .sky = {0.15F, 0.2F, 0.3F},
            .ground = {0.12F, 0.08F, 0.05F},
            .white = {0.8F, 0.7F, 0.6F}};
  }

  /// The largest error of any channel, in 1/255, and the number of compared pixels.
  std::pair<double, int> judge(Shading shading, const Lighting& attachLight) {
    const Scene scene = gear();
    ArFrameRenderer renderer(library_, scene);
    const gpu::Texture picture = plainPicture(kSize);
    const std::array lights{PlaceLighting{.tagId = std::nullopt, .light = attachLight}};
    const ArFrame& frame =
        renderer.compose(picture, camera(), {.cameraFromWorld = aslant()}, 7,
                         hal::TimePoint(hal::Duration(9)), {.shading = shading}, lights);
    const std::array placedGear{
        oracles::PlacedMesh{&scene.models[0].model->surfaces[0].mesh, aslant()}};
    const auto expected = oracles::rasterise(placedGear, camera());
    const Lighting light = turned(glm::mat3(aslant()), attachLight);
    const glm::dvec3 reflects(linearFromSrgb(scene.models[0].srgb));
    hal::Image colour = support::readRgba8(*frame.colour);
    double largest = 0.0;
    int judged = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const oracles::RasterPixel& pixel = expected[i];
      if (pixel.id == 0 || pixel.edgeDistancePx < 0.02) continue;
      const double facing = oracles::bandIntensity(pixel.cameraNormal, light);
      const bool isThreshold = std::abs(facing - 0.7) < 0.004 || std::abs(facing - 0.2) < 0.004;
      if (shading == Shading::kToon && isThreshold) continue;
      ++judged;
      const auto width = static_cast<std::size_t>(kSize.width);
      const glm::dvec2 px(static_cast<double>(i % width) + 0.5,
                          static_cast<double>(i / width) + 0.5);
      const glm::dvec3 viewer = -glm::normalize(*camera().unproject(px));
      const glm::dvec3 should =
          shading == Shading::kToon
              ? oracles::toonShaded(reflects, pixel.cameraNormal, light)
              : oracles::smoothShaded(reflects, pixel.cameraNormal, viewer, light);
      for (int c = 0; c < 3; ++c) {
        const double is = colour.plane(0)[4 * i + static_cast<std::size_t>(c)];
        largest = std::max(largest, std::abs(is - 255.0 * should[c]));
      }
    }
    return {largest, judged};
  }
};

TEST_F(SceneShading, ToonIsTheOracles) {
  Lighting measured = evening();
  measured.bandsAllLight = true;
  for (const Lighting& light : {Lighting{}, evening(), measured}) {
    const auto [largest, judged] = judge(Shading::kToon, light);
    EXPECT_LT(largest, 0.8);
    EXPECT_GT(judged, 1500);
  }
}

TEST_F(SceneShading, SmoothIsTheOracles) {
  for (const Lighting& light : {Lighting{}, evening()}) {
    const auto [largest, judged] = judge(Shading::kSmooth, light);
    EXPECT_LT(largest, 1.6);
    EXPECT_GT(judged, 1500);
  }
}

/// Negative control: another light gives another image.
TEST_F(SceneShading, DependsOnTheLight) {
  Lighting other = evening();
  other.key.r *= 0.9F;
  const Scene scene = gear();
  ArFrameRenderer renderer(library_, scene);
  const gpu::Texture picture = plainPicture(kSize);
  const auto drawn = [&](const Lighting& light, Shading shading) {
    const std::array lights{PlaceLighting{.tagId = std::nullopt, .light = light}};
    return support::readRgba8(*renderer
                                   .compose(picture, camera(), {.cameraFromWorld = aslant()}, 7,
                                            hal::TimePoint(hal::Duration(9)), {.shading = shading},
                                            lights)
                                   .colour);
  };
  hal::Image smooth = drawn(evening(), Shading::kSmooth);
  hal::Image redder = drawn(other, Shading::kSmooth);
  hal::Image toon = drawn(evening(), Shading::kToon);
  EXPECT_FALSE(std::ranges::equal(smooth.plane(0), redder.plane(0)));
  EXPECT_FALSE(std::ranges::equal(smooth.plane(0), toon.plane(0)));
}

}  // namespace
}  // namespace pleinair::scene
