// The TOML examples of the documentation are files that are read.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/config_error.h"
#include "pipeline/scene/scene_file.h"
#include "pipeline/tracking/calibration_file.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

const std::filesystem::path kRoot = std::filesystem::path(PLEINAIR_TESTS_DIR) / "..";
/// A block that begins with this is a calibration; the others are scenes.
const std::string kCalibration = "# camera.toml";

std::string textOf(const std::filesystem::path& path) {
  std::ifstream file(path);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::string> tomlBlocks(const std::filesystem::path& path) {
  static const std::string opening = "```toml\n";
  const std::string text = textOf(path);
  std::vector<std::string> blocks;
  for (std::size_t at = text.find(opening); at != std::string::npos; at = text.find(opening, at)) {
    const std::size_t begin = at + opening.size();
    at = text.find("```", begin);
    blocks.push_back(text.substr(begin, at - begin));
  }
  return blocks;
}

TEST(DocumentedFiles, AreRead) {
  const auto guide = tomlBlocks(kRoot / "docs" / "scene-files.md");
  const auto readme = tomlBlocks(kRoot / "README.md");
  EXPECT_GE(guide.size(), 5u);
  EXPECT_GE(readme.size(), 1u);
  std::vector<std::string> blocks = guide;
  blocks.insert(blocks.end(), readme.begin(), readme.end());

  const support::TemporaryFolder folder;
  int calibrations = 0;
  for (const std::string& block : blocks) {
    if (!block.starts_with(kCalibration)) continue;
    ++calibrations;
    std::ofstream(folder.path() / "camera.toml") << block;
    EXPECT_NO_THROW(tracking::loadCalibration(folder.path() / "camera.toml")) << block;
  }
  EXPECT_GE(calibrations, 1);
  for (const std::string& block : blocks) {
    if (block.starts_with(kCalibration)) continue;
    try {
      scene::parseScene(block, "example", folder.path());
    } catch (const config::ConfigError& error) {
      ADD_FAILURE() << error.what() << "\n" << block;
    }
  }
}

TEST(DocumentedFiles, GuideShowsTheMessageOfAMistake) {
  const std::string mistake =
      "[[tag]]\nid = 0\nedge = 0.12\n[[model]]\nsource = \"builtin:gear\"\nattach = \"tag:0\"\n";
  try {
    scene::parseScene(mistake, "desk.toml", {});
    FAIL() << "taken";
  } catch (const config::ConfigError& error) {
    EXPECT_THAT(textOf(kRoot / "docs" / "scene-files.md"),
                testing::HasSubstr("pleinair: " + std::string(error.what())));
  }
}

}  // namespace
}  // namespace pleinair::app
