// Live painting through the program's own door: on an X server of the test's own, and without one.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <regex>
#include <stdexcept>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "hal/media/picture_file.h"
#include "hal/media/png_file.h"
#include "tests/program/program.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/x_server.h"

namespace pleinair::support {
namespace {

using testing::HasSubstr;
using namespace std::chrono_literals;

/// A machine may be slow: only what never comes fails.
constexpr auto kPatience = 60s;
constexpr hal::FrameSize kScreen{800, 600};
constexpr hal::FrameSize kSize{320, 240};
constexpr hal::FrameFormat kRgb{.pixelFormat = hal::PixelFormat::kRgb8, .size = kSize};

/// The numbers of the summary: "showed 30 frames in …; dropped 5 (3 replaced …): window".
struct Summary {
  int shown = -1;
  int dropped = -1;
  int reasons = 0;  ///< what they add up to
};
Summary summaryOf(const std::string& text) {
  Summary summary;
  std::smatch match;
  static const std::regex kLine(
      R"(showed (\d+) frames? in [\d.]+ s \([\d.]+ frames/s\)(?:, \d+ off schedule)?; dropped (\d+)(?: \(([^)]*)\))?: \S+\n)");
  if (!std::regex_match(text, match, kLine)) return summary;
  summary.shown = std::stoi(match[1]);
  summary.dropped = std::stoi(match[2]);
  const std::string reasons = match[3];
  static const std::regex kNumber(R"(\d+)");
  for (std::sregex_iterator each(reasons.begin(), reasons.end(), kNumber), end; each != end;
       ++each) {
    summary.reasons += std::stoi(each->str());
  }
  return summary;
}

class Run : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  static ProgramRun run(std::vector<std::string> arguments, ProgramLimits limits = {}) {
    arguments.insert(arguments.begin(), "run");
    for (const char* variable : {"SDL_VIDEODRIVER", "WAYLAND_DISPLAY", "DISPLAY"}) {
      limits.environment.insert(limits.environment.begin(), variable);
    }
    return runProgram(arguments, limits);
  }

  TemporaryFolder folder_;
};

TEST_F(Run, PaintsIntoAFileWithoutADisplay) {
  writeMedia(path("in.y4m"), 5);
  const ProgramRun live =
      run({"--camera", path("in.y4m"), "--output", path("out.mp4"), "--frames", "12"});
  ASSERT_EQ(live.status, 0) << live.error;
  EXPECT_EQ(live.error, "");
  const Summary summary = summaryOf(live.out);
  EXPECT_EQ(summary.shown, 12) << live.out;
  EXPECT_EQ(summary.dropped, summary.reasons) << live.out;
  const auto played = play(path("out.mp4"));
  ASSERT_TRUE(played);
  EXPECT_EQ(played->frames.size(), 12u) << "the recording goes on at its start";
  EXPECT_GE(played->times.back(), 11 * 40ms) << "in real time";
}

TEST_F(Run, FinishesItsFileWhenItIsTerminated) {
  writeMedia(path("in.y4m"), 5);
  ProgramLimits limits;
  limits.terminateWhenExists = path(".out.mp4.part");
  const ProgramRun live = run({"--camera", path("in.y4m"), "--output", path("out.mp4")}, limits);
  EXPECT_EQ(live.status, 0) << live.error;
  EXPECT_THAT(live.out, testing::StartsWith("showed "));
  const int shown = summaryOf(live.out).shown;
  if (shown > 0) {
    const auto played = play(path("out.mp4"));
    ASSERT_TRUE(played);
    EXPECT_EQ(played->frames.size(), static_cast<std::size_t>(shown));
  }
}

TEST_F(Run, FailsWhereItsStatusPortIsTakenWhileItCompiles) {
  writeMedia(path("in.y4m"), 5);
  const int taken = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{
      .sin_family = AF_INET, .sin_port = 0, .sin_addr = {htonl(INADDR_LOOPBACK)}, .sin_zero = {}};
  socklen_t length = sizeof address;
  ASSERT_EQ(bind(taken, reinterpret_cast<sockaddr*>(&address), length), 0);
  ASSERT_EQ(listen(taken, 1), 0);
  getsockname(taken, reinterpret_cast<sockaddr*>(&address), &length);
  const std::string port = "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
  const ProgramRun live = run(
      {"--camera", path("in.y4m"), "--output", path("out.mp4"), "--set", "status.listen=" + port},
      {.environment = {"MESA_SHADER_CACHE_DISABLE=true"}});
  close(taken);
  EXPECT_EQ(live.status, 1);
  EXPECT_THAT(live.error, HasSubstr("status.listen: cannot listen at " + port));
  EXPECT_EQ(folder_.entryCount(), 1u);
}

TEST_F(Run, CompletesItsMovieWithoutItsLog) {
  writeMedia(path("in.y4m"), 5);
  for (const Streams streams : {Streams::kBrokenPipes, Streams::kClosedError}) {
    ProgramLimits limits;
    limits.streams = streams;
    // A stale part makes it log a line.
    std::ofstream(path(".old.mp4.part")) << "old";
    const ProgramRun live =
        run({"--camera", path("in.y4m"), "--output", path("out.mp4"), "--frames", "6"}, limits);
    EXPECT_EQ(live.status, 0);
    const auto played = play(path("out.mp4"));
    ASSERT_TRUE(played) << played.error().message();
    EXPECT_EQ(played->frames.size(), 6u);
    std::filesystem::remove(path("out.mp4"));
    EXPECT_EQ(folder_.entryCount(), 2u) << "no partial file";
  }
}

TEST_F(Run, RefusesToPaintOverItsCamera) {
  writeMedia(path("in.mp4"), 3);
  const ProgramRun live = run({"--camera", path("in.mp4"), "--output", path("in.mp4")});
  EXPECT_EQ(live.status, 2);
  EXPECT_THAT(live.error, HasSubstr("is --camera as well"));
}

TEST_F(Run, RefusesUnknownViews) {
  writeMedia(path("in.mp4"), 3);
  const ProgramRun live =
      run({"--camera", path("in.mp4"), "--output", path("out.mp4"), "--view", "cels"});
  EXPECT_EQ(live.status, 2);
  EXPECT_THAT(live.error, HasSubstr("did you mean \"cells\"?"));
  EXPECT_EQ(folder_.entryCount(), 1u);
}

#ifdef PLEINAIR_WINDOW

TEST_F(Run, SaysThatThereIsNoDisplay) {
  const ProgramRun live = run({"--frames", "3"});
  EXPECT_EQ(live.status, 2);
  EXPECT_EQ(live.out, "");
  EXPECT_EQ(live.error,
            "pleinair: window: there is no display to open it on: DISPLAY and WAYLAND_DISPLAY are "
            "not set; start it on a desktop, or write to a file with --output FILE\n");
}

/// On a screen of its own.
class RunInWindow : public Run {
 protected:
  void SetUp() override {
    if (const std::string missing = XServer::missing(); !missing.empty()) GTEST_SKIP() << missing;
    server_.emplace(kScreen);
  }

  ProgramRun runShown(const std::vector<std::string>& arguments,
                      std::function<void(pid_t)> meanwhile = {}) {
    return run(arguments, {.environment = {"DISPLAY=" + server_->display()},
                           .meanwhile = std::move(meanwhile)});
  }

  /// Goes on once the title matches.
  void waitForTitle(const std::string& pattern) const {
    if (server_->waitForTitle("^pleinair: " + pattern + "$")) return;
    throw std::runtime_error("no window has a title like " + pattern);
  }

  /// Whether the screen comes to show this in its middle, down to where the caption is.
  bool comesToShow(hal::Image& picture) const {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    do {
      if (shows(picture)) return true;
    } while (std::chrono::steady_clock::now() < deadline);
    return false;
  }

  bool shows(hal::Image& picture) const {
    constexpr int kCaptionLines = 80;
    hal::Image screen = server_->screen();
    const hal::FrameSize size = picture.size();
    const int left = (kScreen.width - size.width) / 2;
    const int top = (kScreen.height - size.height) / 2;
    for (int y = 0; y < size.height - kCaptionLines; ++y) {
      const auto shown =
          screen.row(0, top + y).subspan(std::size_t{3} * static_cast<std::size_t>(left));
      const auto row = picture.row(0, y);
      if (!std::equal(row.begin(), row.end(), shown.begin())) return false;
    }
    return true;
  }

  /// Goes on once the folder holds so many snapshots, each of which a frame of its own was painted
  /// for.
  static void waitForSnapshots(const std::filesystem::path& folder, std::ptrdiff_t count) {
    const auto savedSnapshots = [&] {
      const std::filesystem::directory_iterator first(folder);
      return std::count_if(first, std::filesystem::directory_iterator(), [](const auto& entry) {
        return entry.path().filename().string().starts_with("pleinair-");
      });
    };
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (savedSnapshots() < count) {
      if (std::chrono::steady_clock::now() > deadline) throw std::runtime_error("no still comes");
      std::this_thread::yield();
    }
  }

  std::optional<XServer> server_;
};

TEST_F(RunInWindow, ShowsTheSyntheticCameraAndSumsUp) {
  const ProgramRun live = runShown({"--frames", "30"});
  EXPECT_EQ(live.status, 0) << live.error;
  const Summary summary = summaryOf(live.out);
  EXPECT_EQ(summary.shown, 30) << live.out;
  EXPECT_EQ(summary.dropped, summary.reasons) << live.out;
  EXPECT_THAT(live.out, testing::EndsWith(": window\n"));
}

TEST_F(RunInWindow, ShowsExactlyWhatWasPainted) {
  hal::Image picture = testPicture(kRgb, 0);
  for (std::size_t i = 0; i < picture.plane(0).size(); i += 3) picture.plane(0)[i] ^= 0x40;
  hal::orThrow(hal::writePng(path("in.png"), picture.view()));
  const ProgramRun live = runShown({"--camera", path("in.png"), "--style", "none"}, [&](pid_t) {
    EXPECT_TRUE(comesToShow(picture));
    server_->press({"q"});
  });
  EXPECT_EQ(live.status, 0) << live.error;
  EXPECT_GT(summaryOf(live.out).shown, 0);
}

TEST_F(RunInWindow, ObeysKeys) {
  writeMedia(path("in.y4m"), 10, kSize);
  std::filesystem::create_directory(path("snapshots"));
  const ProgramRun live =
      runShown({"--camera", path("in.y4m"), "--snapshots", path("snapshots")}, [&](pid_t) {
        waitForTitle("watercolor.*");
        server_->press({"Right"});
        waitForTitle("watercolor.*, changed");
        server_->press({"BackSpace", "v"});
        waitForTitle("watercolor.*[a-z_] .*view camera");
        server_->press({"shift+v", "shift+v", "space"});
        waitForTitle("watercolor.*view [b-z][a-z]+ .*paused");
        // The first frame of a pause is shown, the second repeats it: two snapshots, and both were.
        server_->press({"s"});
        waitForSnapshots(path("snapshots"), 1);
        server_->press({"s"});
        waitForSnapshots(path("snapshots"), 2);
        server_->press({"v", "space", "shift+l"});
        waitForTitle("watercolor[^a-z]+mosaic");
        // The third snapshot shows that the new look's programs are compiled.
        server_->press({"s"});
        waitForSnapshots(path("snapshots"), 3);
        server_->press({"Escape"});
      });
  EXPECT_EQ(live.status, 0) << live.error;
  const std::regex told("pleinair: info: saved " + path("snapshots"));
  EXPECT_EQ(std::distance(std::sregex_iterator(live.error.begin(), live.error.end(), told), {}), 3)
      << live.error;
  EXPECT_THAT(live.out, HasSubstr(" while paused"));
  EXPECT_EQ(summaryOf(live.out).dropped, summaryOf(live.out).reasons) << live.out;
}

TEST_F(RunInWindow, SavesWhatIsTunedAndSaysHowToRepeatIt) {
  writeMedia(path("in.y4m"), 5, kSize);
  std::filesystem::create_directory(path("saved"));
  const ProgramRun live = runShown(
      {"--camera", path("in.y4m"), "--snapshots", path("saved"), "--look", "glazed"}, [&](pid_t) {
        waitForTitle("watercolor.*glazed");
        server_->press({"Right", "w"});
        waitForSnapshots(path("saved"), 1);
        server_->press({"c", "q"});
      });
  EXPECT_EQ(live.status, 0) << live.error;
  EXPECT_THAT(live.error, HasSubstr("pleinair run --camera " + path("in.y4m") + " --snapshots " +
                                    path("saved") + " --style watercolor --look glazed --set "));
  ASSERT_FALSE(std::filesystem::is_empty(path("saved"))) << live.error;
  const std::filesystem::path look = *std::filesystem::directory_iterator(path("saved"));
  EXPECT_EQ(look.extension(), ".toml");
  const ProgramRun config = runProgram({"config", "--look", look.string()});
  EXPECT_EQ(config.status, 0) << config.error;
  EXPECT_THAT(config.out, HasSubstr("# " + look.string() + ":"));
}

TEST_F(RunInWindow, SavesTheFinishedPictureUnderAnyView) {
  hal::Image picture = testPicture(kRgb, 0);
  hal::orThrow(hal::writePng(path("in.png"), picture.view()));
  std::filesystem::create_directory(path("snapshots"));
  const ProgramRun live =
      runShown({"--camera", path("in.png"), "--style", "none", "--view", "camera", "--snapshots",
                path("snapshots"), "--size", "160x120"},
               [&](pid_t) {
                 waitForTitle("none .*view camera");
                 server_->press({"s", "s"});
                 waitForSnapshots(path("snapshots"), 1);
                 server_->press({"q"});
               });
  EXPECT_EQ(live.status, 0) << live.error;
  for (const auto& entry : std::filesystem::directory_iterator(path("snapshots"))) {
    EXPECT_TRUE(std::regex_match(entry.path().filename().string(),
                                 std::regex(R"(pleinair-\d{8}-\d{6}(-\d)?\.png)")))
        << entry.path();
    const auto still = hal::readPictureRgb(entry.path());
    ASSERT_TRUE(still);
    EXPECT_EQ(still->size(), (hal::FrameSize{160, 120})) << "of the painting, not of the window";
  }
}

TEST_F(RunInWindow, DrawsIntoTheWindowWhatACopyShows) {
  hal::Image picture = testPicture(kRgb, 0);
  for (std::size_t i = 0; i < picture.plane(0).size(); i += 3) picture.plane(0)[i] ^= 0x40;
  hal::orThrow(hal::writePng(path("in.png"), picture.view()));
  for (const std::string way : {"direct", "copied"}) {
    const ProgramRun live = runShown(
        {"--camera", path("in.png"), "--style", "none", "--set", "output.window.scan_out=" + way},
        [&](pid_t) {
          EXPECT_TRUE(comesToShow(picture)) << way;
          std::this_thread::sleep_for(1500ms);  // a trial takes some frames
          EXPECT_TRUE(comesToShow(picture)) << way << ", after the trial";
          server_->press({"q"});
        });
    EXPECT_EQ(live.status, 0) << live.error;
    EXPECT_THAT(
        live.error,
        HasSubstr(way == "direct" ? "window: the GPU draws straight into it, shared textures"
                                  : "window: pictures are copied: window: is set to copy"));
  }
}

TEST_F(RunInWindow, GoesOnWithTheMovieWhereTheXServerDies) {
  writeMedia(path("in.y4m"), 10, kSize);
  for (const std::string way : {"copied", "direct"}) {
    SCOPED_TRACE(way);
    server_.emplace(kScreen);
    const ProgramRun live =
        runShown({"--camera", path("in.y4m"), "--output", "window", "--output", path("out.mp4"),
                  "--set", "output.window.scan_out=" + way, "--style", "none", "--frames", "90"},
                 [&](pid_t) {
                   waitForTitle("none.*");
                   std::this_thread::sleep_for(1500ms);  // paintings go into its textures by then
                   server_->kill();
                 });
    EXPECT_THAT(live.error, HasSubstr("window: the display server is gone"));
    EXPECT_EQ(live.status, 1) << live.error;
    const auto played = play(path("out.mp4"));
    ASSERT_TRUE(played);
    EXPECT_EQ(played->frames.size(), 90U);
  }
}

TEST_F(RunInWindow, FillsTheScreenWithoutAWindowManager) {
  hal::Image picture(kRgb);
  std::ranges::fill(picture.plane(0), std::uint8_t{90});
  hal::orThrow(hal::writePng(path("in.png"), picture.view()));
  const auto isFilled = [this] {
    hal::Image screen = server_->screen();
    const auto red = [&](int x, int y) {
      return screen.row(0, y)[3 * static_cast<std::size_t>(x)];
    };
    return red(3, 3) == 90 && red(kScreen.width - 4, 3) == 90 &&
           red(kScreen.width - 4, kScreen.height - 4) == 90;
  };
  const auto comes = [&](bool filled) {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (isFilled() != filled && std::chrono::steady_clock::now() < deadline) {
    }
    return isFilled() == filled;
  };
  const ProgramRun live = runShown({"--camera", path("in.png"), "--style", "none"}, [&](pid_t) {
    waitForTitle("none.*");
    EXPECT_FALSE(isFilled());
    server_->press({"f"});
    EXPECT_TRUE(comes(true));
    server_->press({"f"});
    EXPECT_TRUE(comes(false));
    server_->press({"q"});
  });
  EXPECT_EQ(live.status, 0) << live.error;
}

TEST_F(RunInWindow, StandsInAPublicPlace) {
  hal::Image picture(kRgb);
  std::ranges::fill(picture.plane(0), std::uint8_t{90});
  hal::orThrow(hal::writePng(path("in.png"), picture.view()));
  bool isFilled = false;
  const ProgramRun live = runShown(
      {"--camera", path("in.png"), "--style", "none", "--set", "output.window.full_screen=true",
       "--set", "output.window.rotation=90", "--set", "output.window.keys=locked"},
      [&](pid_t program) {
        waitForTitle("none.*");
        const auto deadline = std::chrono::steady_clock::now() + kPatience;
        while (!isFilled && std::chrono::steady_clock::now() < deadline) {
          hal::Image screen = server_->screen();
          // 4:3, turned: 450 of 800 columns.
          const auto red = [&](int x) { return screen.row(0, 3)[3 * static_cast<std::size_t>(x)]; };
          isFilled = red(180) == 90 && red(620) == 90 && red(170) == 0 && red(630) == 0;
        }
        server_->press({"q", "Escape"});
        waitForTitle("none.*");
        std::this_thread::sleep_for(300ms);
        EXPECT_EQ(kill(program, SIGTERM), 0) << "the keys ended it";
      });
  EXPECT_TRUE(isFilled);
  EXPECT_EQ(live.status, 0) << live.error;
}

TEST_F(RunInWindow, ShowsThatItWaitsForACamera) {
  bool isThere = false;
  const ProgramRun live =
      runShown({"--camera", "serial:none-such", "--set", "camera.wait=true"}, [&](pid_t program) {
        waitForTitle(".*");
        const auto deadline = std::chrono::steady_clock::now() + kPatience;
        while (!isThere && std::chrono::steady_clock::now() < deadline) {
          hal::Image screen = server_->screen();
          const auto middle = screen.row(0, kScreen.height / 2);
          isThere = middle[std::size_t{3} * kScreen.width / 2] > 100;
        }
        kill(program, SIGTERM);
      });
  EXPECT_TRUE(isThere) << "paper";
  EXPECT_EQ(live.status, 0) << live.error;
}

TEST_F(RunInWindow, StopsWithinTwoSecondsOfASignal) {
  writeMedia(path("in.y4m"), 10, kSize);
  for (const int signal : {SIGINT, SIGTERM}) {
    std::chrono::steady_clock::time_point sent;
    const ProgramRun live = runShown({"--camera", path("in.y4m")}, [&](pid_t program) {
      waitForTitle("watercolor.*");
      sent = std::chrono::steady_clock::now();
      kill(program, signal);
    });
    EXPECT_LT(std::chrono::steady_clock::now() - sent, 2s);
    EXPECT_EQ(live.status, 0) << live.error;
    EXPECT_THAT(live.out, testing::StartsWith("showed "));
  }
}

#endif

}  // namespace
}  // namespace pleinair::support
