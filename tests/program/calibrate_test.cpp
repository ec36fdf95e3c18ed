// `pleinair calibrate` on movies of boards that are rendered through a known lens.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/tracking/camera/calibration_file.h"
#include "tests/program/program.h"
#include "tests/support/board_movie.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::support {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class Calibrate : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  static std::string contentOf(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  /// A movie of a good tour.
  std::string movie() const {
    const std::string file = path("board.mp4");
    writeBoardMovie(file, board_, camera_, calibrationPoses(board_, camera_),
                    {.picture = {.samplesPerSide = 3, .blurSigmaPx = 0.6, .noiseSigma = 2.0},
                     .movingFrames = 1});
    return file;
  }

  ProgramRun calibrated(const std::string& input, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"calibrate", "--input", input, "--output",
                                       path("camera.toml")};
    if (std::ranges::find(more, "--board") == more.end()) {
      more.insert(more.end(), {"--board", "checkerboard:9x6", "--square", "0.025"});
    }
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(arguments);
  }

  void expectRefused(const ProgramRun& run, const testing::Matcher<std::string>& error) const {
    EXPECT_EQ(run.status, 2) << run.error;
    EXPECT_EQ(run.out, "");
    EXPECT_THAT(run.error, AllOf(HasSubstr("pleinair: "), error));
    EXPECT_FALSE(fs::exists(path("camera.toml")));
  }

  void expectGood(const ProgramRun& run) const {
    ASSERT_EQ(run.status, 0) << run.error;
    EXPECT_THAT(run.out, AllOf(StartsWith("calibrated from "), HasSubstr("px RMS")));
    const tracking::CameraModel found = tracking::loadCalibration(path("camera.toml"));
    EXPECT_EQ(found.imageSize(), camera_.imageSize());
    EXPECT_NEAR(found.intrinsics().fx / camera_.intrinsics().fx, 1.0, 0.003);
    EXPECT_LT(rayErrorPx(camera_, found), 0.5);
  }

  TemporaryFolder folder_;
  calibration::Board board_{calibration::Checkerboard{9, 6, 0.025}};
  tracking::CameraModel camera_{{520, 522, 324, 237}, {.k1 = -0.15, .k2 = 0.04}, {640, 480}};
};

TEST_F(Calibrate, FindsTheLensOfAMovie) {
  const std::string input = movie();
  const ProgramRun first = calibrated(input, {"--views-folder", path("views")});
  expectGood(first);
  EXPECT_THAT(first.out, testing::Not(HasSubstr("replaced")));
  EXPECT_TRUE(fs::exists(path("views/view-08.png")));
  EXPECT_TRUE(fs::exists(path("views/coverage.png")));
  const std::string text = contentOf(path("camera.toml"));

  const ProgramRun again = calibrated(input);
  EXPECT_EQ(again.status, 0) << again.error;
  EXPECT_THAT(again.out, HasSubstr("replaced " + path("camera.toml")));
  EXPECT_EQ(contentOf(path("camera.toml")), text);

  std::ofstream(path("camera.toml")) << "[[tag]]\nid = 0\n";
  const ProgramRun foreign = calibrated(input);
  EXPECT_EQ(foreign.status, 2);
  EXPECT_THAT(foreign.error, HasSubstr("is not a calibration, so it is not overwritten"));
  EXPECT_EQ(contentOf(path("camera.toml")), "[[tag]]\nid = 0\n");
}

TEST_F(Calibrate, ARefusedOneIsNotWrittenAndSaysWhy) {
  const std::string input = movie();
  expectRefused(
      calibrated(input, {"--board", "checkerboard:10x7", "--square", "0.025", "--frames", "8"}),
      AllOf(HasSubstr("the board is in none of"),
            HasSubstr("the frames show a checkerboard of 9x6 inner corners instead")));
  expectRefused(calibrated(input, {"--frames", "9"}),
                AllOf(HasSubstr("of 9 pictures"), HasSubstr("8 are needed")));
}

TEST_F(Calibrate, ACameraIsWatchedUntilItSuffices) {
  const ProgramRun run =
      runProgram({"calibrate", "--camera", movie(), "--board", "checkerboard:9x6", "--square",
                  "0.025", "--output", path("camera.toml")});
  expectGood(run);
}

TEST_F(Calibrate, RefusesFrontalViews) {
  std::vector<BoardHold> tour;
  for (const double y : {0.2, 0.5, 0.8}) {
    for (const double x : {0.2, 0.4, 0.6, 0.8}) tour.push_back({.at = {x, y}, .span = 0.33});
  }
  writeBoardMovie(
      path("frontal.mp4"), board_, camera_, tour,
      {.picture = {.samplesPerSide = 3, .blurSigmaPx = 0.6, .noiseSigma = 2.0}, .movingFrames = 1});
  expectRefused(calibrated(path("frontal.mp4")),
                AllOf(HasSubstr("the same angle"), HasSubstr("tilt the board by 30°")));
}

TEST_F(Calibrate, RefusesWhatMakesNoSense) {
  writeMedia(path("in.mp4"), 3);
  const auto refused = [&](std::vector<std::string> more, const std::string& error) {
    const ProgramRun run = calibrated(path("in.mp4"), std::move(more));
    expectRefused(run, HasSubstr(error));
    EXPECT_EQ(std::ranges::count(run.error, '\n'), 1) << run.error;
  };
  refused({}, "the board is in none of 3 pictures");
  refused({"--board", "circles:4x11"}, "--board: found \"circles:4x11\"; allowed: checkerboard:");
  refused({"--board", "checkerboard:9x6"}, "--square: is missing");
  refused({"--board", "aprilgrid:6x6", "--tag-edge", "0"}, "--tag-edge: found 0");
  refused({"--camera", "auto"}, "--input");
  refused({"--output", path("in.mp4")}, "--output");
  fs::create_directory(path("full"));
  std::ofstream(path("full/notes.txt")) << "mine";
  refused({"--views-folder", path("full")}, "is not empty");
}

}  // namespace
}  // namespace pleinair::support
