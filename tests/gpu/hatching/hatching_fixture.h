#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "pipeline/styles/hatching/hatching.h"
#include "tests/gpu/painterly/painterly_fixture.h"

namespace pleinair::styles {

/// A line as shaders/line.glsl stores it.
struct StoredLine {
  std::array<std::uint32_t, 16> ways;
  glm::vec2 lengths;
  float rank;
  float seen;
  glm::vec2 shift;
  float bend;
  std::uint32_t label;
};
static_assert(sizeof(StoredLine) == HatchLines::kLineBytes);

/// A line as it is drawn (strokes/shaders/long_instance.glsl).
struct DrawnLine {
  std::array<glm::vec2, 16> points;
  std::array<float, 16> halfWidths;
  glm::vec4 paint;
  float halfWidth;
  float variant;
  float object;
  float rank;
};
static_assert(sizeof(DrawnLine) == instanceBytesOf(StrokeForm::kLong));

/// Hatching over pictures that the test makes.
class HatchingTest : public PainterlyTest {
 protected:
  using Settings = std::initializer_list<std::pair<const char*, const char*>>;
  static void set(Hatching& style, Settings settings) {
    config::ParameterValues values = style.parameters();
    for (const auto& [name, value] : settings) values = values.with(name, value);
    style.setParameters(values);
  }

  /// Of lengths, which are given for pictures of 640x480.
  static double scaleOf(hal::FrameSize size) {
    return std::max(0.6, std::sqrt(static_cast<double>(size.pixels()) / 307200.0));
  }

  static hal::Image imageOf(hal::FrameSize size, const std::function<double(int, int)>& luma) {
    hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = size});
    for (int y = 0; y < size.height; ++y) {
      auto* p = image.row(0, y).data();
      for (int x = 0; x < size.width; ++x, p += 4) {
        const auto grey =
            static_cast<std::uint8_t>(std::lround(std::clamp(luma(x, y), 0.0, 1.0) * 255.0));
        p[0] = p[1] = p[2] = grey;
        p[3] = 255;
      }
    }
    return image;
  }
  static hal::Image flat(double luma, hal::FrameSize size = kSize) {
    return imageOf(size, [luma](int, int) { return luma; });
  }

  /// How much ink lies on each pixel, in 1/255.
  static std::vector<std::uint8_t> inkOf(const Hatching& style) {
    const std::vector<std::uint8_t> bytes = bytesOf(style.ink());
    std::vector<std::uint8_t> ink;
    for (std::size_t i = 3; i < bytes.size(); i += 4) ink.push_back(bytes[i]);
    return ink;
  }
  static double meanOf(const std::vector<std::uint8_t>& ink) {
    double sum = 0.0;
    for (const std::uint8_t each : ink) sum += each;
    return sum / static_cast<double>(ink.size());
  }

  static std::vector<DrawnLine> drawnLines(const HatchLines& set) {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    auto all = support::readBuffer<DrawnLine>(set.instances());
    all.resize(support::readBuffer<std::uint32_t>(set.command())[1]);
    return all;
  }
  static std::vector<StoredLine> storedLines(const HatchLines& set) {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    return support::readBuffer<StoredLine>(set.lines());
  }
};

}  // namespace pleinair::styles
