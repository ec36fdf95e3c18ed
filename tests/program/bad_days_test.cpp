// Bad days of a person at a shell: names, files that are something else, and circumstances. Each
// either paints, or says in one line what is wrong; nothing hangs, crashes or leaves parts behind.
// docs/everyday.md lists them beside those that other tests hold.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/program/program.h"
#include "tests/support/av_movie.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::support {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using Words = std::vector<std::string>;

class BadDay : public testing::Test {
 protected:
  BadDay() { writeMedia(path("in.y4m"), 3); }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }

  /// Renders, in style none unless another is given, and within a minute.
  static ProgramRun render(Words arguments, ProgramLimits limits = {}) {
    limits.time = std::chrono::seconds(60);
    if (std::ranges::find(arguments, "--style") == arguments.end()) {
      arguments.insert(arguments.begin(), {"--style", "none"});
    }
    arguments.insert(arguments.begin(), "render");
    return runProgram(arguments, limits);
  }

  /// No partial file is left anywhere.
  void expectNoParts() const {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path())) {
      EXPECT_NE(entry.path().extension(), ".part") << entry.path();
    }
  }

  /// `arguments` beside --output: paints.
  void expectPainting(Words arguments, const ProgramLimits& limits = {},
                      const std::string& output = "out.y4m") const {
    arguments.insert(arguments.end(), {"--output", path(output)});
    const ProgramRun run = render(std::move(arguments), limits);
    EXPECT_EQ(run.status, 0) << run.error;
    const auto played = play(path(output));
    ASSERT_TRUE(played) << played.error().message();
    EXPECT_FALSE(played->frames.empty());
    expectNoParts();
  }

  /// `arguments` beside --output: says why not, in one line.
  void expectRefusal(Words arguments, const testing::Matcher<std::string>& line,
                     const ProgramLimits& limits = {}) const {
    if (std::ranges::find(arguments, "--output") == arguments.end()) {
      arguments.insert(arguments.end(), {"--output", path("out.y4m")});
    }
    const ProgramRun run = render(std::move(arguments), limits);
    EXPECT_THAT(run.status, testing::AnyOf(1, 2)) << run.error;
    EXPECT_THAT(run.error, AllOf(testing::StartsWith("pleinair: "), line));
    EXPECT_EQ(std::ranges::count(run.error, '\n'), 1) << run.error;
    EXPECT_TRUE(std::ranges::all_of(
        run.error, [](char c) { return c == '\n' || static_cast<unsigned char>(c) >= ' '; }));
    EXPECT_FALSE(std::filesystem::exists(path("out.y4m")));
    expectNoParts();
  }

  TemporaryFolder folder_;
};

TEST_F(BadDay, NamesOfFilesMayHoldAnything) {
  for (const std::string name : {"a film.y4m", "it's \"mine\".y4m", "Füße-映画.y4m", "-dash.y4m",
                                 "100%.y4m", "new\nline.y4m", "#1;rm.y4m"}) {
    std::filesystem::copy_file(path("in.y4m"), path(name));
    expectPainting({"--input", path(name)}, {}, "painted-" + name);
  }
  expectRefusal({"--input", path("gone\n\x1b[31m.mp4")}, HasSubstr("gone"));
}

TEST_F(BadDay, APercentSignIsNoPatternWhereTheFileIsThere) {
  std::filesystem::copy_file(path("in.y4m"), path("50%d.y4m"));
  expectPainting({"--input", path("50%d.y4m")});
}

TEST_F(BadDay, FilesThatAreSomethingElse) {
  const std::string html = "<!DOCTYPE html><html><body>403 Forbidden</body></html>";
  const std::string text = "this is a text\n";
  const std::string zip("PK\3\4\24\0\0\0\0\0", 10);
  for (const auto& [name, bytes] : {std::pair<std::string, std::string>{"photo.jpg", html},
                                    {"photo.png", text},
                                    {"photo.heic", html},
                                    {"film.mp4", html},
                                    {"film.mov", zip + std::string(400, '\0')},
                                    {"film.mkv", text},
                                    {"empty.mp4", ""},
                                    {"empty.jpg", ""},
                                    {"page.pdf", "%PDF-1.7\n%\xe2\xe3\xcf\xd3\n" + text},
                                    {"drawing.svg", "<svg xmlns='http://www.w3.org/2000/svg'/>"},
                                    {"layers.psd", std::string("8BPS\0\1", 6) + text},
                                    {"list.m3u8", "#EXTM3U\nhttp://example.org/a.ts\n"}}) {
    SCOPED_TRACE(name);
    expectRefusal({"--input", write(name, bytes)}, HasSubstr(name));
  }
}

TEST_F(BadDay, TheWrongEndingIsNoHindrance) {
  writeMedia(path("photo.png"), 1);
  writeAvMovie(path("film.mkv"), {.frames = 3});
  std::filesystem::rename(path("photo.png"), path("photo.jpg"));
  std::filesystem::rename(path("film.mkv"), path("film.mp4"));
  expectPainting({"--input", path("photo.jpg")});
  expectPainting({"--input", path("film.mp4")});
}

TEST_F(BadDay, DevicesAndFoldersAreNoFiles) {
  std::filesystem::create_directory(path("empty"));
  std::filesystem::create_symlink("loop.mp4", path("loop.mp4"));
  expectRefusal({"--input", "/dev/null"}, HasSubstr("/dev/null"));
  expectRefusal({"--input", "/dev/zero"}, HasSubstr("/dev/zero"));
  expectRefusal({"--input", path("empty")}, HasSubstr("empty"));
  expectRefusal({"--input", path("loop.mp4")}, HasSubstr("loop.mp4"));
  expectRefusal({"--input", path("in.y4m"), "--output", "/proc/out.mp4"}, HasSubstr("/proc/out"));
  expectRefusal({"--input", path("in.y4m"), "--output", "/dev/full"}, HasSubstr("/dev/full"));
  expectRefusal({"--input", path("in.y4m"), "--output", path(std::string(300, 'x') + ".mp4")},
                HasSubstr("File name too long"));
}

TEST_F(BadDay, AFileWithoutPermission) {
  if (geteuid() == 0) GTEST_SKIP() << "root may read everything";
  chmod(path("in.y4m").c_str(), 0);
  expectRefusal({"--input", path("in.y4m")}, HasSubstr("Permission denied"));
}

TEST_F(BadDay, ANamedPipeIsNotWaitedFor) {
  ASSERT_EQ(mkfifo(path("pipe.mkv").c_str(), 0600), 0);
  expectRefusal({"--input", path("pipe.mkv")}, HasSubstr("standard input: --input - <"));
}

TEST_F(BadDay, StrangeEnvironments) {
  const std::vector<Words> environments{
      {"LC_ALL=de_DE.UTF-8"},
      {"LC_ALL=tlh_KX.ISO-8859-99"},
      {"LC_ALL=C", "LANG="},
      {"HOME", "XDG_CACHE_HOME", "XDG_STATE_HOME", "XDG_RUNTIME_DIR"},
      {"HOME=/nonexistent", "XDG_CACHE_HOME=/nonexistent", "MESA_SHADER_CACHE_DIR=/nonexistent"},
      {"TMPDIR=/nonexistent"},
      {"TZ=Nowhere/Atlantis"},
      {"PATH="},
      {"TERM=dumb", "COLUMNS=3"},
  };
  for (const Words& environment : environments) {
    SCOPED_TRACE(environment.front());
    ProgramLimits limits;
    limits.environment = environment;
    expectPainting({"--input", path("in.y4m"), "--from", "0.02"}, limits);
  }
}

TEST_F(BadDay, FewFileDescriptors) {
  ProgramLimits limits;
  limits.fileDescriptors = 12;
  expectPainting({"--input", path("in.y4m"), "--style", "none"}, limits);
}

TEST_F(BadDay, NumbersAreReadTheSameInEveryLocale) {
  ProgramLimits limits;
  limits.environment = {"LC_ALL=de_DE.UTF-8"};
  expectRefusal({"--input", path("in.y4m"), "--from", "0,5"}, HasSubstr("0,5"), limits);
}

TEST_F(BadDay, NoGraphicsDriver) {
  ProgramLimits limits;
  limits.environment = {"__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent.json"};
  expectRefusal({"--input", path("in.y4m")}, HasSubstr("libegl"), limits);
}

TEST_F(BadDay, ADisplayThatIsNotThereIsNoHindranceForFiles) {
  ProgramLimits limits;
  limits.environment = {"DISPLAY=:4711", "WAYLAND_DISPLAY=nothing-0"};
  expectPainting({"--input", path("in.y4m")}, limits);
}

TEST_F(BadDay, StoppedAndContinued) {
  writeMedia(path("long.y4m"), 100, {320, 240});
  ProgramLimits limits;
  limits.meanwhile = [&](pid_t program) {
    for (int i = 0; i < 3; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      kill(program, SIGSTOP);
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      kill(program, SIGCONT);
    }
  };
  expectPainting({"--input", path("long.y4m")}, limits);
  EXPECT_EQ(play(path("out.y4m"))->frames.size(), 100U);
}

TEST_F(BadDay, AnInputThatIsDeletedMeanwhile) {
  writeMedia(path("long.y4m"), 100, {320, 240});
  ProgramLimits limits;
  limits.meanwhile = [&](pid_t) {
    for (int i = 0; i < 3000 && !std::filesystem::exists(path(".out.y4m.part")); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    std::filesystem::remove(path("long.y4m"));
  };
  expectPainting({"--input", path("long.y4m")}, limits);
}

TEST_F(BadDay, AnOutputFolderThatIsDeletedMeanwhile) {
  writeMedia(path("long.y4m"), 300, {320, 240});
  std::filesystem::create_directory(path("out"));
  ProgramLimits limits;
  limits.time = std::chrono::seconds(60);
  limits.meanwhile = [&](pid_t) {
    for (int i = 0; i < 3000 && !std::filesystem::exists(path("out/000003.png")); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    std::filesystem::rename(path("out"), path("moved"));
  };
  const ProgramRun run =
      runProgram({"render", "--style", "none", path("long.y4m"), "--output", path("out/")}, limits);
  EXPECT_EQ(run.status, 2) << run.error;
  EXPECT_THAT(run.error, HasSubstr("out"));
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(BadDay, APartWithoutFrames) {
  expectRefusal({"--input", path("in.y4m"), "--to", "0"},
                HasSubstr("--to: ends at 0 s, and --from begins at 0 s"));
}

TEST_F(BadDay, ConfigurationsFromWindowsAndFromElsewhere) {
  write("crlf.toml", "[painting]\r\nstyle = \"none\"\r\n");
  write("bom.toml", "\xEF\xBB\xBF[painting]\nstyle = \"none\"\n");
  write("utf16.toml", std::string("\xFF\xFE[\0p\0a\0]\0", 10));
  expectPainting({"--input", path("in.y4m"), "--config", path("crlf.toml")});
  expectPainting({"--input", path("in.y4m"), "--config", path("bom.toml")});
  std::filesystem::remove(path("out.y4m"));
  expectRefusal({"--input", path("in.y4m"), "--config", path("utf16.toml")},
                HasSubstr("utf16.toml"));
  ProgramLimits limits;
  limits.environment = {"PLEINAIR_PAINTNG_STYLE=none"};
  expectRefusal({"--input", path("in.y4m")}, HasSubstr("PLEINAIR_PAINTNG_STYLE"), limits);
  expectRefusal({"--input", path("in.y4m"), "--profile", "kisok"}, HasSubstr("kiosk"));
}

TEST_F(BadDay, ScenesWhoseFilesAreMissing) {
  const std::string tag = "[[tag]]\nid = 0\nedge_m = 0.1\n[[model]]\nattach = \"tag:0\"\n";
  write("gone.toml", tag + "source = \"gone.glb\"\n");
  write("dos.toml", tag + "source = 'C:\\models\\robot.glb'\n");
  write("kind.toml", tag + "source = \"robot.fbx\"\n");
  write("robot.fbx", "Kaydara FBX Binary");
  write("step.toml", tag + "source = \"part.step\"\n");
  write("part.step", "ISO-10303-21;");
  expectRefusal({path("in.y4m"), "--scene", path("gone.toml")}, HasSubstr("gone.glb"));
  expectRefusal({path("in.y4m"), "--scene", path("dos.toml")}, HasSubstr("robot.glb"));
  expectRefusal({path("in.y4m"), "--scene", path("kind.toml")}, HasSubstr("robot.fbx"));
  expectRefusal({path("in.y4m"), "--scene", path("step.toml")},
                AllOf(HasSubstr("part.step"), HasSubstr("FreeCAD")));
}

}  // namespace
}  // namespace pleinair::support
