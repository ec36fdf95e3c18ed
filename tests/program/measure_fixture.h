#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "hal/media/png_file.h"
#include "tests/program/program.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::support {

/// Pictures to measure, and runs of `pleinair measure`.
class Measure : public testing::Test {
 protected:
  static constexpr hal::FrameSize kSize{200, 180};

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }
  std::string read(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  /// Squares of many colours, from a place on; violet where `isMover` says so.
  void writePicture(
      const std::string& name, int fromX, int fromY, hal::FrameSize size = kSize,
      const std::function<bool(int, int)>& isMover = [](int, int) { return false; }) {
    hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = size, .encoding = {}});
    for (int y = 0; y < size.height; ++y) {
      const auto row = image.row(0, y);
      for (int x = 0; x < size.width; ++x) {
        const auto cell = static_cast<unsigned>((x + fromX) / 9 * 7919 + (y + fromY) / 7 * 104729);
        for (unsigned c = 0; c < 3; ++c) {
          row[3 * static_cast<std::size_t>(x) + c] =
              static_cast<std::uint8_t>((cell * (c + 3) * 2654435761U) >> 24U);
          if (isMover(x, y)) row[3 * static_cast<std::size_t>(x) + c] = c == 1 ? 0 : 255;
        }
      }
    }
    hal::orThrow(hal::writePng(path(name), image.view()));
  }

  /// A pan of (-2, -1) px a frame over them.
  void writePan(int frames) {
    std::filesystem::create_directory(path("in"));
    for (int i = 0; i < frames; ++i) {
      writePicture("in/" + std::to_string(i) + ".png", 2 * i, i);
    }
    write("in/motion.json", R"({"v": [-2, -1]})");
  }

  static ProgramRun measured(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "measure");
    return runProgram(arguments);
  }

  static void expectRefused(const std::vector<std::string>& arguments,
                            const testing::Matcher<std::string>& error) {
    const ProgramRun run = measured(arguments);
    EXPECT_EQ(run.status, 2) << run.error;
    EXPECT_THAT(run.error, testing::AllOf(error, testing::StartsWith("pleinair: ")));
    EXPECT_EQ(std::ranges::count(run.error, '\n'), 1) << run.error;
    EXPECT_EQ(run.out, "");
  }

  TemporaryFolder folder_;
};

}  // namespace pleinair::support
