#include "pipeline/gpu/pass_form.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/error.h"

namespace pleinair::gpu {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr std::string_view kPass =
    "#version 310 es\n"
    "precision highp float;\n"
    "layout(location = 0) out vec2 tensor;\n"
    "layout(location = 1) out highp uint border;\n"
    "void main() {\n"
    "  tensor = gl_FragCoord.xy;\n"
    "}\n";

TEST(ComputeFormTest, WritesEachOutputToAnImageOfItsFormat) {
  const std::string text =
      computeFormOf(kPass, std::array{TextureFormat::kRg16f, TextureFormat::kR32ui});
  EXPECT_THAT(text,
              HasSubstr("layout(rg16f, binding = 0) writeonly uniform highp image2D passTarget0;"));
  EXPECT_THAT(
      text, HasSubstr("layout(r32ui, binding = 1) writeonly uniform highp uimage2D passTarget1;"));
  EXPECT_THAT(text, HasSubstr("imageStore(passTarget0, passPixel, vec4(tensor, 0.0, 1.0));"));
  EXPECT_THAT(text, HasSubstr("imageStore(passTarget1, passPixel, uvec4(border, 0u, 0u, 1u));"));
  EXPECT_THAT(text, HasSubstr("\nvec2 tensor;\n"));
  EXPECT_THAT(text, HasSubstr("tensor = passFragCoord.xy;"));
  EXPECT_THAT(text, Not(HasSubstr("gl_FragCoord")));
}

TEST(ComputeFormTest, LinesBehindTheVersionAreLaterByTwo) {
  const std::string text =
      computeFormOf(kPass, std::array{TextureFormat::kRg16f, TextureFormat::kR32ui});
  EXPECT_THAT(text, testing::StartsWith("#version 310 es\n#extension GL_NV_image_formats"));
  const auto lineOf = [](std::string_view whole, std::string_view part) {
    return std::ranges::count(whole.substr(0, whole.find(part)), '\n');
  };
  EXPECT_EQ(lineOf(text, "precision highp float;"),
            lineOf(kPass, "precision highp float;") + kComputeFormLines);
}

TEST(ComputeFormTest, RefusesOtherTargetsThanTheShaderHas) {
  EXPECT_THROW((void)computeFormOf(kPass, std::array{TextureFormat::kRg16f}), hal::Failure);
  EXPECT_THROW((void)computeFormOf(kPass, std::array{TextureFormat::kRg16f, TextureFormat::kR32ui,
                                                     TextureFormat::kRgba8}),
               hal::Failure);
  EXPECT_THROW(
      (void)computeFormOf(kPass, std::array{TextureFormat::kRg16f, TextureFormat::kDepth24}),
      hal::Failure);
}

TEST(ComputeFormTest, RefusesWhatOnlyFragmentsHave) {
  const auto withLine = [](std::string_view line) {
    std::string text(kPass);
    text.insert(text.find("  tensor"), std::string(line));
    return computeFormOf(text, std::array{TextureFormat::kRg16f, TextureFormat::kR32ui});
  };
  EXPECT_NO_THROW((void)withLine("  float discarded = 0.0;\n"));
  EXPECT_THROW((void)withLine("  if (gl_FragCoord.x < 3.0) discard;\n"), hal::Failure);
  EXPECT_THROW((void)withLine("  float slope = dFdx(gl_FragCoord.x);\n"), hal::Failure);
}

}  // namespace
}  // namespace pleinair::gpu
