// Light on each stroke by itself (thesis §4.4), against the CPU.
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "pipeline/gpu/render_target.h"
#include "pipeline/styles/strokes/stroke_drawing.h"
#include "tests/gpu/painterly/strip_fixture.h"
#include "tests/oracles/stroke_oracle.h"

namespace pleinair::styles {
namespace {

constexpr hal::FrameSize kSize{128, 128};
constexpr int kAcross = 16;

/// Full of paint; a texel's height is 2 levels more than the one before it, along or across.
gpu::Texture ramp(bool isAlong) {
  const hal::FrameSize size{4 * kAcross, 4 * kAcross};
  std::vector<std::uint8_t> texels;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      texels.push_back(255);
      texels.push_back(static_cast<std::uint8_t>(isAlong ? 2 * x : 2 * (y % kAcross)));
    }
  }
  gpu::Texture texture(gpu::TextureFormat::kRg8, size, gpu::TextureFilter::kLinear);
  texture.upload(texels, static_cast<std::size_t>(size.width) * 2);
  return texture;
}

class BumpTest : public StripTest {
 protected:
  /// The colour in the middle of a stroke that goes that way through the middle of a picture.
  glm::dvec3 middleOf(glm::vec2 way, bool isMirrored, const gpu::Texture& brush,
                      const StrokeLight& light) {
    const glm::vec2 middle(64.5F);
    LaidStroke stroke = straightStroke(middle - 40.0F * way, middle + 40.0F * way);
    stroke.halfWidth = 14.0F;
    stroke.variant = isMirrored ? 5.0F : 1.0F;
    stroke.paint = glm::vec4(kPaint, 1.0F);
    lay({stroke});
    const gpu::Texture colour(gpu::TextureFormat::kRgba8, kSize);
    const gpu::Texture height(gpu::TextureFormat::kRgba8, kSize);
    const gpu::RenderTarget target({&colour, &height});
    target.beginKeeping();
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT);
    StrokeDrawing(library_).draw(strips_, brush, light, {}, kSize, target);
    hal::Image image = support::readRgba8(colour);
    const auto* pixel = image.row(0, 64).data() + std::ptrdiff_t{64} * 4;
    EXPECT_EQ(pixel[3], 255);
    return glm::dvec3(pixel[0], pixel[1], pixel[2]) / 255.0;
  }

  static constexpr glm::vec3 kPaint{0.6F, 0.5F, 0.4F};
};

TEST_F(BumpTest, IsTheThesissNormalInTheOraclesLight) {
  constexpr double kRelief = 16.0;
  const double step = kRelief * 4.0 / 255.0;  // of two texels
  for (const bool isAlong : {true, false}) {
    const gpu::Texture brush = ramp(isAlong);
    // Halfway along, or across.
    const double thick = (isAlong ? 63.0 : 15.0) / 255.0;
    for (int i = 0; i < 12; ++i) {
      const double angle = i * 0.5236;
      const glm::dvec2 way(std::cos(angle), std::sin(angle));
      const bool isMirrored = i % 2 == 1;
      for (const double gloss : {0.0, 0.5}) {
        const glm::dvec3 tangent =
            oracles::bumpNormal(0.0, isAlong ? step : 0.0, 0.0, isAlong ? 0.0 : step);
        const glm::dvec2 across = (isMirrored ? -1.0 : 1.0) * glm::dvec2(-way.y, way.x);
        const glm::dvec3 normal(tangent.x * way + tangent.y * across, tangent.z);
        const glm::dvec3 expected =
            oracles::litPaint(glm::dvec3(kPaint) * (0.94 + 0.12 * thick), normal, gloss);
        const glm::dvec3 found = middleOf(way, isMirrored, brush,
                                          {.each = true,
                                           .relief = static_cast<float>(kRelief),
                                           .gloss = static_cast<float>(gloss)});
        EXPECT_LT(glm::distance(found, expected), 0.012)
            << "angle " << angle << " along " << isAlong << " gloss " << gloss;
      }
    }
  }
}

TEST_F(BumpTest, PaintIsTurnedToTheLightOrNot) {
  const gpu::Texture brush = ramp(true);
  const StrokeLight light{.each = true, .relief = 16.0F};
  const glm::vec2 toLight = glm::normalize(glm::vec2(-3.0F, -4.0F));
  const glm::dvec3 rising = middleOf(toLight, false, brush, light);
  const glm::dvec3 falling = middleOf(-toLight, false, brush, light);
  EXPECT_LT(rising.g + 0.1, falling.g) << "what rises towards the light is turned from it";
  const glm::dvec3 unlit = middleOf(toLight, false, brush, {});
  EXPECT_LT(glm::distance(unlit, middleOf(-toLight, false, brush, {})), 0.01);
  EXPECT_LT(glm::distance(unlit, middleOf(toLight, false, brush, {.each = true})), 0.01)
      << "without relief light changes nothing";
}

}  // namespace
}  // namespace pleinair::styles
