// The TOML examples of the documentation are files that are read.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/config_error.h"
#include "firmware_app/config/configuration.h"
#include "pipeline/scene/description/scene_file.h"
#include "pipeline/tracking/camera/calibration_file.h"
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

/// Resolves the text as the site file "site.toml"; gives the error's text, or "".
std::string resolved(const std::string& text, const std::vector<std::string>& set = {}) {
  const support::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "site.toml";
  std::ofstream(file) << text;
  ConfigurationRequest request;
  request.siteFile = file;
  request.set = set;
  try {
    const Configuration configuration(request);
  } catch (const config::ConfigError& error) {
    const std::string message = error.what();
    const std::size_t at = message.find("site.toml:");
    return "pleinair: " + message.substr(at == std::string::npos ? 0 : at) + "\n";
  }
  return {};
}

TEST(DocumentedFiles, GuideToTheConfigurationShowsAFileThatIsTaken) {
  const auto blocks = tomlBlocks(kRoot / "docs" / "configuration.md");
  ASSERT_EQ(blocks.size(), 1u);
  EXPECT_EQ(resolved(blocks[0]), "");
  // And every key: whatever is printed is shown, but for the style's.
  ConfigurationRequest request;
  request.defaultSiteFile.clear();
  const std::string all = Configuration(request).toToml(config::Printed::kAll);
  std::istringstream lines(all.substr(0, all.find("[style.")));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t equals = line.find(" = ");
    if (line.starts_with('#') || equals == std::string::npos) continue;
    EXPECT_THAT("\n" + blocks[0], testing::HasSubstr("\n" + line.substr(0, equals) + " = "));
  }
}

TEST(DocumentedFiles, GuideToTheConfigurationShowsTheMessagesOfMistakes) {
  const std::string guide = textOf(kRoot / "docs" / "configuration.md");
  EXPECT_THAT(guide, testing::HasSubstr(resolved("\n\n\n\n\n[painting]\nstlye = \"none\"\n")));
  EXPECT_THAT(guide, testing::HasSubstr(resolved("\ncell_size = 8\n")));
  EXPECT_THAT(guide, testing::HasSubstr(resolved("", {"cell_size=0"})));
  EXPECT_THAT(guide, testing::HasSubstr(resolved("[output]\nstills = \".\"\n")));
}

}  // namespace
}  // namespace pleinair::app
