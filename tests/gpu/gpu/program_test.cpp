#include "pipeline/gpu/programs/program.h"

#include <array>
#include <functional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/error.h"
#include "tests/support/gl_test.h"

namespace pleinair::gpu {
namespace {

using support::GlTest;
using support::readBuffer;
using support::readR32ui;
using support::readRgba8;
using testing::HasSubstr;

constexpr std::array kShaders{
    EmbeddedShader{"t/setters.comp", R"(
layout(local_size_x = 1) in;
layout(std430, binding = 1) writeonly buffer Values { float values[]; };
uniform int anInt;
uniform uint anUnsigned;
uniform float aFloat;
uniform ivec2 anIvec2;
uniform vec2 aVec2;
uniform vec3 aVec3;
uniform vec4 aVec4;
uniform mat3 aMat3;
uniform mat4 aMat4;
void main() {
  values[0] = float(anInt);
  values[1] = float(anUnsigned);
  values[2] = aFloat;
  values[3] = float(anIvec2.x);
  values[4] = float(anIvec2.y);
  values[5] = aVec2.x;
  values[6] = aVec2.y;
  values[7] = aVec3.x;
  values[8] = aVec3.y;
  values[9] = aVec3.z;
  values[10] = aVec4.x;
  values[11] = aVec4.y;
  values[12] = aVec4.z;
  values[13] = aVec4.w;
  vec3 v3 = aMat3 * vec3(1.0, 2.0, 3.0);
  values[14] = v3.x;
  values[15] = v3.y;
  values[16] = v3.z;
  vec4 v4 = aMat4 * vec4(1.0, 2.0, 3.0, 4.0);
  values[17] = v4.x;
  values[18] = v4.y;
  values[19] = v4.z;
  values[20] = v4.w;
}
)"},
    EmbeddedShader{"t/difference.frag", R"(
uniform sampler2D first;
uniform sampler2D second;
layout(location = 0) out vec4 colour;
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  colour = vec4(texelFetch(first, p, 0).rgb - texelFetch(second, p, 0).rgb, 1.0);
}
)"},
    EmbeddedShader{"t/number.comp", R"(
layout(local_size_x = 8, local_size_y = 4) in;
layout(r32ui, binding = 2) writeonly uniform highp uimage2D result;
void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  imageStore(result, p, uvec4(uint(p.y * 100 + p.x)));
}
)"},
    EmbeddedShader{"t/unused.comp", R"(
layout(local_size_x = 1) in;
uniform float nobodyReads;
uniform vec2 one, several[2];
void main() {}
)"},
    EmbeddedShader{"t/bindings.comp", R"(
layout(local_size_x = 1) in;
layout(std430, binding = 4) buffer Beyond { float values[]; };
layout(r32ui, binding = 0) writeonly uniform highp uimage2D first;
layout(r32ui, binding = 4) writeonly uniform highp uimage2D beyond;
void main() {}
)"},
};

class ProgramTest : public GlTest {
 protected:
  ProgramTest() { library_.add(kShaders); }
  ShaderLibrary library_;
};

TEST_F(ProgramTest, SetsUniformsOfEveryType) {
  const Buffer values(21 * sizeof(float), BufferUsage::kDynamic);
  const glm::mat3 mat3(1, 2, 3, 4, 5, 6, 7, 8, 9);
  const glm::mat4 mat4(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16);
  Program program = library_.compute("t/setters.comp");
  EXPECT_EQ(program.label(), "t/setters.comp");
  program.use()
      .storage("Values", values)
      .set("anInt", -3)
      .set("anUnsigned", 4'000'000'000U)
      .set("aFloat", 0.5F)
      .set("anIvec2", glm::ivec2(-1, 2))
      .set("aVec2", glm::vec2(0.25F, 8.0F))
      .set("aVec3", glm::vec3(1.0F, 2.0F, 3.0F))
      .set("aVec4", glm::vec4(4.0F, 5.0F, 6.0F, 7.0F))
      .set("aMat3", mat3)
      .set("aMat4", mat4)
      .dispatch({1, 1}, GL_BUFFER_UPDATE_BARRIER_BIT);
  EXPECT_THAT(readBuffer<float>(values),
              testing::ElementsAre(-3, 4e9F, 0.5F, -1, 2, 0.25F, 8, 1, 2, 3, 4, 5, 6, 7,  //
                                   30, 36, 42, 90, 100, 110, 120));
}

TEST_F(ProgramTest, GivesEachTextureAUnitOfItsOwnAndBeginsAnewWithUse) {
  const std::array<std::uint8_t, 4> bright{200, 100, 50, 255};
  const std::array<std::uint8_t, 4> dark{20, 30, 40, 255};
  Texture first(TextureFormat::kRgba8, {1, 1});
  Texture second(TextureFormat::kRgba8, {1, 1});
  first.upload(bright, 4);
  second.upload(dark, 4);
  const Texture result(TextureFormat::kRgba8, {1, 1});
  const RenderTarget target({&result});
  Program program = library_.fragmentPass("t/difference.frag");
  for (int pass = 0; pass < 20; ++pass) {  // more than there are units
    program.use().texture("first", first).texture("second", second).drawFullscreen(target);
  }
  EXPECT_THAT(readRgba8(result).plane(0), testing::ElementsAre(180, 70, 10, 255));
  program.use().texture("second", first).texture("first", second).drawFullscreen(target);
  EXPECT_THAT(readRgba8(result).plane(0), testing::ElementsAre(0, 0, 0, 255));
}

TEST_F(ProgramTest, DispatchesWholeGroupsOverEveryItem) {
  const Texture result(TextureFormat::kR32ui, {13, 6});
  Program program = library_.compute("t/number.comp");
  program.use()
      .image("result", result, ImageAccess::kWrite)
      .dispatch({13, 6}, GL_FRAMEBUFFER_BARRIER_BIT);
  const std::vector<std::uint32_t> numbers = readR32ui(result);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    ASSERT_EQ(numbers[i], i / 13 * 100 + i % 13) << i;
  }
}

std::string refusalOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const hal::Failure& error) {
    EXPECT_EQ(error.error().kind, hal::ErrorKind::kInternal);
    return error.what();
  }
  return "nothing was refused";
}

TEST_F(ProgramTest, RefusesNamesThatItsShadersDoNotDeclare) {
  const Texture texture(TextureFormat::kR32ui, {1, 1});
  const Buffer buffer(256, BufferUsage::kDynamic);
  Program difference = library_.fragmentPass("t/difference.frag");
  difference.use();
  EXPECT_EQ(refusalOf([&] { difference.set("frist", 1.0F); }),
            "program t/difference.frag: has no uniform \"frist\"; its shaders declare sampler "
            "first, sampler second");
  EXPECT_THAT(refusalOf([&] { difference.texture("third", texture); }),
              HasSubstr("has no sampler \"third\""));
  Program setters = library_.compute("t/setters.comp");
  setters.use();
  EXPECT_THAT(refusalOf([&] { setters.storage("Value", buffer); }),
              HasSubstr("has no storage block \"Value\""));
  EXPECT_THAT(refusalOf([&] { setters.uniformBlock("Values", buffer, 0, 4); }),
              HasSubstr("has no uniform block \"Values\""));
  EXPECT_THAT(refusalOf([&] { setters.image("values", texture, ImageAccess::kRead); }),
              HasSubstr("has no image \"values\""));
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

TEST_F(ProgramTest, RefusesValuesOfAnotherTypeThanIsDeclared) {
  Program setters = library_.compute("t/setters.comp");
  setters.use();
  EXPECT_THAT(refusalOf([&] { setters.set("aFloat", 1); }),
              HasSubstr("has a float aFloat, which cannot be set to a int"));
  EXPECT_THAT(refusalOf([&] { setters.set("aVec3", glm::vec4(1.0F)); }), HasSubstr("vec3 aVec3"));
}

TEST_F(ProgramTest, TakesDeclaredNamesThatTheCompilerRemoved) {
  Program unused = library_.compute("t/unused.comp");
  unused.use().set("nobodyReads", 1.0F).set("several", glm::vec2(2.0F));
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

TEST_F(ProgramTest, KnowsItsGroupSizeAndItsPass) {
  EXPECT_EQ(library_.compute("t/number.comp").groupSize(), glm::ivec2(8, 4));
  EXPECT_EQ(library_.compute("t/number.comp").pass(), "t: number");
  const Program own =
      library_.fragmentPass("pipeline/gpu/images/shaders/resample.frag", {{"WIDE"}});
  EXPECT_EQ(own.pass(), "images: resample WIDE");
  EXPECT_EQ(own.label(), "pipeline/gpu/images/shaders/resample.frag WIDE");
}

TEST_F(ProgramTest, TimesItsRunsByTheLibrarysTimer) {
  PassTimer timer(PassTiming::kFences);
  const Texture result(TextureFormat::kR32ui, {13, 6});
  Program program = library_.compute("t/number.comp");
  const auto run = [&] {
    program.use().image("result", result, ImageAccess::kWrite).dispatch({13, 6}, 0);
  };
  run();
  library_.setTimer(&timer);  // also of programs made before
  for (int i = 0; i < 3; ++i) run();
  ASSERT_EQ(timer.times().size(), 1U);
  EXPECT_EQ(timer.times()[0].pass, "t: number");
  EXPECT_EQ(timer.times()[0].count, 3);
  {
    const auto scope = timer.measure("by hand");
    run();
  }
  ASSERT_EQ(timer.times().size(), 2U);
  EXPECT_EQ(timer.times()[0].count, 3) << "counted twice";
  library_.setTimer(nullptr);
  run();
  EXPECT_EQ(timer.times()[0].count, 3);
}

using ProgramDeathTest = ProgramTest;

TEST_F(ProgramDeathTest, WantsToBeInUse) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  Program number = library_.compute("t/number.comp");
  Program setters = library_.compute("t/setters.comp");
  setters.use();
  EXPECT_DEATH(number.set("anInt", 1), "isCurrent");
  EXPECT_DEATH(number.dispatch({8, 8}, 0), "isCurrent");
  number.use();
  EXPECT_DEATH(number.dispatch({0, 8}, 0), "items");
}

TEST_F(ProgramDeathTest, RefusesWhatTheTargetsCannotBind) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  Program program = library_.compute("t/bindings.comp");
  program.use();
  const Buffer buffer(16, BufferUsage::kDynamic);
  const Texture colours(TextureFormat::kRgba8, {1, 1});
  const Texture numbers(TextureFormat::kR32ui, {1, 1});
  const Texture vectors(TextureFormat::kRg16f, {1, 1});
  EXPECT_DEATH(program.storage("Beyond", buffer), "kMaxStorageBuffers");
  EXPECT_DEATH(program.image("beyond", numbers, ImageAccess::kWrite), "kMaxImages");
  EXPECT_DEATH(program.image("first", vectors, ImageAccess::kWrite), "isImageFormat");
  EXPECT_DEATH(program.image("first", colours, ImageAccess::kReadWrite), "kReadWrite");
}

}  // namespace
}  // namespace pleinair::gpu
