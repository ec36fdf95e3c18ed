#include "pipeline/gpu/programs/pass_form.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/error.h"
#include "pipeline/gpu/programs/shader_library.h"

namespace pleinair::gpu {
namespace {

using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

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
  const auto withLine = [](std::string_view line, std::string_view before) {
    std::string text(kPass);
    text.insert(text.find(before), std::string(line) + "\n");
    return computeFormOf(text, std::array{TextureFormat::kRg16f, TextureFormat::kR32ui});
  };
  for (const char* line : {"float discarded = 0.0;", "// no discard", "int inside = 0;"}) {
    EXPECT_NO_THROW((void)withLine(line, "  tensor")) << line;
  }
  for (const char* line : {"if (gl_FragCoord.x < 3.0) discard;", "float x = dFdx(1.0);"}) {
    EXPECT_THROW((void)withLine(line, "  tensor"), hal::Failure) << line;
  }
  for (const char* line : {"in vec2 at;", "layout(location = 1) flat in highp uint id;"}) {
    EXPECT_THROW((void)withLine(line, "layout(location = 0)"), hal::Failure) << line;
  }
}

/// A full-screen pass as code asks for it.
struct Pass {
  std::string shader;
  ShaderDefines defines;
  std::size_t targets = 0;
};

/// The passes for which the code of a file names targets; their shaders lie in "shaders" beside it.
/// Where their defines are a variable, those without any.
std::vector<Pass> passesWithTargets(const fs::path& root, const fs::path& file) {
  static const std::regex kCall(
      R"re(fragmentPass\([^"()]*"([^"]+)",\s*(?:defines|\{(?:\{"(\w+)"\})?\}),\s*\{([^}]*)\}\))re");
  std::ifstream stream(file);
  const std::string code{std::istreambuf_iterator<char>(stream), {}};
  std::vector<Pass> passes;
  for (std::sregex_iterator call(code.begin(), code.end(), kCall), end; call != end; ++call) {
    const std::string targets = (*call)[3];
    Pass pass{.shader = (*call)[1],
              .targets = 1 + static_cast<std::size_t>(std::ranges::count(targets, ','))};
    if (pass.shader.find('/') == std::string::npos) {
      pass.shader =
          (fs::relative(file.parent_path(), root) / "shaders" / pass.shader).generic_string();
    }
    if ((*call)[2].matched) pass.defines.push_back({(*call)[2]});
    passes.push_back(std::move(pass));
  }
  return passes;
}

// Drivers that run them in this form are rare; what has none is to be found without one.
TEST(ComputeFormTest, EveryPassWithTargetsHasOne) {
  const fs::path root = fs::path(PLEINAIR_TESTS_DIR).parent_path();
  const ShaderLibrary library(root);
  const std::vector<TextureFormat> formats(4, TextureFormat::kRgba8);
  int found = 0;
  for (const auto& entry : fs::recursive_directory_iterator(root / "pipeline")) {
    if (entry.path().extension() != ".cpp") continue;
    for (const Pass& pass : passesWithTargets(root, entry.path())) {
      ++found;
      EXPECT_NO_THROW((void)computeFormOf(library.expanded(pass.shader, pass.defines),
                                          std::span(formats).first(pass.targets)))
          << pass.shader;
    }
  }
  EXPECT_GE(found, 18);
}

}  // namespace
}  // namespace pleinair::gpu
