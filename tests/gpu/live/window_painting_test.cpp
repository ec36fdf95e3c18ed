// A Painter that draws straight into a window's textures, on a private X server: the same pixels as
// a copy gives, and what becomes of it when the server dies.
#include <algorithm>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/outputs/window/window.h"
#include "hal/surface_pattern.h"
#include "pipeline/engine/painter.h"
#include "tests/support/environment.h"
#include "tests/support/test_pictures.h"
#include "tests/support/x_server.h"

namespace pleinair {
namespace {

using hal::orThrow;

constexpr hal::FrameSize kPicture{320, 240};

/// Carries out one piece of work at a time on a thread of its own.
class PaintThread {
 public:
  PaintThread() : thread_([this] { work(); }) {}
  ~PaintThread() {
    {
      const std::scoped_lock lock(mutex_);
      isEnding_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  PaintThread(const PaintThread&) = delete;
  PaintThread& operator=(const PaintThread&) = delete;

  void run(std::function<void()> work) {
    std::unique_lock lock(mutex_);
    work_ = std::move(work);
    changed_.notify_all();
    changed_.wait(lock, [this] { return work_ == nullptr; });
  }

 private:
  void work() {
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [this] { return work_ != nullptr || isEnding_; });
      if (work_ == nullptr) return;
      work_();
      work_ = nullptr;
      changed_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<void()> work_;
  bool isEnding_ = false;
  std::thread thread_;
};

/// A window with textures, and a Painter that draws into them on its own thread.
class PaintedWindow {
 public:
  explicit PaintedWindow(hal::WindowSettings settings, std::size_t textures = 3)
      : window_(orThrow(hal::openWindow(insisting(std::move(settings))))) {
    const hal::OutputFormat format = orThrow(window_->start({.size = kPicture}));
    void* const display = orThrow(lender().eglDisplay());
    surfaces_ = orThrow(lender().lendToGpu({}, textures));
    thread_.run([&, display] {
      painter_.emplace(
          PainterOptions{.pictureSize = kPicture, .style = "none", .windows = display});
      drawn_ = painter_->openReadback(format.frame);
      copied_ = painter_->openReadback(format.frame);
      imported_ = painter_->importSurfaces(drawn_, surfaces_);
      info_ = painter_->contextInfo();
    });
  }
  ~PaintedWindow() {
    thread_.run([&] { painter_.reset(); });
  }
  PaintedWindow(const PaintedWindow&) = delete;
  PaintedWindow& operator=(const PaintedWindow&) = delete;

  hal::Window& window() { return *window_; }
  hal::GpuSurfaceLender& lender() { return *window_->lender(); }
  const std::vector<hal::GpuSurface>& surfaces() const { return surfaces_; }
  const gpu::ContextInfo& info() const { return info_; }
  const hal::Result<void>& imported() const { return imported_; }

  /// Paints a picture into a texture, and returns what is read back of it.
  hal::Image paint(int number, hal::SurfaceId into) {
    OutputFrame drawn;
    OutputFrame copied;
    thread_.run([&] {
      auto image = std::make_shared<const hal::Image>(support::testPicture(
          {.pixelFormat = hal::PixelFormat::kRgb8, .size = kPicture, .encoding = {}}, number));
      painter_->drawNextInto(drawn_, {.loan = 1, .id = into});
      const hal::CapturedFrame frame{.image = image->view(),
                                     .sequence = static_cast<std::uint64_t>(number),
                                     .captureTime = {},
                                     .lease = image};
      orThrow(painter_->paint(frame, painter_->defaultParameters()));
      EXPECT_TRUE(painter_->wait(drawn_, drawn).isYes());
      EXPECT_TRUE(painter_->wait(copied_, copied).isYes());
    });
    EXPECT_EQ(drawn.surface, (hal::LentSurface{.loan = 1, .id = into}));
    EXPECT_FALSE(copied.surface.has_value());
    return std::move(copied.image);
  }

 private:
  /// The server of these tests is drawn by software.
  static hal::WindowSettings insisting(hal::WindowSettings settings) {
    settings.lending = hal::WindowSettings::Lending::kAlways;
    return settings;
  }

  std::unique_ptr<hal::Window> window_;
  std::vector<hal::GpuSurface> surfaces_;
  std::optional<Painter> painter_;
  int drawn_ = 0;
  int copied_ = 0;
  hal::Result<void> imported_;
  gpu::ContextInfo info_;
  PaintThread thread_;
};

class WindowPainting : public testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = support::XServer::missing(); !missing.empty()) {
      GTEST_SKIP() << missing;
    }
    server_.emplace();
    support::setVariable("SDL_VIDEODRIVER", "x11");
    support::setVariable("DISPLAY", server_->display().c_str());
  }

  static bool isSame(const hal::Image& one, const hal::Image& other) {
    return one.format() == other.format() &&
           std::ranges::equal(one.view().planes[0].bytes, other.view().planes[0].bytes);
  }

  std::optional<support::XServer> server_;
};

TEST_F(WindowPainting, TheTrialsPatternArrivesInEachTexture) {
  PaintedWindow painted({});
  EXPECT_EQ(painted.info().platform, "window");
  EXPECT_EQ(painted.info().apartBecause, "");
  ASSERT_TRUE(painted.imported()) << painted.imported().error().message();
  for (const hal::GpuSurface& each : painted.surfaces()) {
    const hal::Image seen = orThrow(painted.lender().copyOfGpuSurface(each.surface.id, true));
    const auto same = hal::checkSurfacePattern(seen.view(), each.surface.id);
    EXPECT_TRUE(same) << same.error().message();
  }
}

TEST_F(WindowPainting, ShowsThePixelsThatACopyGives) {
  struct Case {
    hal::WindowSettings settings;
    const char* name;
  };
  for (const Case& each :
       {Case{{}, "plain"}, Case{{.isFullScreen = true}, "scaled"},
        Case{{.isFullScreen = true, .quarterTurns = 1}, "turned"},
        Case{{.quarterTurns = 2, .isMirrored = true}, "upside down in a mirror"}}) {
    SCOPED_TRACE(each.name);
    PaintedWindow painted(each.settings);
    for (int i = 0; i < 6; ++i) {  // more than there are textures
      std::optional<hal::SurfaceId> free;
      while (!free) free = orThrow(painted.lender().acquireForGpu());
      const hal::Image copy = painted.paint(i, *free);
      orThrow(painted.window().show(*free, {}));
      const hal::Image direct = orThrow(painted.window().shown());
      EXPECT_TRUE(isSame(orThrow(painted.lender().copyOfGpuSurface(*free, false)), copy));
      orThrow(painted.window().write(copy.view(), {}));
      EXPECT_TRUE(isSame(direct, orThrow(painted.window().shown()))) << "picture " << i;
    }
  }
}

TEST_F(WindowPainting, TheServersScreenHasThePicture) {
  PaintedWindow painted({});
  const hal::SurfaceId free = *orThrow(painted.lender().acquireForGpu());
  const hal::Image copy = painted.paint(3, free);
  orThrow(painted.window().show(free, {}));
  const hal::Image screen = [&] {
    hal::Image seen = server_->screen();
    const auto isThere = [&] {  // the middle of the window's first row
      return seen.row(0, 180)[3 * 400] == copy.view().row(0, 0)[4 * 160];
    };
    for (int i = 0; i < 200 && !isThere(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      seen = server_->screen();
    }
    return seen;
  }();
  int wrong = 0;
  for (int y = 0; y < kPicture.height; ++y) {
    const auto shown = screen.view().row(0, 180 + y).subspan(3 * 240);
    const auto row = copy.view().row(0, y);
    for (std::size_t x = 0; x < 320; ++x) {
      wrong += std::equal(&row[4 * x], &row[4 * x] + 3, &shown[3 * x]) ? 0 : 1;
    }
  }
  EXPECT_EQ(wrong, 0);
}

TEST_F(WindowPainting, ATextureIsFreeOnceAnotherIsSeen) {
  PaintedWindow painted({}, 2);
  const hal::SurfaceId first = *orThrow(painted.lender().acquireForGpu());
  const hal::SurfaceId second = *orThrow(painted.lender().acquireForGpu());
  EXPECT_NE(first, second);
  EXPECT_EQ(orThrow(painted.lender().acquireForGpu()), std::nullopt);
  painted.paint(0, first);
  orThrow(painted.window().show(first, {}));
  EXPECT_EQ(orThrow(painted.lender().acquireForGpu()), std::nullopt) << "it is seen";
  painted.paint(1, second);
  orThrow(painted.window().show(second, {}));
  std::optional<hal::SurfaceId> free;
  for (int i = 0; i < 2000 && !free; ++i) {
    free = orThrow(painted.lender().acquireForGpu());
    std::this_thread::yield();
  }
  EXPECT_EQ(free, first);
}

TEST_F(WindowPainting, ANewLoanLeavesWhatIsSeen) {
  PaintedWindow painted({});
  const hal::SurfaceId free = *orThrow(painted.lender().acquireForGpu());
  painted.paint(2, free);
  orThrow(painted.window().show(free, {}));
  const hal::Image before = orThrow(painted.window().shown());
  orThrow(painted.lender().lendToGpu({}, 4));
  EXPECT_TRUE(isSame(before, orThrow(painted.window().shown())));
  EXPECT_FALSE(painted.lender().copyOfGpuSurface(free, false)) << "it is of another loan";
}

TEST_F(WindowPainting, LendsNothingWhereItIsSetToCopy) {
  const auto window = orThrow(hal::openWindow({.lending = hal::WindowSettings::Lending::kNever}));
  orThrow(window->start({.size = kPicture}));
  const auto display = window->lender()->eglDisplay();
  ASSERT_FALSE(display);
  EXPECT_EQ(display.error().message(), "window: is set to copy pictures (scan_out)");
}

TEST_F(WindowPainting, LendsNothingOfSoftwareUnlessAsked) {
  const auto window = orThrow(hal::openWindow());
  orThrow(window->start({.size = kPicture}));
  const auto display = window->lender()->eglDisplay();
  if (display) GTEST_SKIP() << "this server is drawn by a GPU";
  EXPECT_THAT(display.error().message(), testing::HasSubstr("is drawn by software (llvmpipe"));
}

/// The Painter's context is on the display of a server that dies. Ends the process.
[[noreturn]] void loseTheServer() {
  support::XServer server;
  support::setVariable("SDL_VIDEODRIVER", "x11");
  support::setVariable("DISPLAY", server.display().c_str());
  const auto say = [](const char* text) { std::fputs(text, stderr); };
  {
    PaintedWindow painted({});
    const hal::SurfaceId first = *orThrow(painted.lender().acquireForGpu());
    const hal::SurfaceId second = *orThrow(painted.lender().acquireForGpu());
    painted.paint(0, first);
    if (painted.window().show(first, {})) say("shown, ");
    server.kill();
    const hal::Image copy = painted.paint(1, second);
    if (copy.size() == kPicture) say("painted, ");
    const auto isLost = [](const auto& result) {
      return !result && result.error().kind == hal::ErrorKind::kDeviceLost;
    };
    if (isLost(painted.window().show(second, {}))) say("lost, ");
    if (isLost(painted.lender().acquireForGpu()) && isLost(painted.lender().lendToGpu({}, 2)) &&
        isLost(painted.lender().copyOfGpuSurface(first, true))) {
      say("lends nothing, ");
    }
  }
  {
    const Painter other({.pictureSize = kPicture, .style = "none"});
    if (other.contextInfo().platform != "window") say("another painter, ");
  }
  say("goes on");
  std::exit(0);  // NOLINT(concurrency-mt-unsafe): a child of its own
}

TEST(WindowPaintingDeathTest, AServerThatDiesTakesNoPainterAlong) {
  if (const std::string missing = support::XServer::missing(); !missing.empty()) {
    GTEST_SKIP() << missing;
  }
  EXPECT_EXIT(loseTheServer(), testing::ExitedWithCode(0),
              "shown, painted, lost, lends nothing, another painter, goes on");
}

}  // namespace
}  // namespace pleinair
