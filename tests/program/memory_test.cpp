// How much memory a painting takes, and that it takes no more the longer it goes on.
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hal/outputs/registry.h"
#include "tests/program/program.h"
#include "tests/support/tag_scene.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::support {
namespace {

namespace fs = std::filesystem;

class Memory : public testing::Test {
 protected:
  void SetUp() override {
    if (isSanitized()) GTEST_SKIP() << "sanitizers take memory of their own";
    std::ofstream(path("scene.toml"))
        << "[[tag]]\nid = 0\nedge_m = 0.12\nposition_m = [0, 0, 0]\n"
           "[[model]]\nsource = \"builtin:gear\"\nattach = \"tag:0\"\n";
  }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  /// At most, while so many frames are painted with a gear on tag 0.
  long peakMebibytes(const std::string& input, int frames) const {
    const ProgramRun run = runProgram(
        {"render", "--input", input, "--scene", path("scene.toml"), "--output", path("out.mp4"),
         "--poses", path("poses.jsonl"), "--frames", std::to_string(frames)},
        {.time = std::chrono::seconds(280)});
    EXPECT_EQ(run.status, 0) << run.error;
    EXPECT_NE(run.out.find(" " + std::to_string(frames) + " frames"), std::string::npos) << run.out;
    RecordProperty("mebibytes_after_" + std::to_string(frames),
                   static_cast<int>(run.peakMemoryMebibytes));
    return run.peakMemoryMebibytes;
  }

  TemporaryFolder folder_;
};

/// A tag that is turned to and fro, every tenth frame without it.
void writeTagMovie(const fs::path& path, hal::FrameSize size, int count) {
  const tracking::CameraModel camera({.fx = 1.0 * size.width,
                                      .fy = 1.0 * size.width,
                                      .cx = size.width / 2.0,
                                      .cy = size.height / 2.0},
                                     {}, size);
  std::vector<hal::Image> pictures;
  for (int i = 0; i < 10; ++i) {
    const SceneTag tag{.edgeMetres = 0.12,
                       .worldFromTag = poseOf({0.03 * i, 0.0, 0.05 * i}, {0.0, 0.0, 0.3})};
    const std::size_t shown = i == 9 ? 0 : 1;
    pictures.push_back(neutralPicture(renderTags(camera, glm::dmat4(1.0), {&tag, shown}),
                                      hal::PixelFormat::kI420));
  }
  const auto output = hal::orThrow(hal::openFileOutput(path));
  constexpr hal::Duration kPeriod = std::chrono::milliseconds(40);
  hal::orThrow(output->start({.size = size, .framePeriod = kPeriod}));
  for (int i = 0; i < count; ++i) {
    hal::orThrow(output->write(pictures[static_cast<std::size_t>(i % 10)].view(), i * kPeriod));
  }
  hal::orThrow(output->finish());
}

/// A frame of this size takes 13 KB, and much is kept of each: what grows with the frames shows.
TEST_F(Memory, StaysFlatOverTwoThousandFrames) {
  constexpr int kFrames = 2000;
  const std::string input = path("in.mp4");
  writeTagMovie(input, {112, 80}, kFrames);
  const long early = peakMebibytes(input, kFrames / 4);
  const long late = peakMebibytes(input, kFrames);
  EXPECT_LE(late, early + 6) << "two runs differ by up to 3";
}

TEST_F(Memory, IsBoundedAt720Lines) {
  const fs::path input =
      fs::path(PLEINAIR_SHARED_DATA) / "sequences/desk_6dof/planar6dof_720p_slow.mp4";
  if (!fs::exists(input)) GTEST_SKIP() << "test data is not here: " << input;
  const long early = peakMebibytes(input.string(), 30);
  const long late = peakMebibytes(input.string(), 150);
  EXPECT_LT(late, 415)
      << "a software renderer keeps textures here, too; 18 are for movers before models, and a "
         "dozen for shaders that are compiled in the run";
  EXPECT_LE(late, early + 16);
}

}  // namespace
}  // namespace pleinair::support
