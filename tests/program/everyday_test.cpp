// What a person meets in everyday use, through the program's own door.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "hal/media/picture_file.h"
#include "tests/program/program.h"
#include "tests/support/av_movie.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::support {
namespace {

using testing::HasSubstr;

class Everyday : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  /// Waits for a condition that a running program brings about.
  template <class Condition>
  static void await(const Condition& condition) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!condition() && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
  }

  std::uintmax_t bytesOf(const std::string& name) const {
    std::error_code ignored;
    const auto bytes = std::filesystem::file_size(path(name), ignored);
    return ignored ? 0 : bytes;
  }

  /// The files in a folder and those below.
  std::size_t filesIn(const std::string& name) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(std::filesystem::recursive_directory_iterator(path(name)),
                              [](const auto& entry) { return entry.is_regular_file(); }));
  }

  TemporaryFolder folder_;
};

using Record = Everyday;
using Looks = Everyday;
using WarmUp = Everyday;
using SceneChecked = Everyday;

TEST_F(Record, KeepsWhatItHasWhenInterrupted) {
  ProgramLimits limits;
  limits.meanwhile = [&](pid_t program) {
    await([&] { return bytesOf(".out.y4m.part") > std::uintmax_t{5} * 320 * 240 * 3 / 2; });
    kill(program, SIGINT);
  };
  const ProgramRun run = runProgram(
      {"record", "--output", path("out.y4m"), "--size", "320x240", "--frames", "100000"}, limits);
  EXPECT_EQ(run.status, 128 + SIGINT) << run.error;
  const auto played = play(path("out.y4m"));
  ASSERT_TRUE(played) << played.error().message();
  EXPECT_GE(played->frames.size(), 5U);
  EXPECT_EQ(run.error, "pleinair: interrupted by SIGINT; the " +
                           std::to_string(played->frames.size()) + " frames so far are kept in " +
                           path("out.y4m") + "\n");
}

TEST_F(Everyday, PaintsHdrAnamorphicMoviesWithTheirSound) {
  AvMovie movie{.layout = AV_PIX_FMT_YUV420P10LE,
                .frames = 30,
                .pixelAspect = {2, 1},
                .primaries = AVCOL_PRI_BT2020,
                .transfer = AVCOL_TRC_ARIB_STD_B67,
                .matrix = AVCOL_SPC_BT2020_NCL,
                .soundCoding = AV_CODEC_ID_PCM_S16LE,
                .clicksSeconds = {0.6}};
  writeAvMovie(path("in.mkv"), movie);
  const ProgramRun run = runProgram({"render", "--input", path("in.mkv"), "--output",
                                     path("out.mkv"), "--from", "0.2", "--to", "1.0"});
  ASSERT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(run.error, "");
  const auto played = play(path("out.mkv"));
  ASSERT_TRUE(played);
  EXPECT_EQ(played->format.frame.size, (hal::FrameSize{128, 48}));
  EXPECT_EQ(played->frames.size(), 20U);
  const auto clicks = clicksIn(path("out.mkv"));
  ASSERT_TRUE(clicks);
  ASSERT_EQ(clicks->size(), 1U);
  EXPECT_NEAR(clicks->front(), 0.4, 0.020);
}

TEST_F(Everyday, PaintsOneMomentOfAMovie) {
  writeAvMovie(path("in.mkv"), {.frames = 50});
  const ProgramRun run = runProgram({"render", "--input", path("in.mkv"), "--output",
                                     path("out.png"), "--at", "1.0", "--style", "none"});
  ASSERT_EQ(run.status, 0) << run.error;
  const auto picture = hal::readPictureRgb(path("out.png"));
  ASSERT_TRUE(picture);
  // Frame 25 has luma 140, which is 144 of 255.
  EXPECT_NEAR(picture->view().row(0, 10)[30], (140 - 16) * 255 / 219, 2);
  const ProgramRun refused = runProgram(
      {"render", "--input", path("in.mkv"), "--output", path("out.png"), "--at", "1:99"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.error, HasSubstr("seconds such as 12.5, or 1:02.5"));
}

TEST_F(Everyday, PaintsFromPipeToPipe) {
  writeMedia(path("in.y4m"), 5);
  writeAvMovie(path("in.mkv"), {.frames = 5});
  ASSERT_EQ(
      runProgram({"render", "--input", path("in.y4m"), "--output", path("direct.y4m")}).status, 0);
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  for (const std::string input : {"in.y4m", "in.mkv"}) {
    std::ofstream(path("out.y4m")) << "";
    ProgramLimits limits;
    limits.readsFrom = path("pipe");
    limits.printsInto = path("out.y4m");
    limits.meanwhile = [&](pid_t) {
      std::ifstream from(path(input), std::ios::binary);
      std::ofstream(path("pipe"), std::ios::binary) << from.rdbuf();
    };
    const ProgramRun run = runProgram({"render", "--input", "-", "--output", "-"}, limits);
    ASSERT_EQ(run.status, 0) << run.error;
    EXPECT_THAT(run.error, testing::StartsWith("painted 5 frames in "));
    const auto played = play(path("out.y4m"));
    ASSERT_TRUE(played) << played.error().message();
    EXPECT_EQ(played->frames.size(), 5U);
    EXPECT_FALSE(std::get<hal::EndOfStream>(played->ending).truncated);
    if (input == "in.y4m") {
      EXPECT_EQ(bytesOf("out.y4m"), bytesOf("direct.y4m"));
    }
  }
  EXPECT_EQ(folder_.entryCount(), 5U) << "no file of the name -";
}

TEST_F(Everyday, StopsPaintingIntoAPipeThatNobodyReads) {
  writeMedia(path("in.y4m"), 50, {320, 240});
  ProgramLimits limits;
  limits.streams = Streams::kBrokenOutput;
  const ProgramRun run =
      runProgram({"render", "--input", path("in.y4m"), "--output", "-", "--style", "none"}, limits);
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.error, "pleinair: standard output: cannot write: Broken pipe\n");
}

TEST_F(Everyday, PaintsSeveralFilesEachIntoItsOwn) {
  writeMedia(path("a.y4m"), 3);
  writeMedia(path("b.png"), 1);
  std::ofstream(path("broken.mp4")) << "no movie";
  std::filesystem::create_directory(path("out"));
  const ProgramRun run =
      runProgram({"render", "--style", "none", path("a.y4m"), path("broken.mp4"), path("b.png"),
                  "--output", path("out/{name}.mkv"), "--poses", path("out/{name}.jsonl")});
  EXPECT_EQ(run.status, 2) << "that of the broken one";
  EXPECT_THAT(run.error, HasSubstr(path("broken.mp4")));
  EXPECT_EQ(play(path("out/a.mkv"))->frames.size(), 3U);
  EXPECT_EQ(play(path("out/b.mkv"))->frames.size(), 1U);
  EXPECT_EQ(filesIn("out"), 4U);
}

TEST_F(Everyday, RefusesSeveralFilesForOneOutput) {
  writeMedia(path("a.y4m"), 1);
  std::filesystem::create_directory(path("sub"));
  writeMedia(path("sub/a.y4m"), 1);
  const ProgramRun one =
      runProgram({"render", path("a.y4m"), path("sub/a.y4m"), "--output", path("out.mp4")});
  EXPECT_EQ(one.status, 2);
  EXPECT_THAT(one.error, HasSubstr("out.mp4: is one --output for 2 inputs; write {name} in it"));
  const ProgramRun same =
      runProgram({"render", path("a.y4m"), path("sub/a.y4m"), "--output", path("{name}.mp4")});
  EXPECT_EQ(same.status, 2);
  EXPECT_THAT(same.error, HasSubstr("a.mp4: is --output as well"));
  EXPECT_EQ(folder_.entryCount(), 2U);
}

TEST_F(Everyday, WritesTheFormatsThatItIsAskedFor) {
  writeMedia(path("in.y4m"), 2);
  const auto render = [&](const std::string& output, std::vector<std::string> options) {
    std::vector<std::string> arguments{"render", "--style",      "none",     "--frames",
                                       "1",      path("in.y4m"), "--output", path(output)};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return runProgram(arguments);
  };
  for (const auto& [output, options] : {std::pair<std::string, std::vector<std::string>>{
                                            "a.jpg", {"--quality", "80", "--dpi", "300"}},
                                        {"b.tiff", {"--dpi", "300"}},
                                        {"c-%02d.jpg", {}},
                                        {"d.mkv", {"--codec", "ffv1"}},
                                        {"e.mp4", {"--codec", "hevc", "--crf", "30"}}}) {
    const ProgramRun run = render(output, options);
    EXPECT_EQ(run.status, 0) << run.error;
    EXPECT_EQ(run.error, "");
  }
  EXPECT_TRUE(hal::readPicture(path("c-00.jpg")));
  for (const auto& [output, options, problem] :
       {std::tuple<std::string, std::vector<std::string>, std::string>{
            "x.png", {"--quality", "80"}, "--quality: is of JPEG"},
        {"x.mp4", {"--dpi", "80"}, "--dpi: is of pictures"},
        {"x.jpg", {"--crf", "20"}, "--crf: is of movies"},
        {"x.mp4", {"--crf", "60"}, "--crf: found \"60\", allowed: a number from 0 to 51"},
        {"x.y4m", {"--codec", "hevc"}, "--codec: is of movies"},
        {"x.mp4", {"--codec", "ffv1"}, "cannot hold FFV1"},
        {"x.mp4", {"--codec", "divx"}, "--codec: found \"divx\", allowed: h264"}}) {
    const ProgramRun run = render(output, options);
    EXPECT_EQ(run.status, 2) << problem;
    EXPECT_THAT(run.error, HasSubstr(problem));
    EXPECT_EQ(bytesOf(output), 0U);
  }
}

TEST_F(Everyday, NamesTheFilesOfAFolderThatItLeavesOut) {
  std::filesystem::create_directory(path("in"));
  writeMedia(path("in/"), 3);
  std::filesystem::resize_file(path("in/000001.png"), 60);
  for (const char* name : {"in/notes.txt", "in/a.psd", "in/b.psd", "in/c.mov"}) {
    std::ofstream(path(name)) << "no picture";
  }
  const ProgramRun run = runProgram({"render", "--input", path("in"), "--output", path("out.mp4")});
  EXPECT_EQ(run.status, 0);
  EXPECT_THAT(run.error, HasSubstr("4 of its files are left out, by their names no picture: a.psd, "
                                   "b.psd, c.mov …"));
  EXPECT_THAT(run.error, HasSubstr("in/000001.png: is a broken picture"));
  EXPECT_THAT(run.error, HasSubstr("it is left out"));
}

TEST_F(Everyday, ObeysASignalWithHundredsOfModels) {
  constexpr int kMoreThanItPaints = 300;
  writeMedia(path("in.y4m"), kMoreThanItPaints, {320, 240});
  std::ofstream scene(path("many.toml"));
  scene << "[[tag]]\nid = 0\nedge_m = 0.12\nposition_m = [0, 0, 0]\n";
  for (int i = 0; i < 500; ++i) {
    scene << "[[model]]\nsource = \"builtin:gearbox\"\nattach = \"tag:0\"\n";
  }
  scene.close();
  std::chrono::steady_clock::time_point sent;
  ProgramLimits limits;
  limits.meanwhile = [&](pid_t program) {
    await([&] { return std::filesystem::exists(path(".out.y4m.part")); });
    // in the warm-up, or in the first frames
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    sent = std::chrono::steady_clock::now();
    kill(program, SIGINT);
  };
  const ProgramRun run = runProgram({"render", "--input", path("in.y4m"), "--output",
                                     path("out.y4m"), "--scene", path("many.toml")},
                                    limits);
  EXPECT_LT(std::chrono::steady_clock::now() - sent, std::chrono::seconds(10));
  EXPECT_EQ(run.status, 128 + SIGINT) << run.error;
}

TEST_F(Everyday, TooLittleAddressSpaceIsNotBlamedOnTheDriver) {
  if (isSanitized()) GTEST_SKIP() << "a sanitizer takes address space of its own";
  writeMedia(path("in.png"), 1);
  ProgramLimits limits;
  limits.addressSpaceBytes = 300'000UL * 1024;
  const ProgramRun run =
      runProgram({"render", "--input", path("in.png"), "--output", path("out.png")}, limits);
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.error, HasSubstr("this process may use 292 MiB of address space (ulimit -v)"));
  EXPECT_THAT(run.error, testing::Not(HasSubstr("install Mesa")));
}

TEST_F(Everyday, ACrashUnderAMemoryLimitNamesTheLimit) {
  if (isSanitized()) GTEST_SKIP() << "a sanitizer takes address space of its own";
  writeMedia(path("in.png"), 1);
  for (const unsigned long mebibytes : {450UL, 650UL, 750UL}) {
    ProgramLimits limits;
    limits.addressSpaceBytes = mebibytes << 20U;
    const ProgramRun run =
        runProgram({"render", "--input", path("in.png"), "--output", path("out.png")}, limits);
    if (run.status == 0) continue;
    EXPECT_THAT(run.error, HasSubstr(fmt::format("{} MiB of address space (ulimit -v)", mebibytes)))
        << run.status;
  }
}

TEST_F(Everyday, TheRescuePictureIsWrittenToAFile) {
  const auto written = [&](const std::string& name, const std::string& title) {
    const ProgramRun run = runProgram({"rescue", "--write", path(name), "--title", title},
                                      {.environment = {"STATE_DIRECTORY=" + path("none")}});
    EXPECT_EQ(run.status, 0) << run.error;
    hal::Image picture = hal::orThrow(hal::readPictureRgb(path(name)));
    EXPECT_EQ(picture.size(), (hal::FrameSize{1280, 720}));
    return std::vector<std::uint8_t>(picture.plane(0).begin(), picture.plane(0).end());
  };
  const auto one = written("one.png", "Soon");
  EXPECT_EQ(one, written("again.png", "Soon"));
  EXPECT_NE(one, written("other.png", "Not so soon"));
}

TEST_F(Everyday, SaysThatShadersAreCompiled) {
  writeMedia(path("in.png"), 1);
  ProgramLimits limits;
  limits.environment = {"MESA_SHADER_CACHE_DISABLE=true"};
  limits.keepsCompileNotice = true;
  const ProgramRun run =
      runProgram({"render", "--input", path("in.png"), "--output", path("out.png")}, limits);
  EXPECT_EQ(run.status, 0);
  EXPECT_THAT(run.error, testing::StartsWith("pleinair: info: compiling shaders"));
}

TEST_F(Looks, ArePaintedOnOneSheet) {
  writeMedia(path("in.png"), 1, {160, 120});
  const ProgramRun run = runProgram(
      {"looks", "--input", path("in.png"), "--output", path("sheet.png"), "--style", "hatching"});
  ASSERT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(run.out, "painted 6 looks: " + path("sheet.png") + "\n");
  const auto sheet = hal::readPictureRgb(path("sheet.png"));
  ASSERT_TRUE(sheet);
  EXPECT_EQ(sheet->size(), (hal::FrameSize{12 + 4 * 172, 12 + 2 * 156}));
  const ProgramRun unknown = runProgram(
      {"looks", "--input", path("in.png"), "--output", path("sheet.png"), "--style", "oil"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.error, HasSubstr("watercolor"));
}

TEST_F(WarmUp, LeavesNothingToCompile) {
  writeMedia(path("in.mp4"), 4, {640, 480});
  std::filesystem::create_directory(path("cache"));
  ProgramLimits limits;
  limits.time = std::chrono::seconds(280);
  limits.environment = {"MESA_SHADER_CACHE_DIR=" + path("cache")};
  const ProgramRun warm = runProgram({"warm-up", "--style", "watercolor"}, limits);
  ASSERT_EQ(warm.status, 0) << warm.error;
  EXPECT_THAT(warm.out, testing::MatchesRegex("watercolor: [0-9.]+ s\n"));
  const std::size_t compiled = filesIn("cache");
  if (compiled == 0) GTEST_SKIP() << "this driver keeps no cache of files";
  for (const char* look : {"line_and_wash", "mosaic"}) {
    const ProgramRun run = runProgram(
        {"render", "--input", path("in.mp4"), "--output", path("out.mp4"), "--look", look}, limits);
    EXPECT_EQ(run.status, 0) << run.error;
    EXPECT_EQ(run.error, "") << look;
    EXPECT_EQ(filesIn("cache"), compiled) << look;
  }
}

TEST_F(SceneChecked, IsDescribedAndDrawnOverARecording) {
  ASSERT_EQ(runProgram({"record", "--output", path("bench.mkv"), "--frames", "12", "--write-scene",
                        path("bench.toml")})
                .status,
            0);
  // The last model's tag comes into view later.
  std::ifstream file(path("bench.toml"));
  std::string scene{std::istreambuf_iterator<char>(file), {}};
  scene.resize(scene.rfind("[[model]]"));
  std::ofstream(path("bench.toml")) << scene;
  const ProgramRun run = runProgram({"scene", "check", path("bench.toml"), "--input",
                                     path("bench.mkv"), "--output", path("check.png")});
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_THAT(run.out, HasSubstr("tag 0: "));
  EXPECT_THAT(run.out, HasSubstr("seen in 12 of 12 frames"));
  EXPECT_THAT(run.out, HasSubstr("gearbox: on tag 0, "));
  EXPECT_TRUE(hal::readPictureRgb(path("check.png")));

  std::ofstream(path("small.toml")) << "[[tag]]\nid = 0\nedge_m = 0.1\n[[model]]\nsource = "
                                       "\"builtin:gearbox\"\nattach = \"tag:0\"\nscale = 0.001\n";
  const ProgramRun small = runProgram({"scene", "check", path("small.toml")});
  EXPECT_EQ(small.status, 1);
  EXPECT_THAT(small.error, HasSubstr("makes it 0.2 m"));
}

}  // namespace
}  // namespace pleinair::support
