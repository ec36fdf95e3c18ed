// Whatever is wrong with what the user gave: one clear line, exit status 2, and nothing under the
// output's name.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/media/picture_file.h"
#include "hal/media/png_file.h"
#include "tests/program/program.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::support {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class BadInput : public testing::Test {
 protected:
  BadInput() {
    writeMedia(path("in.mp4"), 3);
    writeMedia(path("in.png"), 1);
  }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }

  std::string contentOf(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::size_t entriesIn(const std::string& name) const {
    const std::filesystem::directory_iterator first(path(name));
    return static_cast<std::size_t>(std::distance(first, std::filesystem::directory_iterator()));
  }

  /// Renders with these arguments in addition to input and output, and expects the failure.
  void expectFailure(std::vector<std::string> arguments, const testing::Matcher<std::string>& error,
                     const ProgramLimits& limits = {}) const {
    const std::size_t before = folder_.entryCount();
    arguments.insert(arguments.begin(), "render");
    addDefault(arguments, "--input", path("in.mp4"));
    addDefault(arguments, "--output", path("out.mp4"));
    const ProgramRun run = runProgram(arguments, limits);
    EXPECT_EQ(run.status, 2) << run.error;
    EXPECT_THAT(run.error, error);
    EXPECT_EQ(std::ranges::count(run.error, '\n'), 1) << run.error;
    EXPECT_THAT(run.error, testing::StartsWith("pleinair: "));
    EXPECT_EQ(folder_.entryCount(), before) << "something was left behind";
  }

  TemporaryFolder folder_;

 private:
  static void addDefault(std::vector<std::string>& arguments, const std::string& name,
                         const std::string& value) {
    if (std::ranges::find(arguments, name) != arguments.end()) return;
    arguments.push_back(name);
    arguments.push_back(value);
  }
};

TEST_F(BadInput, MissingInput) {
  expectFailure({"--input", path("absent.mp4")}, HasSubstr("absent.mp4"));
}

TEST_F(BadInput, UnknownStyleListsTheStyles) {
  expectFailure(
      {"--style", "watercolour"},
      HasSubstr("--style: found \"watercolour\" (did you mean \"watercolor\"?), allowed: one of "
                "watercolor, painterly, hatching, none\n"));
}

TEST_F(BadInput, UnknownViewListsTheViews) {
  expectFailure({"--view", "celsl"}, AllOf(HasSubstr("celsl"), HasSubstr("cells")));
}

TEST_F(BadInput, UnknownParameterListsTheParameters) {
  expectFailure({"--set", "cellsize=8"}, AllOf(HasSubstr("cellsize"), HasSubstr("cell_size")));
}

TEST_F(BadInput, ParameterOutOfRangeSaysTheRange) {
  expectFailure({"--set", "cell_size=0"}, AllOf(HasSubstr("cell_size"), HasSubstr("px")));
}

TEST_F(BadInput, MalformedSetting) {
  expectFailure({"--set", "cell_size"}, HasSubstr("NAME=VALUE"));
  expectFailure({"--set", "=8"}, HasSubstr("found \"=8\", allowed: NAME=VALUE"));
}

TEST_F(BadInput, UnknownOption) {
  expectFailure({"--stlye", "x"}, HasSubstr("--stlye"));
}

TEST_F(BadInput, MalformedSize) {
  expectFailure({"--size", "640"}, AllOf(HasSubstr("640"), HasSubstr("1280x720")));
  expectFailure({"--size", "9000x16"}, HasSubstr("8192"));
}

TEST_F(BadInput, BrokenMovie) {
  expectFailure({"--input", write("broken.mp4", "no movie at all")}, HasSubstr("broken.mp4"));
}

TEST_F(BadInput, BrokenPicture) {
  expectFailure({"--input", write("broken.png", "\x89PNG\r\n\x1a\n and no more")},
                HasSubstr("broken.png"));
}

TEST_F(BadInput, PictureBeyondTheLimitsIsRefusedFromItsHeader) {
  // Signature and an IHDR of 65535 × 65535, and not a byte of pixels.
  std::string png = "\x89PNG\r\n\x1a\n";
  png += std::string("\0\0\0\rIHDR\0\0\xff\xff\0\0\xff\xff\x08\x02\0\0\0", 21);
  png += std::string("\0\0\0\0", 4);
  expectFailure({"--input", write("huge.png", png)},
                AllOf(HasSubstr("huge.png"), HasSubstr("65535"), HasSubstr("8192")));
}

TEST_F(BadInput, BrokenToml) {
  expectFailure({"--scene", write("scene.toml", "[[tag]\nid = 1\n")}, HasSubstr("scene.toml:1"));
}

TEST_F(BadInput, UnknownSceneKey) {
  expectFailure({"--scene", write("scene.toml", "[[tag]]\nid = 0\nedge_m = 0.1\ncolor = 1\n")},
                AllOf(HasSubstr("scene.toml:4"), HasSubstr("color")));
}

TEST_F(BadInput, UnknownTagFamily) {
  expectFailure(
      {"--scene", write("scene.toml", "[[tag]]\nfamily = \"tag37h11\"\nid = 0\nedge_m = 0.1\n")},
      AllOf(HasSubstr("tag37h11"), HasSubstr("tag36h11")));
}

TEST_F(BadInput, CalibrationForAnotherSize) {
  write("camera.toml",
        "image_size = [1280, 720]\nfx = 1000\nfy = 1000\ncx = 640\ncy = 360\n"
        "pixel_centres = \"half\"\n");
  expectFailure({"--scene", write("scene.toml", "[camera]\ncalibration = \"camera.toml\"\n")},
                AllOf(HasSubstr("1280"), HasSubstr("64"), HasSubstr("48")));
}

TEST_F(BadInput, UnknownOutputKind) {
  expectFailure({"--output", path("out.gif")}, AllOf(HasSubstr("out.gif"), HasSubstr(".mp4")));
}

TEST_F(BadInput, OutputInAFolderThatIsNotThere) {
  expectFailure({"--output", path("absent/out.mp4")}, HasSubstr("absent"));
}

TEST_F(BadInput, OutputThatIsTheInput) {
  expectFailure({"--output", path("in.mp4")}, HasSubstr("in.mp4"));
}

TEST_F(BadInput, OutputThatLeadsToTheInput) {
  std::filesystem::create_symlink("in.mp4", path("link.mp4"));
  expectFailure({"--output", path("link.mp4")}, AllOf(HasSubstr("link.mp4"), HasSubstr("--input")));
}

TEST_F(BadInput, PatternThatIsTheInputsPattern) {
  std::filesystem::create_directory(path("in"));
  writeMedia(path("in/%04d.png"), 3);
  const std::string before = contentOf("in/0000.png");
  expectFailure({"--input", path("in/%04d.png"), "--output", path("in/../in/%04d.png")},
                AllOf(HasSubstr("%04d.png"), HasSubstr("folder of --input")));
  EXPECT_TRUE(contentOf("in/0000.png") == before);
}

TEST_F(BadInput, PicturesIntoTheFolderThatIsRead) {
  std::filesystem::create_directory(path("in"));
  writeMedia(path("in"), 3);
  for (const std::string output : {"in", "in/", "in/painted-%d.png"}) {
    expectFailure({"--input", path("in"), "--output", path(output)},
                  AllOf(HasSubstr("in"), HasSubstr("folder of --input")));
  }
  EXPECT_EQ(entriesIn("in"), 3u);
}

TEST_F(BadInput, PictureAmongThoseThatAreRead) {
  std::filesystem::create_directory(path("in"));
  writeMedia(path("in"), 3);
  expectFailure({"--input", path("in"), "--contact-sheet", path("in/000001.png")},
                AllOf(HasSubstr("000001.png"), HasSubstr("--input")));
  expectFailure({"--input", path("in/000002.png"), "--output", path("in/")},
                AllOf(HasSubstr("in/"), HasSubstr("--input")));
}

TEST_F(BadInput, PosesThatAreTheInput) {
  expectFailure({"--poses", path("in.mp4")}, AllOf(HasSubstr("in.mp4"), HasSubstr("--poses")));
}

TEST_F(BadInput, PosesThatAreTheScene) {
  const std::string scene = write("scene.toml", "");
  expectFailure({"--scene", scene, "--poses", path("./scene.toml")},
                AllOf(HasSubstr("--scene"), HasSubstr("--poses")));
}

TEST_F(BadInput, ContactSheetThatIsTheInput) {
  expectFailure({"--input", path("in.png"), "--contact-sheet", path("in.png")},
                AllOf(HasSubstr("in.png"), HasSubstr("--contact-sheet")));
}

TEST_F(BadInput, TwoThingsUnderOneName) {
  expectFailure({"--poses", path("out.mp4")}, AllOf(HasSubstr("--output"), HasSubstr("--poses")));
  expectFailure({"--poses", path("a.png"), "--contact-sheet", path("a.png")},
                AllOf(HasSubstr("--poses"), HasSubstr("--contact-sheet")));
}

TEST_F(BadInput, SceneThatIsTheRecording) {
  const ProgramRun run = runProgram(
      {"record", "--frames", "1", "--output", path("out.mp4"), "--write-scene", path("out.mp4")});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.error, AllOf(HasSubstr("--write-scene"), HasSubstr("--output")));
}

TEST_F(BadInput, TwoFramesIntoOnePicture) {
  expectFailure({"--output", path("out.png")}, HasSubstr("%"));
}

TEST_F(BadInput, FullDiskInMidMovie) {
  writeMedia(path("long.y4m"), 60);
  expectFailure({"--input", path("long.y4m"), "--output", path("out.y4m")}, HasSubstr("out.y4m"),
                {.fileBytes = 40'000});
}

TEST_F(BadInput, FullDiskAtTheEndOfAnMp4) {
  writeMedia(path("long.y4m"), 60);
  expectFailure({"--input", path("long.y4m"), "--output", path("out.mp4")},
                AllOf(HasSubstr("out.mp4"), HasSubstr("cannot write")), {.fileBytes = 4'000});
}

TEST_F(BadInput, FullDiskKeepsTheWholePicturesOfARow) {
  // A plain picture takes little room, and noise after it has none.
  std::filesystem::create_directory(path("in"));
  std::filesystem::create_directory(path("out"));
  hal::Image picture({.pixelFormat = hal::PixelFormat::kRgb8, .size = {160, 120}, .encoding = {}});
  hal::orThrow(hal::writePng(path("in/0.png"), picture.view()));
  std::minstd_rand noise(1);
  std::ranges::generate(picture.plane(0), [&] { return static_cast<std::uint8_t>(noise() >> 8); });
  hal::orThrow(hal::writePng(path("in/1.png"), picture.view()));
  expectFailure({"--style", "none", "--input", path("in/%d.png"), "--output", path("out/%d.png")},
                AllOf(HasSubstr("out/1.png"), HasSubstr("cannot write")), {.fileBytes = 40'000});
  EXPECT_EQ(entriesIn("out"), 1u);
  EXPECT_TRUE(hal::readPicture(path("out/0.png")));
}

TEST_F(BadInput, FullDiskForThePoses) {
  // Pictures have room, and 120 lines have not.
  constexpr int kFrames = 120;
  std::filesystem::create_directory(path("out"));
  writeMedia(path("long.y4m"), kFrames, {16, 16});
  expectFailure(
      {"--input", path("long.y4m"), "--output", path("out"), "--poses", path("poses.jsonl")},
      AllOf(HasSubstr("poses.jsonl"), HasSubstr("cannot write")), {.fileBytes = 4'000});
  ASSERT_GT(entriesIn("out"), 0u);
  for (const auto& entry : std::filesystem::directory_iterator(path("out"))) {
    EXPECT_TRUE(hal::readPicture(entry.path())) << entry.path();
  }
}

TEST_F(BadInput, PosesInAFolderThatIsNotThere) {
  expectFailure({"--output", path("new/"), "--poses", path("absent/poses.jsonl")},
                HasSubstr("absent"));
}

TEST_F(BadInput, ContactSheetInAFolderThatIsNotThere) {
  expectFailure({"--output", path("new/"), "--contact-sheet", path("absent/sheet.png")},
                HasSubstr("absent"));
}

TEST_F(BadInput, WrongStyleLeavesNoNewFolder) {
  expectFailure({"--output", path("new/"), "--style", "oil"}, HasSubstr("oil"));
  expectFailure({"--output", path("new/"), "--set", "cellsize=8"}, HasSubstr("cellsize"));
}

}  // namespace
}  // namespace pleinair::support
