// A lost GPU, injected where the driver is asked.
#include <atomic>

#include <gmock/gmock.h>

#include "pipeline/gpu/gl.h"
#include "tests/gpu/painter/painter_fixture.h"
#include "tests/support/gl_test.h"

namespace pleinair {
namespace {

constexpr hal::FrameSize kSize{96, 64};

/// A driver that loses the GPU when told to.
struct BadDriver {
  unsigned status = GL_NO_ERROR;
  bool hangs = false;
  int fencesAsked = 0;
  mutable hal::SteppedClock clock;

  gpu::GpuTestHook testHook() {
    return {.resetStatus = [this] { return status; },
            .waitForFence = [this](std::uint64_t timeoutNs) -> unsigned {
              ++fencesAsked;
              if (!hangs) {
                glFinish();
                return GL_ALREADY_SIGNALED;
              }
              // Like drivers that cap waits.
              clock.advance(std::min(hal::Duration(timeoutNs), hal::Duration(700'000'000)));
              return GL_TIMEOUT_EXPIRED;
            },
            .patience = std::chrono::milliseconds(1999),
            .clock = &clock};
  }
};

template <class T>
void expectLost(const hal::Result<T>& result) {
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, hal::ErrorKind::kDeviceLost);
}

void expectLost(const hal::Answer& answer) {
  ASSERT_TRUE(answer.hasError());
  EXPECT_EQ(answer.error().kind, hal::ErrorKind::kDeviceLost);
}

/// All calls of a Painter whose GPU is gone.
void expectNothingComes(Painter& painter, int readback) {
  OutputFrame picture;
  const PaintParameters parameters = painter.defaultParameters();
  for (int round = 0; round < 2; ++round) {
    expectLost(painter.paint(testFrame(7), parameters));
    expectLost(painter.poll(readback, picture));
    expectLost(painter.wait(readback, picture));
    expectLost(painter.waitForAny(std::chrono::minutes(1)));
    expectLost(painter.snapshot());
    expectLost(painter.cameraSnapshot());
    painter.reset();
    EXPECT_EQ(painter.skipped(readback), 0U);
    EXPECT_FALSE(painter.views().empty());
    try {
      painter.openReadback({hal::PixelFormat::kRgb8, kSize});
      ADD_FAILURE() << "opened";
    } catch (const hal::Failure& error) {
      EXPECT_EQ(error.error().kind, hal::ErrorKind::kDeviceLost);
    }
  }
}

TEST_F(PainterTest, AnswersALostGpuWithValuesForEver) {
  Painter healthy({.pictureSize = kSize});
  const auto wanted = painted(healthy, testFrame(0));
  for (const unsigned why :
       {GL_GUILTY_CONTEXT_RESET_KHR, GL_INNOCENT_CONTEXT_RESET_KHR, GL_UNKNOWN_CONTEXT_RESET_KHR}) {
    BadDriver driver;
    {
      Painter painter({.pictureSize = kSize, .qualityLevels = true, .testHook = driver.testHook()});
      const int readback = painter.openReadback({hal::PixelFormat::kRgb8, kSize});
      EXPECT_EQ(painted(painter, testFrame(0)), wanted);
      driver.status = why;
      const auto refused = painter.paint(testFrame(1), painter.defaultParameters());
      expectLost(refused);
      EXPECT_EQ(refused.error().code, static_cast<int>(why));
      EXPECT_THAT(refused.error().message(), testing::StartsWith("GPU: was reset"));
      driver.status = GL_NO_ERROR;  // as drivers answer once they have told
      expectNothingComes(painter, readback);
    }
    Painter next({.pictureSize = kSize});
    EXPECT_EQ(painted(next, testFrame(0)), wanted) << "another one works";
  }
}

TEST_F(PainterTest, TakesAGpuThatDoesNotAnswerForLost) {
  BadDriver driver;
  Painter painter({.pictureSize = kSize, .testHook = driver.testHook()});
  const int readback = painter.openReadback({hal::PixelFormat::kRgb8, kSize});
  ASSERT_TRUE(painter.paint(testFrame(0), painter.defaultParameters()));
  driver.hangs = true;
  OutputFrame picture;
  EXPECT_FALSE(hal::orThrow(painter.poll(readback, picture))) << "it may only be late";
  const hal::TimePoint before = driver.clock.now();
  driver.fencesAsked = 0;
  const auto taken = painter.wait(readback, picture);
  expectLost(taken);
  EXPECT_THAT(taken.error().message(), testing::HasSubstr("hangs"));
  EXPECT_EQ(driver.fencesAsked, 3);
  EXPECT_EQ(driver.clock.now() - before, std::chrono::milliseconds(1999));
  driver.hangs = false;
  expectNothingComes(painter, readback);
}

TEST_F(PainterTest, WaitsForAPictureNoLongerThanItMay) {
  BadDriver driver;
  Painter painter({.pictureSize = kSize, .testHook = driver.testHook()});
  const int readback = painter.openReadback({hal::PixelFormat::kRgb8, kSize});
  ASSERT_TRUE(painter.paint(testFrame(0), painter.defaultParameters()));
  driver.hangs = true;
  const hal::TimePoint before = driver.clock.now();
  driver.fencesAsked = 0;
  EXPECT_FALSE(hal::orThrow(painter.waitForAny(std::chrono::milliseconds(1))));
  EXPECT_EQ(driver.fencesAsked, 1) << "not again and again";
  EXPECT_EQ(driver.clock.now() - before, std::chrono::milliseconds(1));
  driver.hangs = false;
  OutputFrame picture;
  EXPECT_TRUE(hal::orThrow(painter.wait(readback, picture))) << "it was only late";
}

TEST_F(PainterTest, ClosesAReadbackOfALostGpu) {
  BadDriver driver;
  Painter painter({.pictureSize = kSize, .testHook = driver.testHook()});
  const int readback = painter.openReadback({hal::PixelFormat::kRgb8, kSize});
  ASSERT_TRUE(painter.paint(testFrame(0), painter.defaultParameters()));
  driver.status = GL_GUILTY_CONTEXT_RESET_KHR;
  expectLost(painter.paint(testFrame(1), painter.defaultParameters()));
  painter.closeReadback(readback);
  expectLost(painter.paint(testFrame(1), painter.defaultParameters()));
}

TEST_F(PainterTest, NoticesALossWhileASnapshotIsWaitedFor) {
  BadDriver driver;
  Painter painter({.pictureSize = kSize, .testHook = driver.testHook()});
  const int readback = painter.openReadback({hal::PixelFormat::kRgb8, kSize});
  ASSERT_TRUE(painter.paint(testFrame(0), painter.defaultParameters()));
  driver.hangs = true;
  expectLost(painter.snapshot());
  driver.hangs = false;
  expectNothingComes(painter, readback);
}

TEST_F(PainterTest, SaysAtStartWhereTheGpuIsLostByThen) {
  BadDriver driver;
  driver.hangs = true;
  Painter painter({.pictureSize = kSize, .testHook = driver.testHook()});
  EXPECT_THROW(painter.openReadback({hal::PixelFormat::kRgb8, kSize}), hal::Failure);
}

TEST_F(PainterTest, ItsContextTellsOfResetsWhereTheDriverCan) {
  const Painter painter({.pictureSize = kSize});
  if (!painter.contextInfo().tellsOfResets) {
    GTEST_SKIP() << painter.contextInfo().renderer << " has no reset notification";
  }
  gpu::EglContext context;
  EXPECT_TRUE(gpu::ResetMonitor().check()) << "a healthy one";
}

class LostHostContextTest : public support::GlTest {};

/// The Painter's objects stay in the lost context; a new Painter in the host's next context works.
TEST_F(LostHostContextTest, IsLeftAsItIs) {
  BadDriver driver;
  auto lost = std::make_unique<Painter>(PainterOptions{
      .pictureSize = kSize, .context = PainterContext::kHost, .testHook = driver.testHook()});
  const int readback = lost->openReadback({hal::PixelFormat::kRgb8, kSize});
  const auto picture = lost->paint(testFrame(0), lost->defaultParameters());
  ASSERT_TRUE(picture);
  const unsigned texture = picture->texture;
  driver.status = GL_UNKNOWN_CONTEXT_RESET_KHR;
  expectLost(lost->paint(testFrame(1), lost->defaultParameters()));
  {
    EGLDisplay display = eglGetCurrentDisplay();
    EGLContext dead = eglGetCurrentContext();
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    {
      const gpu::EglContext anew;
      Painter next({.pictureSize = kSize, .context = PainterContext::kHost});
      expectNothingComes(*lost, readback);
      lost.reset();  // with another context current
      EXPECT_TRUE(next.paint(testFrame(0), next.defaultParameters()));
    }
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, dead);
  }
  EXPECT_TRUE(glIsTexture(texture)) << "not touched";
}

}  // namespace
}  // namespace pleinair
