// Errors that llvmpipe tolerates and the target GPUs do not (docs/gpu.md, rules 2-4).
#include <regex>
#include <string>

#include "pipeline/gpu/gpu_shaders.h"
#include "pipeline/styles/substrate/substrate_shaders.h"
#include "pipeline/styles/watercolor/watercolor_shaders.h"
#include "tests/gpu/watercolor/watercolor_fixture.h"

namespace pleinair::styles {
namespace {

int countOf(const std::string& text, const char* pattern) {
  const std::regex regex(pattern);
  return static_cast<int>(
      std::distance(std::sregex_iterator(text.begin(), text.end(), regex), std::sregex_iterator()));
}

int localSize(const std::string& text, const char* axis) {
  std::smatch match;
  const std::regex regex("local_size_" + std::string(axis) + R"(\s*=\s*(\d+))");
  return std::regex_search(text, match, regex) ? std::stoi(match[1]) : 1;
}

TEST(WatercolorShaders, KeepWithinWhatTheTargetsAllow) {
  gpu::ShaderLibrary library;
  library.add(gpu::gpuShaders());
  library.add(gpu::sceneShaders());
  library.add(gpu::marksShaders());
  library.add(gpu::substrateShaders());
  library.add(gpu::watercolorShaders());
  int compute = 0;
  for (const gpu::EmbeddedShader& shader : gpu::watercolorShaders()) {
    SCOPED_TRACE(shader.name);
    const std::string text = library.expanded(shader.name);
    const int storage = countOf(text, R"(\bbuffer\s+\w+\s*\{)");
    const int images = countOf(text, R"(\buniform\s+(\w+\s+)?[iu]?image2D\b)");
    EXPECT_LE(storage, 4);
    EXPECT_LE(images, 4);
    EXPECT_EQ(countOf(text, "gl_PrimitiveID"), 0);
    if (shader.name.ends_with(".comp")) {
      ++compute;
      EXPECT_GT(storage, 0);
      EXPECT_LE(localSize(text, "x") * localSize(text, "y") * localSize(text, "z"), 128);
    } else {
      EXPECT_EQ(storage + images, 0);
    }
  }
  EXPECT_EQ(compute, 6);
}

}  // namespace
}  // namespace pleinair::styles
