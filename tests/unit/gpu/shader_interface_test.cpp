// The interface that is parsed from a shader's text. Needs no GPU.
#include "pipeline/gpu/programs/shader_interface.h"

#include <gmock/gmock.h>

namespace pleinair::gpu {
namespace {

using Kind = ShaderInput::Kind;

const ShaderInput* find(const std::vector<ShaderInput>& inputs, std::string_view name) {
  for (const ShaderInput& input : inputs) {
    if (input.name == name) return &input;
  }
  return nullptr;
}

TEST(ShaderInterface, KnowsEveryWayToDeclare) {
  const std::vector<ShaderInput> inputs = declaredInputs(R"(#version 310 es
precision highp float;
const int kPlace = 3;  // uniform int noneInAComment;
/* uniform int
   noneEither; */
uniform vec2 size;
uniform mediump vec3 one, several[4];
uniform highp usampler2D tiling;
layout(binding = 1, rgba8) writeonly uniform highp image2D result;
layout(std140, binding = kPlace) uniform Planes { vec4 planes[2]; };
layout(std430, binding = 2) readonly buffer Seeds { vec2 seeds[]; } names;
struct Body { vec4 uniformly; };
void main() { vec2 local; if (true) { local = size; } }
uniform bool last;
)");
  ASSERT_EQ(inputs.size(), 8U);
  const auto expect = [&](std::string_view name, Kind kind, std::string_view type, int binding) {
    const ShaderInput* input = find(inputs, name);
    ASSERT_NE(input, nullptr) << name;
    EXPECT_EQ(input->kind, kind) << name;
    EXPECT_EQ(input->type, type) << name;
    EXPECT_EQ(input->binding, binding) << name;
  };
  expect("size", Kind::kUniform, "vec2", -1);
  expect("one", Kind::kUniform, "vec3", -1);
  expect("several", Kind::kUniform, "vec3", -1);
  expect("tiling", Kind::kSampler, "usampler2D", -1);
  expect("result", Kind::kImage, "image2D", 1);
  expect("Planes", Kind::kUniformBlock, "", 3);
  expect("Seeds", Kind::kStorageBlock, "", 2);
  expect("last", Kind::kUniform, "bool", -1);
}

TEST(ShaderInterface, LeavesOutWhatAVariantLacks) {
  const std::string text =
      "#ifdef MASKED\nuniform float cutoff;\n#else\nuniform float other;\n#endif\n"
      "#ifndef MASKED\n#define BARE\n#endif\n#ifdef BARE\nuniform int bare;\n#endif\n";
  const std::vector<ShaderInput> plain = declaredInputs(text);
  EXPECT_EQ(find(plain, "cutoff"), nullptr);
  EXPECT_NE(find(plain, "other"), nullptr);
  EXPECT_NE(find(plain, "bare"), nullptr);
  const std::vector<ShaderInput> masked = declaredInputs("#define MASKED\n" + text);
  EXPECT_NE(find(masked, "cutoff"), nullptr);
  EXPECT_EQ(find(masked, "other"), nullptr);
  EXPECT_EQ(find(masked, "bare"), nullptr);
  EXPECT_EQ(activeLines("a\n#ifdef X\nb\n#endif\nc\n"), "a\n\n\n\nc\n");
}

}  // namespace
}  // namespace pleinair::gpu
