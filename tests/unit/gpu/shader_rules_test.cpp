#include "tests/support/shader_rules.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/gpu/programs/shader_interface.h"
#include "pipeline/gpu/programs/shader_library.h"

namespace pleinair::support {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
namespace fs = std::filesystem;

std::string read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// The names that `#ifdef` and `#ifndef` ask for.
std::set<std::string> flagsOf(const std::string& text) {
  std::set<std::string> flags;
  static const std::regex kCondition("#\\s*(?:ifdef|ifndef)\\s+(\\w+)");
  for (std::sregex_iterator match(text.begin(), text.end(), kCondition), end; match != end;
       ++match) {
    flags.insert((*match)[1].str());
  }
  return flags;
}

/// The flags that a shader and its includes know, also includes that only a variant takes in.
std::set<std::string> allFlagsOf(const gpu::ShaderLibrary& library, const std::string& name) {
  std::set<std::string> flags;
  for (std::size_t known = 1; known != flags.size();) {
    known = flags.size();
    gpu::ShaderDefines defines;
    for (const std::string& flag : flags) defines.push_back({flag});
    flags.merge(flagsOf(library.expanded(name, defines)));
    if (known == 0 && flags.empty()) break;
  }
  return flags;
}

/// Without the version and precisions that the library puts first.
std::string withoutHeader(const std::string& text, const std::string& header) {
  return text.substr(header.size());
}

/// Every variant of every shader: with each selection of the flags that its text asks for.
std::vector<ShaderText> shadersOfTheTree() {
  const fs::path root = fs::path(PLEINAIR_TESTS_DIR).parent_path();
  static constexpr std::array<std::string_view, 7> kEndings{".vert", ".frag", ".comp", ".glsl",
                                                            ".geom", ".tesc", ".tese"};
  const gpu::ShaderLibrary library(root);
  constexpr std::array kEmpty{gpu::EmbeddedShader{"empty", ""}};
  gpu::ShaderLibrary bare;
  bare.add(kEmpty);
  const std::string header = bare.expanded("empty");
  std::vector<ShaderText> shaders;
  for (const auto& entry : fs::recursive_directory_iterator(root / "pipeline")) {
    const std::string ending = entry.path().extension().string();
    if (std::ranges::find(kEndings, ending) == kEndings.end()) continue;
    const std::string name = fs::relative(entry.path(), root).generic_string();
    const std::set<std::string> found = allFlagsOf(library, name);
    const std::vector<std::string> flags(found.begin(), found.end());
    for (std::size_t selection = 0; selection < std::size_t{1} << flags.size(); ++selection) {
      gpu::ShaderDefines defines;
      for (std::size_t i = 0; i < flags.size(); ++i) {
        if ((selection >> i & 1U) != 0) defines.push_back({flags[i]});
      }
      std::string label = name;
      for (const gpu::ShaderDefine& define : defines) label += " " + define.name;
      shaders.push_back({name, read(entry.path()),
                         gpu::activeLines(withoutHeader(library.expanded(name, defines), header)),
                         label});
    }
  }
  return shaders;
}

TEST(ShaderRules, AreHeldAgainstEveryVariant) {
  std::set<std::string> variants;
  for (const ShaderText& shader : shadersOfTheTree()) variants.insert(shader.variant);
  const std::string strokes = "pipeline/styles/strokes/shaders/stroke.frag";
  for (const char* flags : {"", " BUMPED", " CLIPPED", " BUMPED CLIPPED"}) {
    EXPECT_TRUE(variants.contains(strokes + flags)) << flags;
  }
  EXPECT_TRUE(variants.contains("pipeline/scene/render/shaders/model.frag MASKED TOON"));
}

TEST(ShaderRules, HoldForEveryShaderOfTheTree) {
  const std::vector<ShaderText> shaders = shadersOfTheTree();
  EXPECT_GE(shaders.size(), 5U);
  for (const ShaderText& shader : shaders) {
    EXPECT_THAT(shaderRules(shader), IsEmpty()) << shader.variant;
  }
}

constexpr const char* kHead = "// Purpose: p. Inputs: i. Outputs: o. Precision: highp.\n";

ShaderText shader(const std::string& name, const std::string& code) {
  return {name, kHead + code, kHead + code, name};
}

/// Asserts that a shader breaks just one rule, and says so.
void expectOnly(const ShaderText& text, const std::string& complaint) {
  const Violations violations = shaderRules(text);
  ASSERT_EQ(violations.size(), 1U) << testing::PrintToString(violations);
  EXPECT_THAT(violations.front(), HasSubstr(complaint));
}

TEST(ShaderRules, LetGoodShadersPass) {
  EXPECT_THAT(shaderRules(shader("a.vert", "in vec2 corner; out vec2 at;\nvoid main() {}")),
              IsEmpty());
  EXPECT_THAT(shaderRules(shader("a.frag",
                                 "in vec2 at;\nlayout(location = 0) out vec4 a;\n"
                                 "layout(location = 1) out uint b;\nuniform sampler2D picture;\n"
                                 "void split(vec3 v,\n    out float x) { x = v.x; }\n"
                                 "void main() { mediump vec3 paintColour; mediump vec4 rgba; }")),
              IsEmpty());
  EXPECT_THAT(
      shaderRules(shader("a.comp",
                         "const int kSide = 8;\n#define DEEP (2 * kSide)\n"
                         "layout(local_size_x = kSide, local_size_y = DEEP) in;\n"
                         "layout(std430, binding = 0) buffer Sums { uint sums[]; };\n"
                         "layout(rgba8, binding = 0) uniform writeonly highp image2D to;\n"
                         "layout(r32ui, binding = 1) uniform highp uimage2D both;\n"
                         "shared vec4 tile[kSide * kSide][DEEP];\n"  // 16 KiB to the byte
                         "void main() {\n  // x = atomicAdd(a, b)\n  atomicAdd(sums[0], 1u);\n"
                         "  if (true) atomicAdd(sums[1], 1u); else atomicAdd(sums[2], 1u);\n}")),
      IsEmpty());
}

TEST(ShaderRules, WantAHeadCommentWithItsFourParts) {
  const std::string code = "void main() {}";
  EXPECT_EQ(shaderRules({"a.frag", code, code}).size(), 4U);
  expectOnly({"a.frag", "// Purpose: p. Inputs: i. Outputs: o.\n" + code, code}, "\"precision:\"");
  expectOnly({"a.frag", "// Inputs: i. Outputs: o. Precision: p.\n" + code, code}, "\"purpose:\"");
}

TEST(ShaderRules, RefuseVersionsAndStagesThatAreNotEverywhere) {
  expectOnly(shader("a.frag", "#version 320 es\n"), "the shader library puts the version");
  expectOnly(shader("a.frag", "int i = gl_PrimitiveID;"), "gl_PrimitiveID");
  expectOnly(shader("a.glsl", "void f() { EmitVertex(); }"), "EmitVertex");
  expectOnly(shader("a.tese", "void main() {}"), "no such stage");
  expectOnly(shader("a.geom", "void main() {}"), "no such stage");
}

TEST(ShaderRules, RefuseConditionsThatInputsAreNotFoundBy) {
  const std::string code = "\nuniform bool a;\n#endif\n";
  EXPECT_THAT(shaderRules(shader("a.frag", "#ifdef A" + code)), IsEmpty());
  expectOnly(shader("a.frag", "#if defined(A)" + code), "#ifdef");
  expectOnly(shader("a.frag", "#ifdef A\n#elif defined(B)" + code), "#ifdef");
}

TEST(ShaderRules, RefuseStorageInGraphicsStages) {
  const std::string block = "layout(std430, binding = 0) readonly buffer Seeds { vec2 seeds[]; };";
  expectOnly(shader("a.vert", block), "rules 2 and 3");
  expectOnly(shader("a.frag", block), "rules 2 and 3");
  expectOnly(shader("a.frag", "layout(rgba8) uniform readonly highp image2D i;"), "rules 2 and 3");
  EXPECT_THAT(shaderRules(shader("a.glsl", block)), IsEmpty());  // judged where it is included
}

TEST(ShaderRules, CountColourTargets) {
  std::string code;
  for (int i = 0; i < 4; ++i) code += "layout(location = 0) out vec4 c" + std::to_string(i) + ";\n";
  EXPECT_THAT(shaderRules(shader("a.frag", code)), IsEmpty());
  expectOnly(shader("a.frag", code + "out highp vec4 more;\n"), "5 colour targets");
  expectOnly(shader("a.frag", "out vec4 many[6];\n"), "6 colour targets");
}

TEST(ShaderRules, CountWhatComputeHas) {
  const std::string head = "layout(local_size_x = 64) in;\n";
  expectOnly(shader("a.comp", "layout(local_size_x = 16, local_size_y = 16) in;"), "groups of 256");
  expectOnly(shader("a.comp", "void main() {}"), "no local_size");
  std::string buffers = head;
  std::string images = head;
  for (int i = 0; i < 5; ++i) {
    const std::string number = std::to_string(i);
    buffers += "buffer B" + number + " { float b" + number + "[]; };\n";
    images += "layout(r32f) uniform readonly highp image2D i" + number + ";\n";
  }
  expectOnly(shader("a.comp", buffers), "5 storage buffers");
  expectOnly(shader("a.comp", images), "5 images");
}

TEST(ShaderRules, AddUpSharedMemory) {
  const std::string head = "layout(local_size_x = 64) in;\n";
  expectOnly(shader("a.comp", head + "shared float a[4096], b;"), "16388 bytes");
  expectOnly(shader("a.comp", head + "shared vec4 a[1024];\nshared highp uint b[2];"),
             "16392 bytes");
  expectOnly(shader("a.comp", head + "struct S { vec4 a; float b[4]; };\nshared S s[600];"),
             "19200 bytes");
  expectOnly(shader("a.comp", head + "shared float a[unknown];"), "no constant");
  expectOnly(shader("a.comp", head + "shared Strange a;"), "how large a Strange is");
}

TEST(ShaderRules, KnowImageFormats) {
  const std::string head = "layout(local_size_x = 64) in;\n";
  expectOnly(shader("a.comp", head + "layout(rg16f) uniform writeonly highp image2D i;"),
             "not on every target");
  expectOnly(shader("a.comp", head + "writeonly uniform highp image2D i;"), "not on every target");
  expectOnly(shader("a.comp", head + "layout(rgba8) uniform highp image2D i;"),
             "only r32f and r32ui");
  expectOnly(shader("a.comp", head + "layout(r32ui) uniform highp uimage2D i;\n"
                                     "void main() { imageAtomicAdd(i, ivec2(0), 1u); }"),
             "atomics live in storage buffers");
}

TEST(ShaderRules, RefuseOrderFromAtomics) {
  const std::string head = "layout(local_size_x = 64) in;\nbuffer B { uint n; uint b[]; };\n";
  for (const char* use : {"uint slot = atomicAdd(n, 1u);", "b[atomicAdd(n, 1u)] = 1u;",
                          "f(1u, atomicCounterIncrement(n));"}) {
    expectOnly(shader("a.comp", head + "void main() { " + use + " }"), "rule 7");
  }
  expectOnly(shader("a.comp", head + "uint f() { return atomicAdd(n, 1u); }"), "rule 7");
}

TEST(ShaderRules, RefuseRunsBeyondAList) {
  const std::string head =
      "layout(local_size_x = 64) in;\nbuffer B { uint busyWords[]; };\n"
      "int busyAt(int i) { return i; }\nbool isBeyond(int i) { return false; }\n";
  const std::string use = "busyWords[busyAt(int(gl_WorkGroupID.x))] = 1u; }";
  expectOnly(shader("a.comp", head + "void main() { " + use), "rule 27");
  EXPECT_THAT(shaderRules(shader("a.comp", head + "void main() { if (isBeyond(3)) return; " + use)),
              IsEmpty());
}

TEST(ShaderRules, CountTextures) {
  std::string code;
  for (int i = 0; i < 16; ++i) code += "uniform sampler2D t" + std::to_string(i) + ";\n";
  EXPECT_THAT(shaderRules(shader("a.frag", code)), IsEmpty());
  expectOnly(shader("a.frag", code + "uniform highp usampler2D ids;\n"), "17 textures");
}

TEST(ShaderRules, RefuseConstantBoundsThatAreCutShort) {
  const std::string rest = "; ++i) {\n if (i >= count) break;\n sum += a[i]; } }";
  expectOnly(shader("a.frag", "void main() { for (int i = 0; i < kMaxPlanes" + rest), "rule 19");
  expectOnly(shader("a.frag", "void main() { for (int i = 0; i < 8" + rest), "rule 19");
  EXPECT_THAT(shaderRules(shader("a.frag", "void main() { for (int i = 0; i < bound" + rest)),
              IsEmpty());
}

TEST(ShaderRules, KeepMediumPrecisionToColours) {
  expectOnly(shader("a.frag", "precision mediump float;"), "mediump float");
  expectOnly(shader("a.frag", "uniform mediump vec2 colour;"), "mediump vec2");
  expectOnly(shader("a.frag", "uniform mediump vec3 position;"), "mediump vec3 position");
  expectOnly(shader("a.frag", "lowp vec3 colour;"), "lowp");
}

TEST(ConstantValue, WorksOutWhatShadersWrite) {
  const std::string code = "const uint kA = 4u;\n#define B (kA + 1)\nconst int kLoop = kLoop;\n";
  EXPECT_EQ(constantValue("2 * (kA + 3) - B / 2", code), 12);
  EXPECT_EQ(constantValue("0x10u", code), 16);
  for (const char* bad : {"", "kA +", "(2", "1/0", "kLoop", "f(2)", "nobody"}) {
    EXPECT_THROW((void)constantValue(bad, code), std::invalid_argument) << bad;
  }
}

TEST(WithoutComments, KeepsCodeOnly) {
  EXPECT_EQ(withoutComments("a; // b\nc /* d\n * e */ f"), "a;  \nc   f");
}

}  // namespace
}  // namespace pleinair::support
