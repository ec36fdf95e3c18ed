// Tests the window on SDL's "dummy" driver, without a display.
#include "hal/outputs/window/window.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>

#include <SDL.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/environment.h"
#include "tests/support/x_server.h"

namespace pleinair::hal {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// An opaque image whose neighbouring pixels all differ.
Image colours(FrameSize size) {
  Image image({.pixelFormat = PixelFormat::kRgba8, .size = size});
  for (int y = 0; y < size.height; ++y) {
    const auto row = image.row(0, y);
    for (int x = 0; x < size.width; ++x) {
      const auto at = std::size_t{4} * static_cast<std::size_t>(x);
      row[at] = static_cast<std::uint8_t>(7 * x + 3 * y + 1);
      row[at + 1] = static_cast<std::uint8_t>(x * y);
      row[at + 2] = static_cast<std::uint8_t>(255 - x);
      row[at + 3] = 255;
    }
  }
  return image;
}

struct Rgb {
  int r, g, b;
  friend bool operator==(const Rgb&, const Rgb&) = default;
};

Rgb at(Image& image, int x, int y) {
  const std::size_t channels = image.format().pixelFormat == PixelFormat::kRgba8 ? 4 : 3;
  const auto pixel = image.row(0, y).subspan(static_cast<std::size_t>(x) * channels, 3);
  return {pixel[0], pixel[1], pixel[2]};
}

/// The window that SDL opened last.
SDL_Window* newestSdlWindow() {
  SDL_Window* newest = nullptr;
  for (Uint32 id = 1; id < 100; ++id) {
    if (SDL_Window* window = SDL_GetWindowFromID(id); window != nullptr) newest = window;
  }
  return newest;
}

void pushKey(SDL_Window* window, SDL_Keycode code, int modifiers = KMOD_NONE, bool repeat = false) {
  SDL_Event event{};
  event.type = SDL_KEYDOWN;
  event.key.windowID = window == nullptr ? 0 : SDL_GetWindowID(window);
  event.key.repeat = repeat ? 1 : 0;
  event.key.keysym.sym = code;
  event.key.keysym.mod = static_cast<Uint16>(modifiers);
  SDL_PushEvent(&event);
}

void pushClose(SDL_Window* window) {
  SDL_Event event{};
  event.type = SDL_WINDOWEVENT;
  event.window.windowID = SDL_GetWindowID(window);
  event.window.event = SDL_WINDOWEVENT_CLOSE;
  SDL_PushEvent(&event);
}

class WindowTest : public testing::Test {
 protected:
  WindowTest() { support::setVariable("SDL_VIDEODRIVER", "dummy"); }

  static std::unique_ptr<Window> open(FrameSize size, WindowSettings settings = {}) {
    std::unique_ptr<Window> window = orThrow(openWindow(std::move(settings)));
    const OutputFormat format = orThrow(window->start({.size = size}));
    EXPECT_EQ(format.frame, (FrameFormat{.pixelFormat = PixelFormat::kRgba8, .size = size}));
    window->takeEvents();  // discards the events of opening
    return window;
  }
};

/// A window on an X server that is killed; ends the process as a test's child.
[[noreturn]] void loseTheServer() {
  support::XServer server;
  support::setVariable("SDL_VIDEODRIVER", "x11");
  support::setVariable("DISPLAY", server.display().c_str());
  const auto say = [](const char* text) { std::fputs(text, stderr); };
  {
    const std::unique_ptr<Window> window = orThrow(openWindow());
    orThrow(window->start({.size = {64, 48}}));
    const Image picture = colours({64, 48});
    window->setCaption("caption", 1.0);
    if (window->write(picture.view(), {})) say("shown, ");
    server.kill();
    window->takeEvents();
    const Result<void> written = window->write(picture.view(), {});
    if (!written && written.error().kind == ErrorKind::kDeviceLost) say("lost, ");
    if (!window->shown()) say("not read, ");
    window->setTitle("title");
    window->setFullScreen(true);
    window->setCaption("other", 1.0);
    if (window->takeEvents().empty()) say("no events, ");
  }
  const auto again = openWindow();
  if (!again && again.error().kind == ErrorKind::kDeviceLost) say("not opened again, ");
  say("goes on");
  std::exit(0);  // NOLINT(concurrency-mt-unsafe): a child of its own
}

TEST(WindowOnXDeathTest, AServerThatDiesIsALossOfTheWindowAlone) {
  if (const std::string missing = support::XServer::missing(); !missing.empty()) {
    GTEST_SKIP() << missing;
  }
  EXPECT_EXIT(loseTheServer(), testing::ExitedWithCode(0),
              "shown, lost, not read, no events, not opened again, goes on");
}

TEST_F(WindowTest, IsBlackBeforeTheFirstPicture) {
  const auto window = open({320, 240});
  Image shown = orThrow(window->shown());
  EXPECT_EQ(shown.size(), (FrameSize{320, 240}));
  EXPECT_TRUE(std::ranges::all_of(shown.plane(0), [](int byte) { return byte == 0; }));
}

TEST_F(WindowTest, ShowsAPictureOfItsSizeExactly) {
  const auto window = open({320, 240});
  Image picture = colours({320, 240});
  ASSERT_TRUE(window->write(picture.view(), {}));
  Image shown = orThrow(window->shown());
  int wrong = 0;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) wrong += at(shown, x, y) == at(picture, x, y) ? 0 : 1;
  }
  EXPECT_EQ(wrong, 0);
}

TEST_F(WindowTest, ScalesLinearlyWhenItIsResized) {
  const auto window = open({240, 240});
  Image halves({.pixelFormat = PixelFormat::kRgba8, .size = {240, 240}});
  for (int y = 0; y < 240; ++y) std::ranges::fill(halves.row(0, y).subspan(480), 255);
  ASSERT_TRUE(window->write(halves.view(), {}));
  SDL_SetWindowSize(newestSdlWindow(), 960, 960);
  EXPECT_THAT(window->takeEvents(), ElementsAre(WindowEvent(WindowResized{{960, 960}})));
  Image shown = orThrow(window->shown());
  ASSERT_EQ(shown.size(), (FrameSize{960, 960}));
  EXPECT_EQ(at(shown, 470, 480), (Rgb{0, 0, 0}));
  EXPECT_EQ(at(shown, 490, 480), (Rgb{255, 255, 255}));
  int between = 0;  // the ramp of a linear filter; a nearest-neighbour filter has none
  for (int x = 470; x < 490; ++x) {
    const int grey = at(shown, x, 480).r;
    between += grey > 10 && grey < 245 ? 1 : 0;
  }
  EXPECT_GE(between, 2);
  EXPECT_LE(between, 5);
}

TEST_F(WindowTest, LaysBlackBarsBesideAPictureOfAnotherShape) {
  const auto window = open({320, 240});
  Image white({.pixelFormat = PixelFormat::kRgba8, .size = {320, 240}});
  std::ranges::fill(white.plane(0), std::uint8_t{255});
  ASSERT_TRUE(window->write(white.view(), {}));
  SDL_SetWindowSize(newestSdlWindow(), 400, 240);
  window->takeEvents();
  Image shown = orThrow(window->shown());
  EXPECT_EQ(at(shown, 39, 120), (Rgb{0, 0, 0}));
  EXPECT_EQ(at(shown, 40, 120), (Rgb{255, 255, 255}));
  EXPECT_EQ(at(shown, 359, 120), (Rgb{255, 255, 255}));
  EXPECT_EQ(at(shown, 360, 120), (Rgb{0, 0, 0}));
}

TEST_F(WindowTest, DrawsACaptionOverTheLowerLeftCornerOnly) {
  const auto window = open({640, 480});
  Image white({.pixelFormat = PixelFormat::kRgba8, .size = {640, 480}});
  std::ranges::fill(white.plane(0), std::uint8_t{255});
  ASSERT_TRUE(window->write(white.view(), {}));
  const auto darkened = [&](int fromY, int toY) {
    Image shown = orThrow(window->shown());
    int count = 0;
    for (int y = fromY; y < toY; ++y) {
      for (int x = 0; x < 640; ++x) count += at(shown, x, y).g < 200 ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(darkened(0, 480), 0);
  window->setCaption("cell_size 8 px\nwatercolor", 1.0);
  EXPECT_EQ(darkened(0, 400), 0);
  EXPECT_GT(darkened(400, 480), 2000);
  window->setCaption("cell_size 8 px\nwatercolor", 0.0);
  EXPECT_EQ(darkened(0, 480), 0);
  window->setCaption("", 1.0);
  EXPECT_EQ(darkened(0, 480), 0);
}

TEST_F(WindowTest, FadesItsCaption) {
  const auto window = open({640, 480});
  const auto darkestAt = [&](double opacity) {
    Image white({.pixelFormat = PixelFormat::kRgba8, .size = {640, 480}});
    std::ranges::fill(white.plane(0), std::uint8_t{255});
    EXPECT_TRUE(window->write(white.view(), {}));
    window->setCaption("watercolor", opacity);
    Image shown = orThrow(window->shown());
    return static_cast<int>(std::ranges::min(shown.plane(0)));
  };
  const int full = darkestAt(1.0);
  const int half = darkestAt(0.5);
  EXPECT_NEAR(full, 255 * 0.4, 3);
  EXPECT_NEAR(half, 255 * 0.7, 3);
}

TEST_F(WindowTest, TurnsAndMirrorsPictures) {
  const FrameSize size{320, 240};
  Image picture = colours(size);
  struct Case {
    int quarterTurns;
    bool isMirrored;
  };
  for (const Case& each : {Case{1, false}, {2, false}, {3, false}, {0, true}, {1, true}}) {
    const auto window =
        open(size, {.quarterTurns = each.quarterTurns, .isMirrored = each.isMirrored});
    orThrow(window->write(picture.view(), {}));
    Image shown = orThrow(window->shown());
    const bool isTurned = each.quarterTurns % 2 == 1;
    ASSERT_EQ(shown.size(), isTurned ? (FrameSize{240, 320}) : size) << each.quarterTurns;
    for (const auto& [x, y] : {std::pair{10, 20}, {300, 33}, {7, 221}}) {
      const int across = each.isMirrored ? size.width - 1 - x : x;
      const int right = size.width - 1 - across;
      const int low = size.height - 1 - y;
      const auto [toX, toY] = each.quarterTurns == 0   ? std::pair{across, y}
                              : each.quarterTurns == 1 ? std::pair{low, across}
                              : each.quarterTurns == 2 ? std::pair{right, low}
                                                       : std::pair{y, right};
      EXPECT_EQ(at(shown, toX, toY), at(picture, x, y))
          << each.quarterTurns << (each.isMirrored ? " mirrored" : "");
    }
  }
}

TEST_F(WindowTest, FillsTheScreenFromTheStart) {
  const auto window = open({320, 240}, {.isFullScreen = true});
  Image shown = orThrow(window->shown());
  SDL_DisplayMode mode{};
  SDL_GetDesktopDisplayMode(0, &mode);
  EXPECT_EQ(shown.size(), (FrameSize{mode.w, mode.h}));
  EXPECT_EQ(SDL_ShowCursor(SDL_QUERY), SDL_DISABLE);
}

TEST_F(WindowTest, HidesTheCursorWhereThatIsAsked) {
  {
    const auto window = open({320, 240}, {.hidesCursor = true});
    EXPECT_EQ(SDL_ShowCursor(SDL_QUERY), SDL_DISABLE);
    window->setFullScreen(false);
    EXPECT_EQ(SDL_ShowCursor(SDL_QUERY), SDL_DISABLE);
  }
  SDL_ShowCursor(SDL_ENABLE);
}

TEST_F(WindowTest, TakesNoKeysWhereTheyAreLocked) {
  const auto window = open({320, 240}, {.takesKeys = false});
  pushKey(newestSdlWindow(), SDLK_q);
  pushClose(newestSdlWindow());
  EXPECT_THAT(window->takeEvents(), IsEmpty());
  const Image before = orThrow(window->shown());
  window->setCaption("h: help", 1.0);
  const Image after = orThrow(window->shown());
  EXPECT_TRUE(std::ranges::equal(before.view().row(0, 235), after.view().row(0, 235)));
}

TEST_F(WindowTest, NamesTheDisplaysWhereTheWantedOneIsNotThere) {
  const auto window = orThrow(openWindow({.display = "9"}));
  const auto started = window->start({.size = {64, 48}});
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().kind, ErrorKind::kNotFound);
  EXPECT_THAT(started.error().message(),
              HasSubstr("there is no display 9; give auto, or one of 1 ("));
  EXPECT_TRUE(orThrow(openWindow({.display = "1"}))->start({.size = {64, 48}}));
}

TEST_F(WindowTest, TakesAStreamOfAnotherSize) {
  const auto window = open({320, 240});
  orThrow(window->write(colours({320, 240}).view(), {}));
  const OutputFormat format = orThrow(window->reconfigure({.size = {400, 260}}));
  EXPECT_EQ(format.frame.size, (FrameSize{400, 260}));
  Image picture = colours({400, 260});
  orThrow(window->write(picture.view(), {}));
  Image shown = orThrow(window->shown());
  ASSERT_EQ(shown.size(), (FrameSize{400, 260}));
  EXPECT_EQ(at(shown, 399, 259), at(picture, 399, 259));
}

TEST_F(WindowTest, GivesKeysInTheirOrder) {
  const auto window = open({320, 240});
  SDL_Window* sdl = newestSdlWindow();
  pushKey(sdl, SDLK_TAB, KMOD_LSHIFT);
  pushKey(sdl, SDLK_RIGHT, KMOD_NONE, true);
  pushKey(sdl, SDLK_q, KMOD_LCTRL);
  pushKey(sdl, SDLK_s);
  pushClose(sdl);
  EXPECT_THAT(window->takeEvents(),
              ElementsAre(WindowEvent(KeyPressed{.name = "tab", .shift = true}),
                          WindowEvent(KeyPressed{.name = "right", .isRepeat = true}),
                          WindowEvent(KeyPressed{.name = "s"}), WindowEvent(WindowClosed{})));
  EXPECT_THAT(window->takeEvents(), IsEmpty());
}

TEST_F(WindowTest, LeavesTheEventsOfOtherWindowsToThem) {
  const auto first = open({320, 240});
  SDL_Window* firstSdl = newestSdlWindow();
  const auto second = open({320, 240});
  first->takeEvents();
  pushKey(newestSdlWindow(), SDLK_a);
  pushKey(firstSdl, SDLK_b);
  EXPECT_THAT(first->takeEvents(), ElementsAre(WindowEvent(KeyPressed{.name = "b"})));
  EXPECT_THAT(second->takeEvents(), ElementsAre(WindowEvent(KeyPressed{.name = "a"})));
}

TEST_F(WindowTest, LeavesAHostProgramsWindowsAlone) {
  const auto window = open({320, 240});
  const std::unique_ptr<SDL_Window, decltype(&SDL_DestroyWindow)> hosts(
      SDL_CreateWindow("host", 0, 0, 64, 64, 0), SDL_DestroyWindow);
  ASSERT_NE(hosts, nullptr);
  pushKey(hosts.get(), SDLK_q);
  pushClose(hosts.get());
  EXPECT_THAT(window->takeEvents(), IsEmpty());
}

TEST_F(WindowTest, TakesNoCloseOfAWindowThatIsGone) {
  const auto window = open({320, 240});
  SDL_Window* gone = SDL_CreateWindow("gone", 0, 0, 64, 64, 0);
  ASSERT_NE(gone, nullptr);
  const Uint32 id = SDL_GetWindowID(gone);
  SDL_DestroyWindow(gone);
  SDL_Event event{};
  event.type = SDL_WINDOWEVENT;
  event.window.windowID = id;
  event.window.event = SDL_WINDOWEVENT_CLOSE;
  SDL_PushEvent(&event);
  EXPECT_THAT(window->takeEvents(), IsEmpty());
}

TEST_F(WindowTest, TakesKeysThatAreNobodys) {
  const auto window = open({320, 240});
  pushKey(nullptr, SDLK_q);
  EXPECT_THAT(window->takeEvents(), ElementsAre(WindowEvent(KeyPressed{.name = "q"})));
}

TEST_F(WindowTest, BearsItsTitle) {
  const auto window = open({320, 240});
  window->setTitle("pleinair: watercolor · wash");
  EXPECT_STREQ(SDL_GetWindowTitle(newestSdlWindow()), "pleinair: watercolor · wash");
}

TEST_F(WindowTest, FillsTheScreenAndComesBack) {
  const auto window = open({320, 240});
  const auto isFull = [] {
    return (SDL_GetWindowFlags(newestSdlWindow()) & SDL_WINDOW_FULLSCREEN_DESKTOP) ==
           SDL_WINDOW_FULLSCREEN_DESKTOP;
  };
  EXPECT_FALSE(isFull());
  window->setFullScreen(true);
  EXPECT_TRUE(isFull());
  window->takeEvents();
  EXPECT_GT(orThrow(window->shown()).size().width, 320);
  window->setFullScreen(false);
  EXPECT_FALSE(isFull());
}

TEST_F(WindowTest, LeavesSignalsToTheProgram) {
  const auto before = std::signal(SIGINT, SIG_DFL);
  const auto window = open({320, 240});
  EXPECT_EQ(std::signal(SIGINT, before), SIG_DFL);
}

TEST_F(WindowTest, SaysThatThereIsNoDisplay) {
  support::setVariable("SDL_VIDEODRIVER", nullptr);
  support::setVariable("DISPLAY", nullptr);
  support::setVariable("WAYLAND_DISPLAY", nullptr);
  const auto window = openWindow();
  ASSERT_FALSE(window.has_value());
  EXPECT_EQ(window.error().kind, ErrorKind::kNotFound);
  EXPECT_THAT(window.error().message(), HasSubstr("DISPLAY and WAYLAND_DISPLAY are not set"));
  EXPECT_THAT(window.error().message(), HasSubstr("--output FILE"));
}

TEST_F(WindowTest, SaysThatTheNamedDisplayIsNotThere) {
  support::setVariable("SDL_VIDEODRIVER", nullptr);
  support::setVariable("WAYLAND_DISPLAY", nullptr);
  support::setVariable("DISPLAY", ":49151");
  const auto window = openWindow();
  ASSERT_FALSE(window.has_value());
  EXPECT_EQ(window.error().kind, ErrorKind::kNotFound);
  EXPECT_THAT(window.error().message(), HasSubstr("x11"));
}

using WindowDeathTest = WindowTest;

TEST_F(WindowDeathTest, BelongsToOneThread) {
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  EXPECT_DEATH(
      {
        const auto window = open({320, 240});
        std::jthread([&] { window->takeEvents(); }).join();
      },
      "isStarted");
}

}  // namespace
}  // namespace pleinair::hal
