// The washes: a cell's two colours against the oracle, where washes end, what the paper does.
#include <algorithm>
#include <array>

#include "pipeline/styles/watercolor/watercolor_parameters.h"
#include "tests/gpu/watercolor/watercolor_fixture.h"
#include "tests/oracles/watercolor_oracle.h"
#include "tests/support/random_vectors.h"

namespace pleinair::styles {
namespace {

using support::readR32ui;
using support::readRgba8;
using support::textureOf;

glm::dvec3 colourAt(hal::Image& image, int x, int y) {
  const auto* const p = image.row(0, y).data() + static_cast<std::ptrdiff_t>(x) * 4;
  return glm::dvec3(p[0], p[1], p[2]) / 255.0;
}

hal::Image filled(hal::FrameSize size, const std::function<glm::dvec3(int, int)>& colour) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = size});
  for (int y = 0; y < size.height; ++y) {
    auto* p = image.row(0, y).data();
    for (int x = 0; x < size.width; ++x, p += 4) {
      const glm::dvec3 c = colour(x, y);
      for (int i = 0; i < 3; ++i) p[i] = static_cast<std::uint8_t>(std::lround(c[i] * 255.0));
      p[3] = 255;
    }
  }
  return image;
}

/// In 1/255, of any byte.
int largestDifference(hal::Image& a, hal::Image& b) {
  int largest = 0;
  for (std::size_t i = 0; i < a.plane(0).size(); ++i) {
    largest = std::max(largest, std::abs(int{a.plane(0)[i]} - int{b.plane(0)[i]}));
  }
  return largest;
}

/// All that makes a wash uneven switched off.
config::ParameterValues plainPaint(const Watercolor& style) {
  config::ParameterValues values = style.parameters();
  for (const char* name : {"edge_darkness", "wobble", "rim", "gaps", "granulation", "variation",
                           "grain", "vividness", "luminosity"}) {
    values = values.with(name, "0");
  }
  return values;
}

class WashTest : public StyleTest {
 protected:
  static double noiseGain(Watercolor& style);
};

TEST_F(WashTest, TheGuideIsTheSmoothedPicture) {
  Watercolor style(library_);
  style.setParameters(plainPaint(style));
  hal::Image image = testPicture({61, 47}, 3);
  const gpu::Texture picture = textureOf(image.view());
  style.paint(frameOf(picture), "");
  hal::Image guide = readRgba8(*style.inner().guide);
  ASSERT_EQ(guide.size(), (hal::FrameSize{31, 24}));
  const double reach = WatercolorParameters().simplicity;
  // Bilinear, (0, 0) is the first pixel's corner, borders clamped.
  const auto sample = [&](double x, double y) {
    const double u = x - 0.5;
    const double v = y - 0.5;
    const int x0 = static_cast<int>(std::floor(u));
    const int y0 = static_cast<int>(std::floor(v));
    const auto pixel = [&](int i, int j) { return oracles::pixelAt(image.view(), i, j); };
    const glm::dvec3 top = glm::mix(pixel(x0, y0), pixel(x0 + 1, y0), u - x0);
    const glm::dvec3 bottom = glm::mix(pixel(x0, y0 + 1), pixel(x0 + 1, y0 + 1), u - x0);
    return glm::mix(top, bottom, v - y0);
  };
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 31; ++x) {
      const double u = 2 * x + 1;
      const double v = 2 * y + 1;
      glm::dvec3 wanted = 4.0 * sample(u, v);
      for (const double i : {-1.0, 1.0}) {
        for (const double j : {-1.0, 1.0}) wanted += sample(u + i * reach, v + j * reach);
        wanted += 2.0 * (sample(u + 1.41 * i * reach, v) + sample(u, v + 1.41 * i * reach));
      }
      wanted /= 16.0;
      const glm::dvec3 found = colourAt(guide, x, y);
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(found[c], wanted[c], 2.0 / 255.0) << x << "," << y;
    }
  }
}

TEST_F(WashTest, ACellsTwoWashesHaveTheMomentsOfItsPixels) {
  for (const int cell : {5, 8, 16}) {
    Watercolor style(library_);
    style.setParameters(style.parameters().with("cell_size", std::to_string(cell)));
    const hal::FrameSize size{161, 118};
    const gpu::Texture picture = textureOf(testPicture(size, 7).view());
    style.paint(frameOf(picture), "");
    hal::Image guide = readRgba8(*style.inner().guide);
    hal::Image dark = readRgba8(*style.inner().darkWash);
    hal::Image light = readRgba8(*style.inner().lightWash);
    const auto words = readR32ui(*style.inner().tiling);

    std::vector<std::vector<glm::dvec3>> colours(static_cast<std::size_t>(dark.size().pixels()));
    for (int y = 0; y < guide.size().height; ++y) {
      for (int x = 0; x < guide.size().width; ++x) {
        const int column = std::min(2 * x + 1, size.width - 1);
        const int row = std::min(2 * y + 1, size.height - 1);
        const std::uint32_t word = words[static_cast<std::size_t>(row * size.width + column)];
        colours[word & 0x3FFFFFU].push_back(colourAt(guide, x, y));
      }
    }
    int split = 0;
    for (std::size_t k = 0; k < colours.size(); ++k) {
      if (colours[k].empty()) continue;
      const oracles::TwoColours wanted = oracles::twoColoursOf(colours[k]);
      const double spread = wanted.lumaSpread * 255.0;
      if (spread < 4.0) continue;  // eight bits leave the skewness open there
      const int x = static_cast<int>(k) % dark.size().width;
      const int y = static_cast<int>(k) / dark.size().width;
      const double tolerance = (spread < 10.0 ? 4.0 : 1.5) / 255.0;
      ++split;
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(colourAt(dark, x, y)[c], wanted.dark[c], tolerance) << "cell " << k;
        EXPECT_NEAR(colourAt(light, x, y)[c], wanted.light[c], tolerance) << "cell " << k;
      }
    }
    EXPECT_GT(split, 10) << "cells of " << cell << " px";
  }
}

TEST_F(WashTest, ACellOfTwoColoursIsPaintedWithThose) {
  const glm::dvec3 ink(0.1, 0.15, 0.3);
  const glm::dvec3 sheet(0.95, 0.9, 0.8);
  std::vector<glm::dvec3> colours(20, sheet);
  colours.insert(colours.end(), 5, ink);
  const oracles::TwoColours found = oracles::twoColoursOf(colours);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(found.dark[c], ink[c], 1e-9);
    EXPECT_NEAR(found.light[c], sheet[c], 1e-9);
  }
  EXPECT_NEAR(found.lightShare, 0.8, 1e-9);
}

// Washes end at the edges of things, wherever the cells end: viewers notice this most.
TEST_F(WashTest, WashesEndAtTheEdgesOfThePicture) {
  constexpr hal::FrameSize kSize{160, 120};
  const glm::dvec3 dark(0.25, 0.3, 0.5);
  const glm::dvec3 light(0.9, 0.8, 0.6);
  const auto edgeAt = [](int y) { return 62.0 + 0.35 * y; };
  const gpu::Texture picture = textureOf(
      filled(kSize, [&](int x, int y) { return x + 0.5 < edgeAt(y) ? dark : light; }).view());
  Watercolor style(library_);
  style.setParameters(plainPaint(style));
  hal::Image painted = readRgba8(style.paint(frameOf(picture), ""));
  for (int y = 4; y < kSize.height - 4; ++y) {
    for (int x = 4; x < kSize.width - 4; ++x) {
      const double away = x + 0.5 - edgeAt(y);
      if (std::abs(away) < 2.5) continue;
      const glm::dvec3 wanted = away < 0.0 ? dark : light;
      const double tolerance = (std::abs(away) < 10.0 ? 16.0 : 5.0) / 255.0;
      for (int c = 0; c < 3; ++c) {
        ASSERT_NEAR(colourAt(painted, x, y)[c], wanted[c], tolerance) << x << "," << y;
      }
    }
  }
}

TEST_F(WashTest, GradientsHaveNoSteps) {
  constexpr hal::FrameSize kSize{200, 100};
  const gpu::Texture picture =
      textureOf(filled(kSize, [](int x, int) { return glm::dvec3(0.2 + 0.003 * x); }).view());
  Watercolor style(library_);
  style.setParameters(plainPaint(style));
  hal::Image painted = readRgba8(style.paint(frameOf(picture), ""));
  for (int y = 8; y < kSize.height - 8; ++y) {
    for (int x = 12; x < kSize.width - 12; ++x) {
      ASSERT_NEAR(colourAt(painted, x, y).g, 0.2 + 0.003 * x, 4.0 / 255.0) << x << "," << y;
      ASSERT_NEAR(colourAt(painted, x, y).g, colourAt(painted, x + 1, y).g, 3.5 / 255.0);
    }
  }
}

/// How much of a still camera's noise comes through: mean change of the painted picture from frame
/// to frame over that of the camera's (docs/measuring.md, xFLK).
double WashTest::noiseGain(Watercolor& style) {
  constexpr hal::FrameSize kSize{240, 180};
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 2.0 / 255.0);
  hal::Image lastIn;
  hal::Image lastOut;
  double in = 0.0;
  double out = 0.0;
  for (int i = 0; i < 20; ++i) {
    hal::Image seen = filled(kSize, [&](int x, int y) {
      const bool disc = std::hypot(x - 90.0, y - 80.0) < 50.0;
      const bool stripe = (x + y / 2) % 40 < 3;
      const glm::dvec3 base = disc     ? glm::dvec3(0.8, 0.45, 0.2)
                              : stripe ? glm::dvec3(0.2, 0.2, 0.25)
                                       : glm::dvec3(0.4 + 0.002 * x, 0.6, 0.5);
      return glm::clamp(base + support::randomVec3(noise, random), 0.0, 1.0);
    });
    const gpu::Texture picture = textureOf(seen.view());
    tracking::ImageMotion motion;
    const scene::ArFrame frame = followed(picture, i, {0.0, 0.0}, motion);
    hal::Image painted = readRgba8(style.paint(frame, ""));
    if (i > 12) {  // seeds are where they belong
      for (std::size_t k = 0; k < seen.plane(0).size(); ++k) {
        in += std::abs(int{seen.plane(0)[k]} - int{lastIn.plane(0)[k]});
        out += std::abs(int{painted.plane(0)[k]} - int{lastOut.plane(0)[k]});
      }
    }
    lastIn = std::move(seen);
    lastOut = std::move(painted);
  }
  return out / in;
}

TEST_F(WashTest, AStillSceneIsNearlyAStillPainting) {
  Watercolor style(library_);
  for (const Look& look : watercolorLooks()) {
    style.reset();
    style.setParameters(styleKind("watercolor").parametersOf(look.name));
    const double gain = noiseGain(style);
    RecordProperty(std::string(look.name), std::to_string(gain));
    EXPECT_LT(gain, 0.15) << look.name;
  }
}

TEST_F(WashTest, AMosaicShowsTheCells) {
  Watercolor style(library_);
  const gpu::Texture picture = textureOf(testPicture({120, 90}, 5).view());
  style.setParameters(plainPaint(style).with("mosaic", "1"));
  hal::Image mosaic = readRgba8(style.paint(frameOf(picture), ""));
  style.reset();
  hal::Image means = readRgba8(style.paint(frameOf(picture), "means"));
  EXPECT_LE(largestDifference(mosaic, means), 1);
}

/// Mid-grey paint on a canvas.
class PaperTest : public WashTest {
 protected:
  static constexpr hal::FrameSize kSize{128, 128};

  hal::Image paint(const tracking::PlaneSimilarity& canvasFromPicture) {
    Watercolor style(library_);
    const gpu::Texture grey =
        textureOf(filled(kSize, [](int, int) { return glm::dvec3(0.5); }).view());
    scene::ArFrame frame = frameOf(grey);
    frame.canvasFromPicture = canvasFromPicture;
    return readRgba8(style.paint(frame, ""));
  }

  /// How `moved` correlates with `still` looked up at `from` of each pixel: 1 where it is the same.
  static double correlation(hal::Image& moved, hal::Image& still,
                            const std::function<glm::ivec2(int, int)>& from) {
    double sums[5] = {};
    int count = 0;
    for (int y = 20; y < kSize.height - 20; ++y) {
      for (int x = 20; x < kSize.width - 20; ++x) {
        const glm::ivec2 p = from(x, y);
        const double a = colourAt(moved, x, y).g;
        const double b = colourAt(still, p.x, p.y).g;
        const double each[5] = {a, b, a * a, b * b, a * b};
        for (int i = 0; i < 5; ++i) sums[i] += each[i];
        ++count;
      }
    }
    for (double& sum : sums) sum /= count;
    return (sums[4] - sums[0] * sums[1]) /
           std::sqrt((sums[2] - sums[0] * sums[0]) * (sums[3] - sums[1] * sums[1]));
  }
};

TEST_F(PaperTest, GoesWithThePicture) {
  hal::Image still = paint({});
  // The picture has gone 9 px to the right and 4 up: this pixel lies where another was.
  hal::Image moved = paint({.linear = {1.0, 0.0}, .shift = {-9.0, 4.0}});
  EXPECT_GT(correlation(moved, still, [](int x, int y) { return glm::ivec2(x - 9, y + 4); }), 0.98);
  EXPECT_LT(correlation(moved, still, [](int x, int y) { return glm::ivec2(x, y); }), 0.35)
      << "a sheet that stays";
}

TEST_F(PaperTest, TurnsWithThePicture) {
  hal::Image still = paint({});
  hal::Image turned = paint({.linear = {0.0, 1.0}, .shift = {128.0, 0.0}});
  EXPECT_GT(correlation(turned, still, [](int x, int y) { return glm::ivec2(127 - y, x); }), 0.9);
}

TEST_F(PaperTest, KeepsItsGrainUnderAnyZoom) {
  hal::Image still = paint({});
  hal::Image twice = paint({.linear = {2.0, 0.0}});
  hal::Image half = paint({.linear = {0.5, 0.0}});
  EXPECT_LE(largestDifference(twice, still), 1);
  EXPECT_LE(largestDifference(half, still), 1);
}

TEST_F(PaperTest, IsAsStrongBetweenTheOctaves) {
  const auto contrast = [](hal::Image image) {
    double sum = 0.0;
    double squares = 0.0;
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        const double value = colourAt(image, x, y).g;
        sum += value;
        squares += value * value;
      }
    }
    const double count = static_cast<double>(kSize.pixels());
    return std::sqrt(squares / count - sum * sum / (count * count));
  };
  const double still = contrast(paint({}));
  for (const double zoom : {0.6, 0.8, 1.2, 1.4, 1.7}) {
    const double between = contrast(paint({.linear = {zoom, 0.0}}));
    EXPECT_GT(between, 0.65 * still) << zoom;
    EXPECT_LT(between, 1.35 * still) << zoom;
  }
}

}  // namespace
}  // namespace pleinair::styles
