// A machine that is set up by a medium, through the program's own door.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/media/png_file.h"
#include "tests/program/program.h"
#include "tests/support/media_files.h"
#include "tests/support/notify_socket.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/x_server.h"

namespace pleinair::support {
namespace {

using testing::HasSubstr;
using testing::Not;
using namespace std::chrono_literals;
namespace fs = std::filesystem;

constexpr auto kMediumPatience = 60s;
constexpr hal::FrameSize kMediumSize{320, 240};

class Provisioning : public testing::Test {
 protected:
  Provisioning() {
    hal::Image picture =
        testPicture({.pixelFormat = hal::PixelFormat::kRgb8, .size = kMediumSize}, 0);
    hal::orThrow(hal::writePng(folder_.path() / "in.png", picture.view()));
    fs::create_directory(folder_.path() / "stick");
  }

  void setUp(const std::string& text) const {
    std::ofstream(folder_.path() / "stick" / "site.toml") << text;
  }
  void pullStick() const { fs::remove(folder_.path() / "stick" / "site.toml"); }

  /// Paints one frame of a picture. `output`: a folder in place of the one of the test before.
  ProgramRun run(const std::string& output, ProgramLimits limits = {},
                 std::vector<std::string> more = {"--frames", "1"}) const {
    std::vector<std::string> arguments{"run",
                                       "--provisioning",
                                       (folder_.path() / "stick").string(),
                                       "--camera",
                                       (folder_.path() / "in.png").string(),
                                       "--output",
                                       output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    limits.environment.insert(limits.environment.begin(),
                              {"STATE_DIRECTORY=" + (folder_.path() / "state").string(),
                               "SDL_VIDEODRIVER", "WAYLAND_DISPLAY"});
    return runProgram(arguments, limits);
  }
  std::string output(const std::string& name) const {
    return (folder_.path() / name).string() + "/";
  }
  /// The bytes of the picture in an output's folder.
  static std::string painted(const std::string& output) {
    for (const auto& each : fs::directory_iterator(output)) {
      std::ifstream file(each.path(), std::ios::binary);
      return {std::istreambuf_iterator<char>(file), {}};
    }
    return {};
  }

  TemporaryFolder folder_;
};

constexpr const char* kPlain = "[painting]\nstyle = \"none\"\n";

TEST_F(Provisioning, WithoutAnyItPaintsAndSaysSo) {
  const ProgramRun first = run(output("first"));
  EXPECT_EQ(first.status, 0) << first.error;
  EXPECT_THAT(first.error, HasSubstr("not set up yet"));
  EXPECT_NE(painted(output("first")), "");
}

TEST_F(Provisioning, AGoodOneIsInForceAlsoWhenTheStickIsPulledOrBroken) {
  const ProgramRun unprovisioned = run(output("control"));
  ASSERT_EQ(unprovisioned.status, 0) << unprovisioned.error;
  setUp(kPlain);
  const ProgramRun good = run(output("good"));
  ASSERT_EQ(good.status, 0) << good.error;
  EXPECT_THAT(good.error, HasSubstr("set up by " + (folder_.path() / "stick").string()));
  const std::string plain = painted(output("good"));
  EXPECT_NE(plain, painted(output("control"))) << "a control: it makes a difference";

  pullStick();
  const ProgramRun pulled = run(output("pulled"));
  EXPECT_EQ(pulled.status, 0) << pulled.error;
  EXPECT_EQ(painted(output("pulled")), plain);

  setUp("[painting]\nstyle = \"oils\"\n");
  const ProgramRun broken = run(output("broken"));
  EXPECT_EQ(broken.status, 0) << broken.error;
  EXPECT_THAT(broken.error, HasSubstr("site.toml:2: painting.style: found \"oils\""));
  EXPECT_EQ(painted(output("broken")), plain);
}

TEST_F(Provisioning, ABrokenOneAloneStopsNoPainting) {
  setUp("[painting\n");
  const ProgramRun broken = run(output("broken"));
  EXPECT_EQ(broken.status, 0) << broken.error;
  EXPECT_THAT(broken.error, HasSubstr("site.toml:1: not TOML"));
  EXPECT_THAT(broken.error, Not(HasSubstr("set up by")));
  EXPECT_NE(painted(output("broken")), "");
}

TEST_F(Provisioning, NothingIsWrittenBesideIt) {
  fs::create_directory(folder_.path() / "stick" / "shots");
  std::ofstream(folder_.path() / "stick" / "shots" / "old.png") << "x";
  for (const std::string text :
       {"[output]\nsnapshots = \"shots\"\n", "[runtime]\nframe_log = \"frames.csv\"\n"}) {
    setUp(text);
    const ProgramRun refused = run(output("refused"));
    EXPECT_EQ(refused.status, 0) << refused.error;
    EXPECT_THAT(refused.error, HasSubstr("site.toml:2: "));
    EXPECT_THAT(refused.error, HasSubstr("beside site.toml, where nothing is written"));
  }
  setUp("[runtime]\nframe_log = \"" + (folder_.path() / "frames.csv").string() + "\"\n");
  const ProgramRun taken = run(output("taken"));
  EXPECT_EQ(taken.status, 0) << taken.error;
  EXPECT_THAT(taken.error, Not(HasSubstr("beside"))) << "a control";
  EXPECT_TRUE(fs::exists(folder_.path() / "frames.csv"));
}

TEST_F(Provisioning, AnotherSiteFileIsForThoseWhoNameOne) {
  EXPECT_EQ(run(output("both"), {}, {"--config", "other.toml"}).status, 2);
}

TEST_F(Provisioning, UnderAServiceManagerItEndsForAStickThatComes) {
  NotifySocket manager(folder_.path() / "notify");
  ProgramLimits limits;
  limits.environment = {"NOTIFY_SOCKET=" + manager.path()};
  limits.meanwhile = [&](pid_t) {
    const auto deadline = std::chrono::steady_clock::now() + kMediumPatience;
    while (!fs::exists(output("live")) && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::yield();
    }
    setUp(kPlain);
  };
  const ProgramRun live = run(output("live"), limits, {});
  EXPECT_EQ(live.status, 0) << "the manager starts it again";
  EXPECT_THAT(live.error, HasSubstr("another site.toml"));
}

/// On a screen of its own.
class ProvisioningOnScreen : public Provisioning {
 protected:
  void SetUp() override {
    if (const std::string missing = XServer::missing(); !missing.empty()) GTEST_SKIP() << missing;
    server_.emplace(hal::FrameSize{640, 480});
    hal::Image white({.pixelFormat = hal::PixelFormat::kRgb8, .size = {640, 480}});
    std::ranges::fill(white.plane(0), std::uint8_t{255});
    hal::orThrow(hal::writePng(folder_.path() / "in.png", white.view()));
  }
  /// How many rows the caption's band has, over a white painting.
  int darkRows() const {
    hal::Image screen = server_->screen();
    int rows = 0;
    for (int y = 0; y < 480; ++y) rows += screen.row(0, y)[std::size_t{3} * 12] < 200 ? 1 : 0;
    return rows;
  }
  /// Whether the band comes to have so many rows.
  bool comesToHave(int least, int most) const {
    const auto deadline = std::chrono::steady_clock::now() + kMediumPatience;
    do {
      const int rows = darkRows();
      if (rows >= least && rows <= most) return true;
    } while (std::chrono::steady_clock::now() < deadline);
    return false;
  }
  ProgramRun show(std::function<void(pid_t)> meanwhile) const {
    return run(
        "window",
        {.environment = {"DISPLAY=" + server_->display()}, .meanwhile = std::move(meanwhile)},
        {"--style", "none"});
  }

  std::optional<XServer> server_;
};

TEST_F(ProvisioningOnScreen, TheTextStaysUntilTheMachineIsSetUp) {
  int rows = 0;
  const ProgramRun unset = show([&](pid_t) {
    EXPECT_TRUE(server_->waitForTitle("^pleinair: none.*$"));
    EXPECT_TRUE(comesToHave(60, 240));
    // Longer than the greeting, which is of another height.
    const auto end = std::chrono::steady_clock::now() + 5s;
    do {
      rows = darkRows();
    } while (rows >= 60 && std::chrono::steady_clock::now() < end);
    server_->press({"q"});
  });
  EXPECT_EQ(unset.status, 0) << unset.error;
  EXPECT_GE(rows, 60) << "six lines";
  setUp("");
  const ProgramRun set = show([&](pid_t) {
    EXPECT_TRUE(server_->waitForTitle("^pleinair: none.*$"));
    EXPECT_TRUE(comesToHave(0, 0)) << "a control: the greeting goes by itself";
    server_->press({"q"});
  });
  EXPECT_EQ(set.status, 0) << set.error;
}

}  // namespace
}  // namespace pleinair::support
