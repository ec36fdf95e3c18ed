#pragma once

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hal/image.h"
#include "hal/outputs/v4l2_loopback/loopback_output.h"
#include "tests/support/fake_loopback.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::hal {

/// Fake nodes in their own folder.
class LoopbackTest : public testing::Test {
 protected:
  support::FakeOutputNode& addNode(const std::string& name) {
    std::ofstream(folder_.path() / name).flush();
    return fake_.node(pathOf(name));
  }
  void removeNode(const std::string& name) {
    std::filesystem::remove(folder_.path() / name);
    fake_.remove(pathOf(name));
  }
  std::string pathOf(const std::string& name) const { return (folder_.path() / name).string(); }
  V4l2System system() { return {.calls = &fake_, .nodes = folder_.path()}; }

  std::unique_ptr<MemoryOutput> open(const std::string& name,
                                     std::optional<PixelFormat> layout = {}) {
    Result<std::unique_ptr<MemoryOutput>> output = openLoopback(name, layout, system());
    EXPECT_TRUE(output) << output.error().message();
    return output ? *std::move(output) : nullptr;
  }

  /// An image with luma and chroma that differ from byte to byte.
  static Image picture(const FrameFormat& format) {
    Image image(format);
    for (int plane = 0; plane < planeCount(format.pixelFormat); ++plane) {
      std::iota(image.plane(plane).begin(), image.plane(plane).end(),
                static_cast<std::uint8_t>(plane * 80 + 1));
    }
    return image;
  }

  static Result<OutputFormat> start(MemoryOutput& output, FrameSize size = {32, 16}) {
    return output.start({.size = size, .framePeriod = std::chrono::milliseconds(40)});
  }
  static FrameFormat startOrFail(MemoryOutput& output, FrameSize size = {32, 16}) {
    const Result<OutputFormat> format = start(output, size);
    EXPECT_TRUE(format) << (format ? "" : format.error().message());
    return format.value_or(OutputFormat{}).frame;
  }

  support::TemporaryFolder folder_;
  support::FakeLoopback fake_;
};

}  // namespace pleinair::hal
