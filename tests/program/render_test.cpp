// The main job through the program's own door: recordings in, paintings out.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "hal/media/picture_file.h"
#include "hal/media/png_file.h"
#include "tests/program/program.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::support {
namespace {

using testing::HasSubstr;

std::string contentOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

class Render : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  ProgramRun render(const std::string& input, const std::string& output,
                    std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"render", "--input", path(input), "--output", path(output)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(arguments);
  }

  TemporaryFolder folder_;
};

TEST_F(Render, PaintsAMovieIntoEveryKindOfOutput) {
  writeMedia(path("in.mp4"), 4);
  for (const std::string output : {"out.mp4", "out.mkv", "out.y4m", "out/", "%03d.png"}) {
    const ProgramRun run = render("in.mp4", output);
    ASSERT_EQ(run.status, 0) << output << ": " << run.error;
    EXPECT_EQ(run.error, "") << output;
    const auto played = play(path(output));
    ASSERT_TRUE(played) << played.error().message();
    EXPECT_EQ(played->frames.size(), 4u) << output;
    EXPECT_EQ(played->format.frame.size, (hal::FrameSize{64, 48})) << output;
  }
}

TEST_F(Render, KeepsTheTimesOfTheRecording) {
  using std::chrono_literals::operator""ms;
  const std::vector<hal::Duration> times{0ms, 33ms, 50ms, 200ms};
  writeMedia(path("in.mp4"), 4, {64, 48}, times);
  ASSERT_EQ(render("in.mp4", "out.mp4").status, 0);
  const auto played = play(path("out.mp4"));
  ASSERT_TRUE(played);
  EXPECT_EQ(played->times, times);
}

TEST_F(Render, GivesTheSameBytesOnEveryRun) {
  writeMedia(path("in.y4m"), 8, {96, 80});
  ASSERT_EQ(render("in.y4m", "a.mp4").status, 0);
  ASSERT_EQ(render("in.y4m", "b.mp4").status, 0);
  EXPECT_FALSE(contentOf(path("a.mp4")).empty());
  EXPECT_TRUE(contentOf(path("a.mp4")) == contentOf(path("b.mp4")));
}

TEST_F(Render, PaintsPicturesFromOnePixelUpwards) {
  for (const hal::FrameSize size :
       {hal::FrameSize{1, 1}, {1, 40}, {40, 1}, {2, 3}, {7, 9}, {33, 65}}) {
    writeMedia(path("in.png"), 1, size);
    const ProgramRun run = render("in.png", "out.png");
    ASSERT_EQ(run.status, 0) << size.width << "x" << size.height << ": " << run.error;
    const auto picture = hal::readPictureRgb(path("out.png"));
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->size(), size);
  }
}

TEST_F(Render, ScalesToASizeAndStopsAfterSoManyFrames) {
  writeMedia(path("in.mp4"), 5);
  ASSERT_EQ(render("in.mp4", "out.mkv", {"--size", "100x40", "--frames", "2"}).status, 0);
  const auto played = play(path("out.mkv"));
  ASSERT_TRUE(played);
  EXPECT_EQ(played->frames.size(), 2u);
  EXPECT_EQ(played->format.frame.size, (hal::FrameSize{100, 40}));
}

TEST_F(Render, ShowsEveryViewAndEachIsAnother) {
  writeMedia(path("in.png"), 1, {128, 96});
  ASSERT_EQ(render("in.png", "painted.png").status, 0);
  std::set<std::string> pictures{contentOf(path("painted.png"))};
  for (const std::string view : {"camera", "cells", "seeds", "edges", "means"}) {
    const ProgramRun run = render("in.png", view + ".png", {"--view", view});
    ASSERT_EQ(run.status, 0) << run.error;
    EXPECT_TRUE(pictures.insert(contentOf(path(view + ".png"))).second) << view;
  }
}

TEST_F(Render, WithoutAStyleGivesThePictureBack) {
  writeMedia(path("in.png"), 1, {50, 30});
  ASSERT_EQ(render("in.png", "out.png", {"--style", "none"}).status, 0);
  auto in = hal::readPictureRgb(path("in.png"));
  auto out = hal::readPictureRgb(path("out.png"));
  ASSERT_TRUE(in && out);
  EXPECT_TRUE(std::ranges::equal(in->plane(0), out->plane(0)));
}

TEST_F(Render, GivesTheSoundFramesOfARecordingThatBreaksOff) {
  writeMedia(path("in.mp4"), 40, {96, 80});
  const std::string whole = contentOf(path("in.mp4"));
  std::ofstream(path("cut.mp4"), std::ios::binary) << whole.substr(0, whole.size() * 2 / 3);
  const ProgramRun run = render("cut.mp4", "out.mp4");
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_THAT(run.error, HasSubstr("pleinair: warning: "));
  EXPECT_THAT(run.error, HasSubstr("cut.mp4"));
  const auto played = play(path("out.mp4"));
  ASSERT_TRUE(played);
  EXPECT_GT(played->frames.size(), 0u);
  EXPECT_LT(played->frames.size(), 40u);
}

TEST_F(Render, WritesPosesALineAFrame) {
  const ProgramRun recorded =
      runProgram({"record", "--camera", "synthetic", "--frames", "3", "--output", path("desk.mp4"),
                  "--write-scene", path("desk.toml")});
  ASSERT_EQ(recorded.status, 0) << recorded.error;
  const ProgramRun run =
      render("desk.mp4", "out.mp4", {"--scene", path("desk.toml"), "--poses", path("poses.jsonl")});
  ASSERT_EQ(run.status, 0) << run.error;
  std::ifstream lines(path("poses.jsonl"));
  int frames = 0;
  for (std::string line; std::getline(lines, line); ++frames) {
    const nlohmann::json json = nlohmann::json::parse(line);
    EXPECT_EQ(json.at("frame"), frames);
    EXPECT_NEAR(json.at("time_s").get<double>(), frames / 30.0, 1e-4);
    EXPECT_EQ(json.at("cameraFromWorld").size(), 16u);
    EXPECT_EQ(json.at("cameraFromWorld").at(15), 1.0);
    ASSERT_FALSE(json.at("tags").empty());
    for (const nlohmann::json& tag : json.at("tags")) {
      EXPECT_EQ(tag.at("corners").size(), 4u);
      EXPECT_EQ(tag.at("cameraFromTag").size(), 16u);
    }
  }
  EXPECT_EQ(frames, 3);
}

TEST_F(Render, RecordsTheShotsOfTheWorkbench) {
  const auto record = [this](const std::string& shot, const std::string& name) {
    const ProgramRun run = runProgram(
        {"record", "--camera", "synthetic:" + shot, "--frames", "2", "--set", "camera.rate=1",
         "--set", "camera.synthetic.noise=0", "--size", "64x48", "--output", path(name)});
    EXPECT_EQ(run.status, 0) << run.error;
    return run;
  };
  record("still", "still/");
  record("pan", "pan/");
  EXPECT_TRUE(contentOf(path("still/000000.png")) == contentOf(path("still/000001.png")));
  EXPECT_FALSE(contentOf(path("pan/000000.png")) == contentOf(path("pan/000001.png")));
}

TEST_F(Render, WarnsOfTagsThatNeverAppear) {
  const ProgramRun recorded = runProgram({"record", "--frames", "1", "--output", path("desk.png")});
  ASSERT_EQ(recorded.status, 0) << recorded.error;
  EXPECT_THAT(recorded.out, testing::StartsWith("recorded 1 frame in "));
  std::ofstream(path("scene.toml")) << "[[tag]]\nid = 40\nedge_m = 0.1\n";
  const ProgramRun run = render("desk.png", "out.png", {"--scene", path("scene.toml")});
  EXPECT_EQ(run.status, 0);
  EXPECT_THAT(run.error, HasSubstr("warning: the scene has no [camera]: a field of view of 60°"));
  EXPECT_THAT(run.error, HasSubstr("warning: tag 40 of the scene was never seen; seen: 0, "));
  EXPECT_EQ(std::ranges::count(run.error, '\n'), 2) << run.error;
}

TEST_F(Render, WritesAContactSheetOfPairs) {
  writeMedia(path("in.mp4"), 9, {64, 48});
  ASSERT_EQ(render("in.mp4", "out.mp4", {"--contact-sheet", path("sheet.png")}).status, 0);
  const auto sheet = hal::readPictureRgb(path("sheet.png"));
  ASSERT_TRUE(sheet);
  EXPECT_GT(sheet->size().width, 4 * 64);
  EXPECT_GT(sheet->size().height, 3 * 48);
}

TEST_F(Render, LeavesNothingBehindWhenTerminatedBeforeTheFirstFrame) {
  writeMedia(path("in.y4m"), 300, {640, 480});
  ProgramLimits limits;
  limits.terminateWhenExists = path(".out.mp4.part");
  const ProgramRun run =
      runProgram({"render", "--input", path("in.y4m"), "--output", path("out.mp4")}, limits);
  EXPECT_EQ(run.status, 128 + 15);
  EXPECT_EQ(run.error, "pleinair: interrupted by SIGTERM; nothing was written\n");
  EXPECT_EQ(folder_.entryCount(), 1u);
}

TEST_F(Render, CompletesAMovieWhenTerminated) {
  writeMedia(path("in.y4m"), 300, {640, 480});
  for (const std::string output : {"out.mp4", "out.mkv", "out.y4m"}) {
    const std::string poses = path(".poses.json.part");
    ProgramLimits limits;
    limits.meanwhile = [&](pid_t program) {
      std::error_code ignored;
      const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
      while (!std::filesystem::exists(poses) || std::filesystem::file_size(poses, ignored) == 0) {
        if (std::chrono::steady_clock::now() > deadline) break;
        std::this_thread::yield();
      }
      kill(program, SIGINT);
    };
    const ProgramRun run = runProgram({"render", "--input", path("in.y4m"), "--output",
                                       path(output), "--poses", path("poses.json")},
                                      limits);
    EXPECT_EQ(run.status, 128 + SIGINT) << run.error;
    const auto played = play(path(output));
    ASSERT_TRUE(played) << output << ": " << played.error().message();
    const std::size_t frames = played->frames.size();
    EXPECT_GT(frames, 0u);
    EXPECT_LT(frames, 300u);
    const std::string kept = frames == 1
                                 ? "the frame so far is kept in "
                                 : "the " + std::to_string(frames) + " frames so far are kept in ";
    EXPECT_EQ(run.error, "pleinair: interrupted by SIGINT; " + kept + path(output) + "\n");
    EXPECT_THAT(run.out, HasSubstr("painted " + std::to_string(frames) + " frame"));
    const std::string lines = contentOf(path("poses.json"));
    EXPECT_EQ(std::ranges::count(lines, '\n'), static_cast<std::ptrdiff_t>(frames));
    std::filesystem::remove(path("poses.json"));
    std::filesystem::remove(path(output));
    EXPECT_EQ(folder_.entryCount(), 1u) << "no partial file";
  }
}

TEST_F(Render, RefusesAFolderThatAnotherRunPaintsInto) {
  writeMedia(path("in.y4m"), 300, {640, 480});
  ProgramLimits limits;
  ProgramRun second;
  limits.meanwhile = [&](pid_t first) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!std::filesystem::exists(path("out/000000.png"))) {
      if (std::chrono::steady_clock::now() > deadline) break;
      std::this_thread::yield();
    }
    second = render("in.y4m", "out/", {"--frames", "2"});
    kill(first, SIGINT);
  };
  runProgram({"render", "--input", path("in.y4m"), "--output", path("out/")}, limits);
  EXPECT_EQ(second.status, 1);
  EXPECT_THAT(second.error, HasSubstr("another run writes pictures of these names; wait for its "
                                      "end, or give another folder"));
}

TEST_F(Render, CleansUpAfterAKilledRun) {
  writeMedia(path("in.y4m"), 2);
  std::filesystem::create_directory(path("out"));
  std::ofstream(path("out/.000007.png.part")) << "half a picture";
  std::ofstream(path("out/.%06d.png.part")) << "";
  std::ofstream(path("out/.notes.part")) << "somebody else's";
  ProgramRun run = render("in.y4m", "out/");
  ASSERT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(run.error, "");
  EXPECT_FALSE(std::filesystem::exists(path("out/.000007.png.part")));
  EXPECT_FALSE(std::filesystem::exists(path("out/.%06d.png.part")));
  EXPECT_TRUE(std::filesystem::exists(path("out/.notes.part")));

  std::ofstream(path(".old.mp4.part")) << "what there is of a movie";
  run = render("in.y4m", "new.mp4");
  ASSERT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(run.error, "pleinair: warning: " + path(".old.mp4.part") +
                           ": was left by a run that was killed; it plays up to there: rename it, "
                           "or remove it\n");
}

TEST_F(Render, KeepsTheWholePicturesOfAFolderWhenTerminated) {
  writeMedia(path("in.y4m"), 300, {640, 480});
  ProgramLimits limits;
  limits.terminateWhenExists = path("out/000001.png");
  const ProgramRun run =
      runProgram({"render", "--input", path("in.y4m"), "--output", path("out/")}, limits);
  EXPECT_EQ(run.status, 128 + 15);
  std::size_t pictures = 0;
  for (const auto& entry : std::filesystem::directory_iterator(path("out"))) {
    EXPECT_TRUE(hal::readPicture(entry.path())) << entry.path();
    ++pictures;
  }
  EXPECT_EQ(run.error, "pleinair: interrupted by SIGTERM; the " + std::to_string(pictures) +
                           " frames so far are kept in " + path("out/") + "\n");
}

TEST_F(Render, PaintsPicturesOfSeveralSizesAndKindsAtTheFirstsSize) {
  std::filesystem::create_directory(path("in"));
  writeMedia(path("in/0.png"), 1, {64, 48});
  hal::Image grey({.pixelFormat = hal::PixelFormat::kGrey8, .size = {90, 120}, .encoding = {}});
  std::ranges::fill(grey.plane(0), std::uint8_t{200});
  hal::orThrow(hal::writePng(path("in/1.png"), grey.view()));
  const ProgramRun run = render("in", "out/", {"--style", "none"});
  ASSERT_EQ(run.status, 0) << run.error;
  const ProgramRun movie = render("in", "out.mp4");
  ASSERT_EQ(movie.status, 0) << movie.error;
  const auto played = play(path("out.mp4"));
  ASSERT_TRUE(played);
  EXPECT_EQ(played->format.frame.size, (hal::FrameSize{64, 48}));
  EXPECT_EQ(played->frames.size(), 2u);
  EXPECT_TRUE(played->changes.empty());
  // The second fills the picture of the first's size, and is what it was.
  auto second = hal::readPictureRgb(path("out/000001.png"));
  ASSERT_TRUE(second);
  ASSERT_EQ(second->size(), (hal::FrameSize{64, 48}));
  EXPECT_TRUE(std::ranges::all_of(second->plane(0), [](int byte) { return byte == 200; }));
}

TEST(Program, ListsStylesWithTheirParameters) {
  const ProgramRun run = runProgram({"styles"});
  EXPECT_EQ(run.status, 0);
  EXPECT_THAT(run.out, HasSubstr("watercolor"));
  EXPECT_THAT(run.out, HasSubstr("cell_size"));
  std::istringstream lines(run.out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 110u) << line;
}

TEST(Program, FailsWhereWhatItPrintsDoesNotArrive) {
  ProgramLimits limits;
  limits.printsInto = "/dev/full";
  for (const std::string command : {"styles", "--help"}) {
    const ProgramRun run = runProgram({command}, limits);
    EXPECT_EQ(run.status, 2) << command;
    EXPECT_EQ(run.error, "pleinair: standard output: cannot write: No space left on device\n");
  }
}

TEST(Program, OutlivesItsLog) {
  const TemporaryFolder folder;
  const std::string in = (folder.path() / "in.y4m").string();
  const std::string out = (folder.path() / "out.mp4").string();
  writeMedia(in, 3);
  for (const auto& [streams, status] :
       {std::pair{Streams::kClosedError, 0}, {Streams::kBrokenPipes, 0}, {Streams::kClosed, 2}}) {
    ProgramLimits limits;
    limits.streams = streams;
    EXPECT_EQ(
        runProgram({"render", "--input", in, "--output", out, "--scene", "/none"}, limits).status,
        2);
    const ProgramRun run = runProgram({"render", "--input", in, "--output", out}, limits);
    EXPECT_EQ(run.status, status) << static_cast<int>(streams);
    const auto played = play(out);
    ASSERT_TRUE(played) << played.error().message();
    EXPECT_EQ(played->frames.size(), 3u);
    std::filesystem::remove(out);
  }
}

TEST(Program, EndsInSilenceWhereTheReaderHasHadEnough) {
  ProgramLimits limits;
  limits.streams = Streams::kBrokenOutput;
  const ProgramRun run = runProgram({"styles"}, limits);
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.error, "");
}

TEST(Program, HelpsAndSaysItsVersion) {
  EXPECT_THAT(runProgram({"--help"}).out, HasSubstr("render"));
  EXPECT_THAT(runProgram({"render", "--help"}).out, HasSubstr("--input"));
  EXPECT_EQ(runProgram({"--version"}).status, 0);
  EXPECT_EQ(runProgram({}).status, 2);
}

}  // namespace
}  // namespace pleinair::support
