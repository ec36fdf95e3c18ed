#include "pipeline/gpu/programs/shader_library.h"

#include <array>
#include <fstream>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/error.h"
#include "pipeline/gpu/gpu_shaders.h"
#include "tests/support/gl_test.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::gpu {
namespace {

using support::GlTest;
using support::readRgba8;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr std::string_view kMain =
    "layout(location = 0) out vec4 colour;\n"
    "#include \"t/outer.glsl\"\n"
    "#include \"t/inner.glsl\"\n"
    "void main() { colour = outer(); }\n";
constexpr std::string_view kOuter = "#include \"t/inner.glsl\"\nvec4 outer() { return inner(); }\n";
constexpr std::string_view kInner = "vec4 inner() { return vec4(0.2, 0.4, 0.6, 1.0); }\n";
constexpr std::array kShaders{
    EmbeddedShader{"t/main.frag", kMain},
    EmbeddedShader{"t/outer.glsl", kOuter},
    EmbeddedShader{"t/inner.glsl", kInner},
    EmbeddedShader{"t/loop.glsl", "#include \"t/loop.glsl\"\nint one = 1;\n"},
    EmbeddedShader{"t/lost.frag", "#include \"t/nowhere.glsl\"\n"},
    EmbeddedShader{"t/bad.glsl", "int good;\n\nint bad = wrong;\n"},
    EmbeddedShader{"t/bad_include.frag", "// one\n#include \"t/bad.glsl\"\nvoid main() {}\n"},
    EmbeddedShader{"t/bad_after.frag",
                   "#include \"t/inner.glsl\"\n// two\nvoid main() { int x = alsoWrong; }\n"},
    EmbeddedShader{"t/unlinkable.frag",
                   "in vec3 nobodyWrites;\nlayout(location = 0) out vec4 colour;\n"
                   "void main() { colour = vec4(nobodyWrites, 1.0); }\n"},
};

ShaderLibrary library(const std::filesystem::path& overrideDirectory = {}) {
  ShaderLibrary result(overrideDirectory);
  result.add(kShaders);
  return result;
}

std::string errorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const hal::Failure& error) {
    return error.what();
  }
  return "no error";
}

int occurrences(std::string_view text, std::string_view part) {
  int count = 0;
  for (auto at = text.find(part); at != std::string_view::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

class ShaderLibraryTest : public GlTest {};

TEST_F(ShaderLibraryTest, PutsVersionAndPrecisionsFirst) {
  EXPECT_THAT(library().expanded("t/inner.glsl"),
              AllOf(StartsWith("#version 310 es\nprecision highp float;\n"),
                    HasSubstr("precision highp uimage2D;\nvec4 inner()")));
}

TEST_F(ShaderLibraryTest, IncludesEachFileOnceAlsoNestedOrInCircles) {
  const std::string text = library().expanded("t/main.frag");
  EXPECT_EQ(occurrences(text, "vec4 inner()"), 1);
  EXPECT_EQ(occurrences(text, "vec4 outer()"), 1);
  EXPECT_LT(text.find("vec4 inner()"), text.find("vec4 outer()"));
  EXPECT_EQ(occurrences(text, "#include"), 0);
  EXPECT_EQ(occurrences(library().expanded("t/loop.glsl"), "int one"), 1);
}

TEST_F(ShaderLibraryTest, RunsWhatItPutTogether) {
  const Texture picture(TextureFormat::kRgba8, {1, 1});
  const RenderTarget target({&picture});
  library().fragmentPass("t/main.frag").use().drawFullscreen(target);
  EXPECT_THAT(readRgba8(picture).plane(0), testing::ElementsAre(51, 102, 153, 255));
}

TEST_F(ShaderLibraryTest, CompilesTheSameShadersWithTheSameDefinesOnce) {
  const ShaderLibrary shaders = library();
  const Texture one(TextureFormat::kRgba8, {1, 1});
  const Texture other(TextureFormat::kRgba8, {1, 1});
  Program first = shaders.fragmentPass("t/main.frag");
  Program second = shaders.fragmentPass("t/main.frag");
  EXPECT_EQ(shaders.compiledPrograms(), 1U);
  first.use().drawFullscreen(RenderTarget({&one}));
  second.use().drawFullscreen(RenderTarget({&other}));
  EXPECT_THAT(readRgba8(one).plane(0), testing::ElementsAre(51, 102, 153, 255));
  EXPECT_THAT(readRgba8(other).plane(0), testing::ElementsAre(51, 102, 153, 255));
  shaders.fragmentPass("t/main.frag", {{"DARK"}});
  shaders.fragmentPass("t/main.frag", {{"LEVEL", "1"}});
  EXPECT_EQ(shaders.compiledPrograms(), 3U);
  shaders.fragmentPass("t/main.frag", {{"LEVEL", "2"}});
  EXPECT_EQ(shaders.compiledPrograms(), 4U) << "a value makes another program under the same name";
  EXPECT_THAT(errorOf([&] { shaders.fragmentPass("t/unlinkable.frag"); }), HasSubstr("link"));
  EXPECT_EQ(shaders.compiledPrograms(), 4U);
}

TEST_F(ShaderLibraryTest, NamesFileAndLineOfACompileError) {
  EXPECT_THAT(errorOf([] { library().fragmentPass("t/bad_include.frag"); }),
              AllOf(StartsWith("shader t/bad_include.frag: does not compile: t/bad.glsl:3"),
                    HasSubstr("wrong")));
  EXPECT_THAT(errorOf([] { library().fragmentPass("t/bad_after.frag"); }),
              AllOf(StartsWith("shader t/bad_after.frag: does not compile: t/bad_after.frag:3"),
                    HasSubstr("alsoWrong")));
}

TEST_F(ShaderLibraryTest, NamesTheShaderOfALinkError) {
  EXPECT_THAT(
      errorOf([] { library().fragmentPass("t/unlinkable.frag"); }),
      AllOf(StartsWith("shader t/unlinkable.frag: does not link: "), HasSubstr("nobodyWrites")));
}

TEST_F(ShaderLibraryTest, ListsTheShadersThereAreForAnUnknownName) {
  EXPECT_THAT(errorOf([] { library().fragmentPass("t/nowhere.frag"); }),
              AllOf(StartsWith("shader t/nowhere.frag: no such shader; there are "),
                    HasSubstr("pipeline/gpu/shaders/fullscreen.vert, "), HasSubstr("t/main.frag")));
  EXPECT_THAT(errorOf([] { library().fragmentPass("t/lost.frag"); }),
              StartsWith("shader t/nowhere.glsl: no such shader, included by t/lost.frag; "));
}

TEST_F(ShaderLibraryTest, PrefersTheOverrideDirectory) {
  const std::filesystem::path directory =
      std::filesystem::path(testing::TempDir()) / "pleinair_shader_override";
  std::filesystem::create_directories(directory / "t");
  std::ofstream(directory / "t/inner.glsl")
      << "vec4 inner() { return vec4(1.0, 0.0, 0.0, 1.0); }\n";
  const ShaderLibrary overridden = library(directory);
  EXPECT_THAT(overridden.expanded("t/main.frag"),
              AllOf(HasSubstr("vec4(1.0, 0.0, 0.0, 1.0)"), Not(HasSubstr("0.2")),
                    HasSubstr("vec4 outer()")));
  std::filesystem::remove_all(directory);
}

TEST(ShaderOverride, IsRefusedWhereItsDirectoryIsNotThere) {
  const support::TemporaryFolder folder;
  std::ofstream(folder.path() / "file") << "text";
  for (const char* name : {"nowhere", "file"}) {
    try {
      const ShaderLibrary refused(folder.path() / name);
      ADD_FAILURE() << name;
    } catch (const hal::Failure& error) {
      EXPECT_EQ(error.error().kind, hal::ErrorKind::kNotFound);
      EXPECT_EQ(error.error().subject, (folder.path() / name).string());
    }
  }
}

TEST(ShaderOverride, IsRefusedWhereAFileOfItCannotBeRead) {
  const support::TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "t/inner.glsl");
  std::filesystem::create_symlink("outer.glsl", folder.path() / "t/outer.glsl");  // to itself
  const ShaderLibrary shaders = library(folder.path());
  EXPECT_THAT(errorOf([&] { shaders.expanded("t/inner.glsl"); }),
              AllOf(HasSubstr("t/inner.glsl: cannot read this shader: Is a directory")));
  EXPECT_THAT(errorOf([&] { shaders.expanded("t/outer.glsl"); }),
              HasSubstr("t/outer.glsl: cannot read this shader: Too many levels"));
  EXPECT_THAT(shaders.expanded("t/loop.glsl"), HasSubstr("int one"));  // has no file there
}

TEST(ShaderOverride, MayBeAnEmptyFile) {
  const support::TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "t");
  const std::ofstream empty(folder.path() / "t/inner.glsl");
  EXPECT_THAT(library(folder.path()).expanded("t/inner.glsl"), Not(HasSubstr("inner")));
}

TEST_F(ShaderLibraryTest, CompilesEveryShaderOfTheRoom) {
  const ShaderLibrary own;
  for (const EmbeddedShader& shader : gpuShaders()) {
    if (!shader.name.ends_with(".frag")) continue;
    EXPECT_TRUE(own.fragmentPass(shader.name)) << shader.name;
  }
}

TEST(NameLinesOfLog, KnowsTheDriversWaysToNameAPlace) {
  const std::array<SourceLine, 3> lines{{{"a.frag", 1}, {"b.glsl", 1}, {"a.frag", 3}}};
  EXPECT_EQ(nameLinesOfLog("0:3(7): error: x\n0:2(1): error: y\nno place\n0:4: beyond", lines),
            "a.frag:3(7): error: x\nb.glsl:1(1): error: y\nno place\n0:4: beyond");
  EXPECT_EQ(nameLinesOfLog("0(2) : error C1503: undefined variable", lines),
            "b.glsl:1 : error C1503: undefined variable");
}

}  // namespace
}  // namespace pleinair::gpu
