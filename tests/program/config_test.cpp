// The program's subcommands under profiles, site files and variables, and in a hostile environment.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/media/picture_file.h"
#include "tests/program/program.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::support {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class ConfigSubcommand : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }

  static void expectRefused(const ProgramRun& run, const testing::Matcher<std::string>& error) {
    EXPECT_EQ(run.status, 2) << run.error;
    EXPECT_EQ(run.out, "");
    EXPECT_THAT(run.error, AllOf(StartsWith("pleinair: "), error));
    EXPECT_EQ(std::ranges::count(run.error, '\n'), 1) << run.error;
  }

  hal::Image rendered(const std::vector<std::string>& arguments, const ProgramLimits& limits = {}) {
    std::vector<std::string> all{"render", "--input", path("in.png"), "--output", path("out.png")};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const ProgramRun run = runProgram(all, limits);
    EXPECT_EQ(run.status, 0) << run.error;
    return hal::orThrow(hal::readPicture(path("out.png")));
  }

  TemporaryFolder folder_;
};

bool isSame(const hal::Image& a, const hal::Image& b) {
  return a.size() == b.size() &&
         std::ranges::equal(a.view().planes[0].bytes, b.view().planes[0].bytes);
}

TEST_F(ConfigSubcommand, PrintsWhatItTakesAgain) {
  const ProgramRun first =
      runProgram({"config", "--profile", "kiosk", "--look", "wet_in_wet", "--set", "wobble=0.5"});
  ASSERT_EQ(first.status, 0) << first.error;
  EXPECT_EQ(first.error, "");
  const std::string site = write("site.toml", first.out);
  const ProgramRun second = runProgram({"config", "--config", site});
  ASSERT_EQ(second.status, 0) << second.error;
  // The same but for the origins, each of which is now a line of the site file.
  std::istringstream before(first.out);
  std::istringstream after(second.out);
  int keys = 0;
  int line = 0;
  for (std::string a, b; std::getline(before, a) && std::getline(after, b);) {
    ++line;
    const std::size_t origin = a.find("  # ");
    if (origin == std::string::npos) {
      EXPECT_EQ(a, b);
    } else {
      ++keys;
      EXPECT_EQ(b, a.substr(0, origin) + "  # " + site + ":" + std::to_string(line));
    }
  }
  EXPECT_GT(keys, 20);
}

TEST_F(ConfigSubcommand, PrintsOneLineOfWhatIsWrong) {
  expectRefused(runProgram({"config", "--config", write("s.toml", "[painting]\nstlye = 'x'\n")}),
                HasSubstr("s.toml:2: painting.stlye: unknown key (did you mean \"style\"?)"));
  expectRefused(runProgram({"config"}, {.environment = {"PLEINAIR_PAINTING_STLYE=none"}}),
                HasSubstr("PLEINAIR_PAINTING_STLYE: unknown variable (did you mean"));
  expectRefused(runProgram({"config", "--set", "two\nlines=1"}), HasSubstr("two\\nlines"));
  expectRefused(runProgram({"config", "surplus"}), HasSubstr("surplus"));
}

TEST_F(ConfigSubcommand, DoesWithoutAnEnvironment) {
  const ProgramRun run = runProgram({"config"}, {.environment = {"HOME", "PATH", "LANG", "TERM"}});
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_THAT(run.out, HasSubstr("style = \"watercolor\"  # default"));
}

TEST_F(ConfigSubcommand, DoesWithoutAWorkingDirectory) {
  const ProgramRun run =
      runProgram({"config", "--set", "painting.scene=desk.toml"}, {.inRemovedFolder = true});
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_THAT(run.out, HasSubstr("scene = \"desk.toml\"  # --set painting.scene"));
}

TEST_F(ConfigSubcommand, RefusesFilesThatAreNone) {
  expectRefused(runProgram({"config", "--config", folder_.path().string()}),
                HasSubstr("is a directory"));
  expectRefused(runProgram({"config", "--config", path("absent.toml")}),
                HasSubstr("absent.toml: cannot open: No such file or directory"));
  expectRefused(runProgram({"config"}, {.environment = {"PLEINAIR_CONFIG=" + path("absent.toml")}}),
                HasSubstr("PLEINAIR_CONFIG: " + path("absent.toml") + ": cannot open: "));
  fs::create_symlink("loop.toml", path("loop.toml"));
  expectRefused(runProgram({"config", "--config", path("loop.toml")}), HasSubstr("loop.toml"));
  expectRefused(runProgram({"config", "--config", path("absent/deeper/s.toml")}),
                HasSubstr("No such file"));
  expectRefused(runProgram({"config", "--config", write("s.toml", "") + "/s.toml"}),
                HasSubstr("Not a directory"));
}

TEST_F(ConfigSubcommand, RefusesAnUnreadableFile) {
  const std::string site = write("s.toml", "");
  fs::permissions(site, fs::perms::none);
  if (std::ifstream(site)) GTEST_SKIP() << "this user (root?) may read every file";
  expectRefused(runProgram({"config", "--config", site}),
                HasSubstr("s.toml: cannot open: Permission denied"));
}

TEST_F(ConfigSubcommand, RefusesAHugeFileUnread) {
  fs::resize_file(write("s.toml", "#"), 100'000'000);
  expectRefused(runProgram({"config", "--config", path("s.toml")}),
                HasSubstr("s.toml: too large, allowed: a TOML file of at most 1 MiB"));
}

TEST_F(ConfigSubcommand, RefusesDeepNesting) {
  for (const char opening : {'[', '{'}) {
    expectRefused(
        runProgram({"config", "--config", write("s.toml", "a = " + std::string(100'000, opening))}),
        HasSubstr("s.toml:1: "));
  }
  std::string dots;
  for (int i = 0; i < 100'000; ++i) dots += "a.";
  expectRefused(runProgram({"config", "--config", write("s.toml", "[" + dots + "a]\n")}),
                HasSubstr("s.toml:1: nested too deeply"));
}

TEST_F(ConfigSubcommand, WarnsOfFilesAndFoldersThatAreNotThere) {
  const ProgramRun run = runProgram({"config", "--set", "output.targets=" + path("none/out.mp4"),
                                     "--set", "camera.source=" + path("none.mp4")});
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_THAT(run.error, HasSubstr("mkdir -p '" + path("none") + "'"));
  EXPECT_THAT(run.error, HasSubstr("none.mp4: is neither a camera nor a file"));
  EXPECT_THAT(run.out, HasSubstr("none/out.mp4"));
}

TEST_F(ConfigSubcommand, SaysWhatTomlCannotHold) {
  // Files may be named in Latin-1, and are found by that name, but TOML is UTF-8.
  expectRefused(runProgram({"config", "--scene", "/caf\xe9.toml"}), HasSubstr("UTF-8"));
}

TEST_F(ConfigSubcommand, StylesAreListedWithoutAGpu) {
  // Were a context asked for, there would be none.
  const ProgramRun run = runProgram(
      {"styles"}, {.environment = {"__EGL_VENDOR_LIBRARY_FILENAMES=" + path("absent.json")}});
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_THAT(run.out, AllOf(HasSubstr("watercolor: "), HasSubstr("wet_in_wet"),
                             HasSubstr("cell_size"), HasSubstr("camera "), HasSubstr("none: ")));
}

TEST_F(ConfigSubcommand, RenderTakesItsOptionsFromEveryLayer) {
  writeMedia(path("in.png"), 1);
  const std::string site = write("site.toml", "[painting]\nsize = \"40x30\"\nstyle = \"none\"\n");
  EXPECT_EQ(rendered({"--config", site}).size(), (hal::FrameSize{40, 30}));
  const hal::Image plain = rendered({"--style", "none"});
  EXPECT_TRUE(isSame(rendered({}, {.environment = {"PLEINAIR_PAINTING_STYLE=none"}}), plain));
  EXPECT_TRUE(isSame(
      rendered({}, {.environment = {"PLEINAIR_CONFIG=" + site, "PLEINAIR_PAINTING_SIZE=camera"}}),
      plain));
  const std::string profile = write("p.toml", "[painting]\nstyle = \"none\"\n");
  EXPECT_TRUE(isSame(rendered({"--profile", profile}), plain));
}

TEST_F(ConfigSubcommand, ALookIsItsValues) {
  writeMedia(path("in.png"), 1);
  const hal::Image look = rendered({"--look", "wet_in_wet"});
  const std::string pinned = write("s.toml", runProgram({"config", "--look", "wet_in_wet"}).out);
  EXPECT_TRUE(isSame(rendered({"--config", pinned, "--look", "default"}), look));
  EXPECT_FALSE(isSame(rendered({}), look));
}

TEST_F(ConfigSubcommand, RecordTakesItsOptionsFromTheSiteFile) {
  const std::string site =
      write("site.toml", "[camera]\nsize = \"64x48\"\n[camera.synthetic]\nnoise = 0\n");
  const ProgramRun run =
      runProgram({"record", "--config", site, "--frames", "1", "--output", path("out.png")});
  ASSERT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(hal::orThrow(hal::readPicture(path("out.png"))).size(), (hal::FrameSize{64, 48}));
}

TEST_F(ConfigSubcommand, RecordTakesARecording) {
  writeMedia(path("in.png"), 1);
  const std::string site = write("site.toml", "[camera]\nsource = \"in.png\"\n");
  const ProgramRun run = runProgram({"record", "--config", site, "--output", path("out.png")});
  ASSERT_EQ(run.status, 0) << run.error;
  EXPECT_TRUE(fs::exists(path("out.png")));
  expectRefused(runProgram({"record", "--config", site, "--output", path("in.png")}),
                AllOf(HasSubstr("in.png"), HasSubstr("--camera")));
  expectRefused(runProgram({"record", "--config", site, "--output", path("o.png"), "--write-scene",
                            path("scene.toml")}),
                HasSubstr("--write-scene: the scene of a recording is not known"));
}

TEST_F(ConfigSubcommand, LateErrorsNameThePlaceOfTheValue) {
  writeMedia(path("in.png"), 1);
  const std::string site =
      write("site.toml", "[camera]\nsource = \"gone.mp4\"\n[painting]\nscene = \"gone.toml\"\n");
  expectRefused(runProgram({"record", "--config", site, "--output", path("o.png")}),
                HasSubstr(site + ":2: camera.source: " + path("gone.mp4") + ": cannot open: "));
  expectRefused(runProgram({"render", "--config", site, "--input", path("in.png"), "--output",
                            path("o.png")}),
                HasSubstr(site + ":4: painting.scene: " + path("gone.toml") + ": cannot open: "));
  expectRefused(runProgram({"record", "--output", path("o.png"), "--camera", "synthtic"}),
                HasSubstr("--camera: found \"synthtic\" (did you mean \"synthetic\"?), allowed: "
                          "auto, libcamera, v4l2, aravis, synthetic, synthetic:walkaround, "));
}

TEST_F(ConfigSubcommand, NothingIsWrittenOverWhatWasRead) {
  writeMedia(path("in.png"), 1);
  write("camera.toml",
        "image_size = [64, 48]\nfx = 100\nfy = 100\ncx = 32\ncy = 24\npixel_centres = \"half\"\n");
  write("scene.toml", "[camera]\ncalibration = \"camera.toml\"\n");
  const std::string profile = write("p.toml", "[painting]\nscene = \"scene.toml\"\n");
  const std::string site = write("site.toml", "profile = \"p.toml\"\n");
  const auto refusedOver = [&](const std::string& file, const std::string& what) {
    expectRefused(runProgram({"render", "--config", site, "--input", path("in.png"), "--output",
                              path("out.png"), "--poses", path(file)}),
                  AllOf(HasSubstr(file), HasSubstr("is " + what + " as well")));
  };
  refusedOver("camera.toml", "a file of the scene");
  refusedOver("scene.toml", "--scene");
  refusedOver("p.toml", "the configuration");
  refusedOver("site.toml", "the configuration");
  expectRefused(runProgram({"record", "--config", site, "--output", path("out.png"), "--frames",
                            "1", "--write-scene", site}),
                HasSubstr("the configuration"));
}

}  // namespace
}  // namespace pleinair::support
