#include <array>
#include <initializer_list>

#include <gmock/gmock.h>

#include "pipeline/gpu/programs/host_state.h"
#include "pipeline/gpu/programs/program.h"
#include "tests/gpu/painter/painter_fixture.h"
#include "tests/support/gl_test.h"

namespace pleinair {
namespace {

constexpr hal::FrameSize kSize{96, 64};
constexpr std::array<GLint, 4> kViewport{3, 4, 50, 60};
const PainterOptions kHosted{.pictureSize = kSize, .context = PainterContext::kHost};

GLint stateOf(GLenum name) {
  GLint value = -1;
  glGetIntegerv(name, &value);
  return value;
}

GLint stateOf(GLenum name, unsigned index) {
  GLint value = -1;
  glGetIntegeri_v(name, index, &value);
  return value;
}

void expectNothingBound() {
  for (const GLenum binding : std::initializer_list<GLenum>{
           GL_DRAW_FRAMEBUFFER_BINDING, GL_READ_FRAMEBUFFER_BINDING, GL_CURRENT_PROGRAM,
           GL_VERTEX_ARRAY_BINDING, GL_ARRAY_BUFFER_BINDING, GL_COPY_READ_BUFFER_BINDING,
           GL_COPY_WRITE_BUFFER_BINDING, GL_PIXEL_PACK_BUFFER_BINDING,
           GL_PIXEL_UNPACK_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_BINDING}) {
    EXPECT_EQ(stateOf(binding), 0) << std::hex << binding;
  }
  for (unsigned i = 0; i < gpu::kMaxStorageBuffers; ++i) {
    EXPECT_EQ(stateOf(GL_SHADER_STORAGE_BUFFER_BINDING, i), 0) << i;
  }
  for (unsigned i = 0; i < gpu::kMaxImages; ++i) {
    EXPECT_EQ(stateOf(GL_IMAGE_BINDING_NAME, i), 0) << i;
  }
  EXPECT_EQ(stateOf(GL_ACTIVE_TEXTURE), GL_TEXTURE0);
  for (unsigned unit = 0; unit < gpu::kMaxTextureUnits; ++unit) {
    glActiveTexture(GL_TEXTURE0 + unit);
    EXPECT_EQ(stateOf(GL_TEXTURE_BINDING_2D), 0) << unit;
    EXPECT_EQ(stateOf(GL_SAMPLER_BINDING), 0) << unit;
  }
  glActiveTexture(GL_TEXTURE0);
}

void expectSwitchesOfANewContext() {
  for (const GLenum feature :
       std::initializer_list<GLenum>{GL_BLEND, GL_CULL_FACE, GL_DEPTH_TEST, GL_SCISSOR_TEST,
                                     GL_STENCIL_TEST, GL_RASTERIZER_DISCARD}) {
    EXPECT_FALSE(glIsEnabled(feature)) << std::hex << feature;
  }
  EXPECT_EQ(stateOf(GL_DEPTH_WRITEMASK), GL_TRUE);
  EXPECT_EQ(stateOf(GL_DEPTH_FUNC), GL_LESS);
  EXPECT_EQ(stateOf(GL_FRONT_FACE), GL_CCW);
  EXPECT_EQ(stateOf(GL_PACK_ALIGNMENT), 4);
  EXPECT_EQ(stateOf(GL_UNPACK_ALIGNMENT), 4);
  EXPECT_EQ(stateOf(GL_UNPACK_ROW_LENGTH), 0);
  std::array<GLint, 4> viewport{};
  glGetIntegerv(GL_VIEWPORT, viewport.data());
  EXPECT_EQ(viewport, kViewport);
}

/// GL state that a host's drawing may leave behind and that would spoil the Painter's.
class UntidyHost {
 public:
  UntidyHost() : texture_(gpu::TextureFormat::kRgba8, {4, 4}) { glGenSamplers(1, &sampler_); }
  ~UntidyHost() { glDeleteSamplers(1, &sampler_); }
  UntidyHost(const UntidyHost&) = delete;
  UntidyHost& operator=(const UntidyHost&) = delete;

  void draw() const {
    glViewport(kViewport[0], kViewport[1], kViewport[2], kViewport[3]);
    for (const GLenum feature :
         std::initializer_list<GLenum>{GL_BLEND, GL_CULL_FACE, GL_DEPTH_TEST, GL_SCISSOR_TEST}) {
      glEnable(feature);
    }
    glBlendFunc(GL_ONE, GL_ONE);
    glScissor(1, 1, 2, 2);
    glColorMask(GL_TRUE, GL_FALSE, GL_TRUE, GL_FALSE);
    glDepthMask(GL_FALSE);
    glFrontFace(GL_CW);
    glPixelStorei(GL_UNPACK_SKIP_ROWS, 1);
    glPixelStorei(GL_PACK_ROW_LENGTH, 200);
    glActiveTexture(GL_TEXTURE3);
    glBindTexture(GL_TEXTURE_2D, texture_.name());
    glBindSampler(0, sampler_);
  }

 private:
  gpu::Texture texture_;
  GLuint sampler_ = 0;
};

class HostContextTest : public support::GlTest {};

TEST_F(HostContextTest, PaintsAsInAContextOfItsOwn) {
  Painter own({.pictureSize = kSize});
  Painter hosted(kHosted);
  EXPECT_EQ(hosted.contextInfo().platform, "host");
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(painted(hosted, testFrame(i)), painted(own, testFrame(i))) << i;
  }
}

TEST_F(HostContextTest, HandsTheHostItsTexture) {
  Painter painter(kHosted);
  const auto picture = painter.paint(testFrame(0), painter.defaultParameters());
  ASSERT_TRUE(picture);
  ASSERT_TRUE(glIsTexture(picture->texture));
  const auto framebuffer = gpu::FramebufferHandle::make();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.get());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, picture->texture, 0);
  std::vector<std::uint8_t> rgba(static_cast<std::size_t>(kSize.pixels()) * 4);
  glReadPixels(0, 0, kSize.width, kSize.height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  const auto rgb = bytesOf(hal::orThrow(painter.snapshot()));
  for (std::size_t i = 0; i < rgb.size(); ++i) ASSERT_EQ(rgba[i / 3 * 4 + i % 3], rgb[i]) << i;
}

TEST_F(HostContextTest, LeavesTheHostsContextAsNew) {
  glViewport(kViewport[0], kViewport[1], kViewport[2], kViewport[3]);
  {
    Painter painter(kHosted);
    expectNothingBound();
    const int readback = painter.openReadback({hal::PixelFormat::kI420, kSize});
    OutputFrame picture;
    for (int i = 0; i < 2; ++i) {
      ASSERT_TRUE(painter.paint(testFrame(i), painter.defaultParameters()));
      expectNothingBound();
      expectSwitchesOfANewContext();
    }
    ASSERT_TRUE(hal::orThrow(painter.wait(readback, picture)));
    hal::orThrow(painter.snapshot());
    expectNothingBound();
    expectSwitchesOfANewContext();
  }
  expectNothingBound();
  expectSwitchesOfANewContext();
}

TEST_F(HostContextTest, PaintsWhateverTheHostHasSet) {
  Painter own({.pictureSize = kSize});
  const UntidyHost host;
  host.draw();
  Painter painter(kHosted);
  for (int i = 0; i < 2; ++i) {
    host.draw();
    ASSERT_TRUE(painter.paint(testFrame(i), painter.defaultParameters()));
    expectNothingBound();
    expectSwitchesOfANewContext();
    host.draw();
    EXPECT_EQ(bytesOf(hal::orThrow(painter.snapshot())), painted(own, testFrame(i))) << i;
  }
  const gpu::HostState tidy;
}

TEST_F(HostContextTest, IsCurrentAgainAfterEachCallOfAPainterWithItsOwn) {
  {
    Painter own({.pictureSize = kSize});
    EXPECT_TRUE(context_->isCurrent());
    const int readback = own.openReadback({hal::PixelFormat::kRgb8, kSize});
    EXPECT_TRUE(context_->isCurrent());
    ASSERT_TRUE(own.paint(testFrame(0), own.defaultParameters()));
    EXPECT_TRUE(context_->isCurrent());
    OutputFrame picture;
    ASSERT_TRUE(hal::orThrow(own.wait(readback, picture)));
    EXPECT_TRUE(context_->isCurrent());
    own.reset();
    own.closeReadback(readback);
    EXPECT_TRUE(context_->isCurrent());
  }
  EXPECT_TRUE(context_->isCurrent()) << "and after its end";
  EXPECT_THROW(Painter({.pictureSize = kSize, .style = "gouache"}), hal::Failure);
  EXPECT_TRUE(context_->isCurrent()) << "and after one that could not be made";
}

TEST_F(PainterTest, SeveralOfOneThreadHaveTheirOwnContexts) {
  auto first = std::make_unique<Painter>(PainterOptions{.pictureSize = kSize});
  Painter second({.pictureSize = kSize});
  const auto wanted = painted(*first, testFrame(0));
  EXPECT_EQ(painted(second, testFrame(0)), wanted);
  first.reset();  // before the one that came after it
  EXPECT_TRUE(second.paint(testFrame(1), second.defaultParameters()));
  Painter third({.pictureSize = kSize});
  EXPECT_EQ(painted(third, testFrame(0)), wanted);
}

TEST_F(PainterTest, KeepsItsContextOnAThreadThatHasNoOther) {
  Painter painter({.pictureSize = kSize});
  EGLContext context = eglGetCurrentContext();
  EXPECT_NE(context, EGL_NO_CONTEXT);
  ASSERT_TRUE(painter.paint(testFrame(0), painter.defaultParameters()));
  EXPECT_EQ(eglGetCurrentContext(), context);
}

TEST(PainterInAHostsContext, SaysWhereThereIsNone) {
  try {
    const Painter painter(kHosted);
    FAIL() << "made";
  } catch (const hal::Failure& error) {
    EXPECT_EQ(error.error().kind, hal::ErrorKind::kUnsupported);
    EXPECT_THAT(error.what(), testing::HasSubstr("no context is current"));
  }
}

}  // namespace
}  // namespace pleinair
