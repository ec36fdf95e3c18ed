// A camera's driver that writes over its buffers as soon as they are back, on a thread and in a GL
// context of its own, which nothing orders behind the painter's commands.
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <gtest/gtest.h>

#include "pipeline/gpu/frames/camera_frames.h"
#include "pipeline/gpu/images/pixel_comparison.h"
#include "tests/support/gl_test.h"

namespace pleinair::gpu {
namespace {

constexpr hal::FrameSize kTornSize{96, 64};
constexpr std::uint32_t kTornBuffers = 6;
constexpr std::uint8_t kScribble = 255;

/// A context that shares objects with the current one; none where the driver refuses.
EGLContext sharedContext() {
  EGLDisplay display = eglGetCurrentDisplay();
  EGLint id = 0;
  eglQueryContext(display, eglGetCurrentContext(), EGL_CONFIG_ID, &id);
  const EGLint wanted[] = {EGL_CONFIG_ID, id, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (id != 0) eglChooseConfig(display, wanted, &config, 1, &count);
  const EGLint resets[] = {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_EXT,
                           EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_NONE};
  for (const EGLint reset : resets) {
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 3,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 1,
                                 reset,
                                 reset == EGL_NONE ? EGL_NONE : EGL_LOSE_CONTEXT_ON_RESET,
                                 EGL_NONE};
    EGLContext context = eglCreateContext(display, config, eglGetCurrentContext(), attributes);
    if (context != EGL_NO_CONTEXT) return context;
  }
  return EGL_NO_CONTEXT;
}

/// The driver. A frame is one level of grey, telling at one pixel.
class ScribblingDriver {
 public:
  explicit ScribblingDriver(EGLContext context) : context_(context) {
    for (std::uint32_t i = 0; i < kTornBuffers; ++i) {
      pictures_.emplace_back(
          hal::FrameFormat{.pixelFormat = hal::PixelFormat::kGrey8, .size = kTornSize});
      free_.push_back(i);
      glGenTextures(1, &names_.at(i));
      glBindTexture(GL_TEXTURE_2D, names_.at(i));
      glTexStorage2D(GL_TEXTURE_2D, 1, GL_R8, kTornSize.width, kTornSize.height);
      glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
      glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    }
    glBindTexture(GL_TEXTURE_2D, 0);
    glFinish();
    display_ = eglGetCurrentDisplay();
    thread_ = std::thread([this] { run(); });
  }
  ScribblingDriver(const ScribblingDriver&) = delete;
  ScribblingDriver& operator=(const ScribblingDriver&) = delete;
  ~ScribblingDriver() {
    end();
    eglDestroyContext(display_, context_);
  }
  /// Leases may go back after it, and are not scribbled over.
  void end() {
    if (!thread_.joinable()) return;
    {
      const std::scoped_lock lock(mutex_);
      ends_ = true;
      changed_.notify_all();
    }
    thread_.join();
  }

  GLuint texture(std::uint32_t index) const { return names_.at(index); }

  /// Held around calls of GL: Mesa's heap was corrupted, once in some thousand runs, where both
  /// threads called it at once. What the GPU executes of them overlaps all the same.
  std::unique_lock<std::mutex> turn() { return std::unique_lock(calls_); }

  /// Fills a free buffer with `level`; returns once it is written. None where all are lent.
  std::optional<hal::CapturedFrame> next(std::uint8_t level) {
    std::unique_lock lock(mutex_);
    if (free_.empty()) return std::nullopt;
    const std::uint32_t index = free_.front();
    free_.erase(free_.begin());
    order({.index = index, .level = level}, lock);
    hal::CapturedFrame frame{.image = pictures_.at(index).view()};
    frame.dmaBufs[0] = {.fd = 4000 + static_cast<int>(index),
                        .strideBytes = static_cast<std::size_t>(kTornSize.width)};
    frame.buffer = {.pool = pool_, .index = index};
    frame.lease = std::shared_ptr<const void>(&pictures_.at(index), [this, index](const void*) {
      const std::scoped_lock returned(mutex_);
      returned_.push_back(index);
      changed_.notify_all();
    });
    return frame;
  }
  /// Returns once every buffer that is back has been written over.
  void scribble() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return returned_.empty() && !isBusy_; });
  }

 private:
  struct Order {
    std::uint32_t index = 0;
    std::uint8_t level = 0;
  };

  void order(Order order, std::unique_lock<std::mutex>& lock) {
    order_ = order;
    changed_.notify_all();
    changed_.wait(lock, [this] { return !order_; });
  }

  void run() {
    {
      const auto held = turn();
      eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
    }
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [this] { return ends_ || order_ || !returned_.empty(); });
      if (ends_) break;
      isBusy_ = true;
      if (!returned_.empty()) {
        const std::uint32_t index = returned_.front();
        lock.unlock();
        write(index, kScribble);
        lock.lock();
        returned_.erase(returned_.begin());
        free_.push_back(index);
      } else {
        const Order order = *order_;
        lock.unlock();
        write(order.index, order.level);
        lock.lock();
        order_.reset();
      }
      isBusy_ = false;
      changed_.notify_all();
    }
    lock.unlock();
    const auto held = turn();
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }

  void write(std::uint32_t index, std::uint8_t level) {
    const std::span<std::uint8_t> pixels = pictures_.at(index).plane(0);
    std::ranges::fill(pixels, level);
    pixels[0] = static_cast<std::uint8_t>(level ^ 0x80);
    const auto held = turn();
    glBindTexture(GL_TEXTURE_2D, names_.at(index));
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kTornSize.width, kTornSize.height, GL_RED,
                    GL_UNSIGNED_BYTE, pixels.data());
    glFinish();
  }

  std::array<GLuint, kTornBuffers> names_{};
  EGLContext context_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  std::vector<hal::Image> pictures_;
  std::uint64_t pool_ = hal::nextBufferPool();
  std::mutex calls_;  // taken before mutex_, where both are
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Order> order_;
  std::vector<std::uint32_t> free_, returned_;
  bool isBusy_ = false, ends_ = false;
  std::thread thread_;
};

class TornFrames : public support::GlTest {
 protected:
  /// How many of `count` frames are shown in another colour than the camera gave them.
  int tornOf(int count, bool returnsEarly) {
    EGLContext shared = sharedContext();
    if (shared == EGL_NO_CONTEXT) {
      ADD_FAILURE() << "this driver shares no objects between contexts";
      return -1;
    }
    ScribblingDriver driver(shared);
    GpuTestHook hook;
    hook.returnsFramesEarly = returnsEarly;
    std::vector<GLuint> names;
    hook.importPlane = [&](const hal::GpuSurface& surface) {
      return driver.texture(static_cast<std::uint32_t>(surface.surface.id));
    };
    const ShaderLibrary library;
    auto making = driver.turn();
    CameraFrames frames(library, context_->info(), hook);
    making.unlock();
    int torn = 0;
    for (int i = 0; i < count; ++i) {
      const auto level = static_cast<std::uint8_t>(10 + i % 200);
      std::optional<hal::CapturedFrame> frame = driver.next(level);
      while (!frame) {
        {
          const auto held = driver.turn();
          glFlush();
          frames.releaseRead();
        }
        driver.scribble();
        frame = driver.next(level);
      }
      auto held = driver.turn();
      const Texture& shown = frames.show(*frame, kTornSize, aspectFill(kTornSize, kTornSize));
      held.unlock();
      frame.reset();      // the consumer is done with it, the GPU may not be
      driver.scribble();  // the driver rests when it returns
      const std::vector<std::uint8_t> pixels = pixelsOf(shown);
      if (pixels[4 * (kTornSize.pixels() / 2)] != level) ++torn;
    }
    driver.end();
    importedFrames_ = frames.status().imported;
    EXPECT_EQ(frames.status().path, FramePath::kImported) << frames.status().reason;
    return torn;
  }

  std::uint64_t importedFrames_ = 0;
};

TEST_F(TornFrames, AreNoneOfAThousand) {
  EXPECT_EQ(tornOf(1000, false), 0);
  EXPECT_EQ(importedFrames_, 1000u);
}

TEST_F(TornFrames, AreMostWhereLeasesGoBackBeforeTheFence) {
  EXPECT_GT(tornOf(100, true), 50);
}

}  // namespace
}  // namespace pleinair::gpu
