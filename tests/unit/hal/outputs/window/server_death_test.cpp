// An X server that dies at some moment of a swap: Mesa's and Xlib's code meets the broken
// connection in many places, so many moments are tried. Each is a child of its own.
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include <execinfo.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "hal/outputs/window/window.h"
#include "tests/support/environment.h"
#include "tests/support/x_server.h"

namespace pleinair::hal {
namespace {

constexpr unsigned kPatienceSeconds = 60;  // to start a server and to open a window, too

/// Says where the child is that does not come to its end.
void hang(int /*signal*/) {
  void* frames[64];  // NOLINT(modernize-avoid-c-arrays): backtrace()'s
  constexpr int kMost = 64;
  backtrace_symbols_fd(frames, backtrace(frames, kMost), STDERR_FILENO);
  _exit(1);
}

/// Draws until the server is gone, which is killed `after` the first picture; ends the process.
[[noreturn]] void loseTheServerWhileDrawing(std::chrono::microseconds after) {
  void* frame = nullptr;
  backtrace(&frame, 1);  // loads what it needs: a handler must not
  std::signal(SIGALRM, hang);
  alarm(kPatienceSeconds);
  support::XServer server;
  support::setVariable("SDL_VIDEODRIVER", "x11");
  support::setVariable("DISPLAY", server.display().c_str());
  {
    const std::unique_ptr<Window> window = orThrow(openWindow());
    orThrow(window->start({.size = {640, 480}}));
    Image picture({.pixelFormat = PixelFormat::kRgba8, .size = {640, 480}});
    orThrow(window->write(picture.view(), {}));
    std::thread killer([&] {
      std::this_thread::sleep_for(after);
      server.kill();
    });
    Result<void> written;
    while (written) written = window->write(picture.view(), {});
    killer.join();
    std::fputs(written.error().kind == ErrorKind::kDeviceLost ? "lost" : "other error", stderr);
  }
  std::_Exit(0);  // as the program does: Mesa's threads still have the connection
}

TEST(WindowOnXStressDeathTest, AServerThatDiesWhileItIsDrawnOnIsALoss) {
  if (const std::string missing = support::XServer::missing(); !missing.empty()) {
    GTEST_SKIP() << missing;
  }
  constexpr int kMoments = 48;
  for (int i = 0; i < kMoments; ++i) {
    const std::chrono::microseconds after(20'000 + 700 * i);
    EXPECT_EXIT(loseTheServerWhileDrawing(after), testing::ExitedWithCode(0), "lost") << i;
  }
}

}  // namespace
}  // namespace pleinair::hal
