// The segments of a camera image: found in spite of noise, followed, and at rest while nothing
// moves.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include "pipeline/tracking/segments/image_segmenter.h"

namespace pleinair::tracking {
namespace {

using hal::PixelFormat;

constexpr hal::FrameSize kSize{320, 240};
using Painting = std::function<glm::dvec3(glm::dvec2)>;

const glm::dvec3 kBlue(60.0, 80.0, 130.0);
const glm::dvec3 kOchre(180.0, 140.0, 90.0);
const glm::dvec3 kRed(200.0, 40.0, 40.0);

glm::dvec3 halves(glm::dvec2 px) {
  return px.x < 150.0 ? kBlue : kOchre;
}

/// A red disc on two halves.
Painting discAt(glm::dvec2 middle) {
  return [=](glm::dvec2 px) {
    return glm::distance(px, middle) < 40.0 ? kRed : px.x - middle.x < 70.0 ? kBlue : kOchre;
  };
}

hal::Image imageOf(const Painting& painting, double noiseSigma, unsigned seed) {
  hal::Image image({.pixelFormat = PixelFormat::kRgb8, .size = kSize});
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 1.0);
  for (int y = 0; y < kSize.height; ++y) {
    std::uint8_t* p = image.row(0, y).data();
    for (int x = 0; x < kSize.width; ++x) {
      const glm::dvec3 colour = painting(glm::dvec2(x, y) + 0.5);
      for (int c = 0; c < 3; ++c) {
        const double level = colour[c] + noiseSigma * noise(random) + 0.5;
        *p++ = static_cast<std::uint8_t>(std::clamp(level, 0.0, 255.0));
      }
    }
  }
  return image;
}

/// A motion of the whole image.
ImageMotion moved(glm::dvec2 step) {
  ImageMotion motion{.frameSize = kSize, .noiseLevels = 3.0};
  motion.picture = ImageHomography{
      .currentFromPrevious = glm::dmat3(1, 0, 0, 0, 1, 0, step.x, step.y, 1), .errorPx = 0.05};
  return motion;
}
ImageMotion cut() {
  return {.frameSize = kSize, .isCut = true};
}

struct Segmented {
  hal::FrameSize grid;
  std::vector<SegmentCell> cells;
  std::uint16_t at(glm::dvec2 px) const {
    const glm::ivec2 cell(px * glm::dvec2(grid.width, grid.height) /
                          glm::dvec2(kSize.width, kSize.height));
    return cells[static_cast<std::size_t>(cell.y * grid.width + cell.x)].label;
  }
  std::set<std::uint16_t> labels() const {
    std::set<std::uint16_t> all;
    for (const SegmentCell& each : cells) all.insert(each.label);
    return all;
  }
  /// Of the cells with the label of a place, and of those that should have it.
  double iou(glm::dvec2 px, const std::function<bool(glm::dvec2)>& isIts) const {
    int either = 0;
    int both = 0;
    for (int y = 0; y < grid.height; ++y) {
      for (int x = 0; x < grid.width; ++x) {
        const glm::dvec2 middle = (glm::dvec2(x, y) + 0.5) * glm::dvec2(kSize.width, kSize.height) /
                                  glm::dvec2(grid.width, grid.height);
        const bool has = at(middle) == at(px);
        either += has || isIts(middle) ? 1 : 0;
        both += has && isIts(middle) ? 1 : 0;
      }
    }
    return static_cast<double>(both) / either;
  }
};

Segmented follow(ImageSegmenter& segmenter, const hal::Image& image, const ImageMotion& motion) {
  const ImageSegments& found = segmenter.follow(image.view(), motion);
  return {found.grid, {found.cells.begin(), found.cells.end()}};
}
Segmented segmented(const Painting& painting, double noiseSigma) {
  ImageSegmenter segmenter;
  return follow(segmenter, imageOf(painting, noiseSigma, 1), cut());
}

TEST(ImageSegmenter, FlatAreasAreFoundInNoise) {
  const Segmented found = segmented(discAt({110.0, 120.0}), 5.0);
  EXPECT_EQ(found.labels().size(), 3u);
  EXPECT_FALSE(found.labels().contains(0));
  EXPECT_GT(found.iou({110.0, 120.0},
                      [](glm::dvec2 px) {
                        return glm::distance(px, {110.0, 120.0}) < 40.0;
                      }),
            0.95);
  EXPECT_GT(found.iou({300.0, 20.0}, [](glm::dvec2 px) { return px.x >= 180.0; }), 0.97);
}

TEST(ImageSegmenter, SoftShadingAndTextureMakeNoBorders) {
  EXPECT_EQ(
      segmented([](glm::dvec2 px) { return glm::dvec3(40.0 + 0.5 * px.x); }, 2.0).labels().size(),
      1u);
  const auto texture = [](glm::dvec2 px) {
    return glm::dvec3(120.0 + 25.0 * std::sin(0.9 * px.x) * std::sin(0.7 * px.y));
  };
  EXPECT_EQ(segmented(texture, 2.0).labels().size(), 1u);
  EXPECT_EQ(segmented(halves, 2.0).labels().size(), 2u) << "the control";
}

TEST(ImageSegmenter, AStillSceneRestsToTheBit) {
  ImageSegmenter segmenter;
  ImageSegmenter unaware;
  const Painting painting = discAt({110.3, 120.4});
  const auto noisy = [&](unsigned seed) { return imageOf(painting, 3.0, seed); };
  follow(segmenter, noisy(0), cut());
  follow(unaware, noisy(0), cut());
  Segmented before;
  Segmented unawareBefore;
  int changes = 0;
  for (unsigned i = 1; i < 28; ++i) {
    const Segmented now = follow(segmenter, noisy(i), moved({0.0, 0.0}));
    // The control: a camera that is said to creep.
    const Segmented unawareNow = follow(unaware, noisy(i), moved({0.001, 0.0}));
    if (i >= 20) {
      EXPECT_TRUE(now.cells == before.cells) << i;
      changes += unawareNow.cells == unawareBefore.cells ? 0 : 1;
    }
    before = now;
    unawareBefore = unawareNow;
  }
  EXPECT_GT(changes, 5);
}

TEST(ImageSegmenter, SegmentsKeepTheirLabelsUnderAPan) {
  ImageSegmenter segmenter;
  const glm::dvec2 step(3.7, -1.2);
  glm::dvec2 disc(90.0, 140.0);
  const Segmented first = follow(segmenter, imageOf(discAt(disc), 3.0, 0), cut());
  const std::set<std::uint16_t> labels = first.labels();
  for (unsigned i = 1; i < 20; ++i) {
    disc += step;
    const Segmented now = follow(segmenter, imageOf(discAt(disc), 3.0, i), moved(step));
    EXPECT_EQ(now.labels(), labels) << i;
    EXPECT_EQ(now.at(disc), first.at({90.0, 140.0})) << i;
    EXPECT_GT(now.iou(disc, [&](glm::dvec2 px) { return glm::distance(px, disc) < 40.0; }), 0.94)
        << i;
  }
}

/// The control of the former: who is told nothing of a leap does not know the disc again.
TEST(ImageSegmenter, LabelsComeFromTheMotion) {
  for (const bool isTold : {true, false}) {
    ImageSegmenter segmenter;
    const Segmented first = follow(segmenter, imageOf(discAt({60.0, 120.0}), 3.0, 0), cut());
    const Segmented then = follow(segmenter, imageOf(discAt({150.0, 120.0}), 3.0, 1),
                                  moved({isTold ? 90.0 : 0.0, 0.0}));
    EXPECT_EQ(then.at({150.0, 120.0}) == first.at({60.0, 120.0}), isTold);
  }
}

TEST(ImageSegmenter, WhatAppearsIsShownOnceItHasLasted) {
  ImageSegmenter segmenter;
  for (unsigned i = 0; i < 5; ++i) {
    follow(segmenter, imageOf(halves, 2.0, i), i == 0 ? cut() : moved({0.0, 0.0}));
  }
  const auto withDisc = [](glm::dvec2 px) {
    return glm::distance(px, {70.0, 120.0}) < 40.0 ? kRed : halves(px);
  };
  int frames = 0;
  for (unsigned i = 5; i < 25; ++i) {
    const Segmented now = follow(segmenter, imageOf(withDisc, 2.0, i), moved({0.0, 0.0}));
    if (now.at({70.0, 120.0}) == now.at({70.0, 20.0})) ++frames;
  }
  EXPECT_GE(frames, 5);
  EXPECT_LE(frames, 15);
}

TEST(ImageSegmenter, ACutAndAnotherSizeBeginAnew) {
  ImageSegmenter segmenter;
  follow(segmenter, imageOf(discAt({60.0, 120.0}), 3.0, 0), cut());
  const Segmented now = follow(segmenter, imageOf(halves, 3.0, 1), cut());
  EXPECT_EQ(now.labels().size(), 2u) << "what is new is shown at once";
  const hal::Image small({.pixelFormat = PixelFormat::kGrey8, .size = {61, 47}});
  const ImageSegments& other = segmenter.follow(small.view(), moved({0.0, 0.0}));
  EXPECT_EQ(other.frameSize, small.size());
  EXPECT_EQ(other.cells.size(), static_cast<std::size_t>(other.grid.pixels()));
}

TEST(ImageSegmenter, IsTheSameOnEveryRun) {
  ImageSegmenter one;
  ImageSegmenter other;
  for (unsigned i = 0; i < 6; ++i) {
    const hal::Image image = imageOf(discAt({90.0 + 4.0 * i, 120.0}), 8.0, i);
    const ImageMotion motion = i == 0 ? cut() : moved({4.0, 0.0});
    EXPECT_TRUE(follow(one, image, motion).cells == follow(other, image, motion).cells) << i;
  }
}

/// The halves in other formats, by the formulas of BT.601 in limited range.
hal::Image halvesAs(PixelFormat format) {
  hal::Image image({.pixelFormat = format, .size = kSize});
  const auto luma = [](glm::dvec3 c) {
    return static_cast<std::uint8_t>(16.0 + (65.5 * c.r + 128.6 * c.g + 25.0 * c.b) / 255.0);
  };
  const auto cb = [](glm::dvec3 c) {
    return static_cast<std::uint8_t>(128.0 + (-37.8 * c.r - 74.2 * c.g + 112.0 * c.b) / 255.0);
  };
  const auto cr = [](glm::dvec3 c) {
    return static_cast<std::uint8_t>(128.0 + (112.0 * c.r - 93.8 * c.g - 18.2 * c.b) / 255.0);
  };
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const glm::dvec3 c = halves({x, y});
      const auto i = static_cast<std::size_t>(x);
      const std::size_t half = i / 2;
      const bool isPair = y % 2 == 0 && x % 2 == 0;
      switch (format) {
        case PixelFormat::kRgba8:
          for (int k = 0; k < 3; ++k) {
            image.row(0, y)[4 * i + static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(c[k]);
          }
          break;
        case PixelFormat::kYuyv:
          image.row(0, y)[2 * i] = luma(c);
          image.row(0, y)[2 * i + 1] = x % 2 == 0 ? cb(c) : cr(c);
          break;
        case PixelFormat::kNv12:
          image.row(0, y)[i] = luma(c);
          if (isPair) {
            image.row(1, y / 2)[i] = cb(c);
            image.row(1, y / 2)[i + 1] = cr(c);
          }
          break;
        case PixelFormat::kI420:
          image.row(0, y)[i] = luma(c);
          if (isPair) {
            image.row(1, y / 2)[half] = cb(c);
            image.row(2, y / 2)[half] = cr(c);
          }
          break;
        case PixelFormat::kBayerGrbg8:
          image.row(0, y)[i] = static_cast<std::uint8_t>((x + y) % 2 == 0 ? c.g
                                                         : y % 2 == 0     ? c.r
                                                                          : c.b);
          break;
        default:
          image.row(0, y)[i] = luma(c);
      }
    }
  }
  return image;
}

TEST(ImageSegmenter, ReadsEveryFormat) {
  const Segmented rgb = segmented(halves, 0.0);
  for (const PixelFormat format :
       {PixelFormat::kRgba8, PixelFormat::kYuyv, PixelFormat::kNv12, PixelFormat::kI420,
        PixelFormat::kBayerGrbg8, PixelFormat::kGrey8}) {
    SCOPED_TRACE(std::string(hal::toString(format)));
    ImageSegmenter segmenter;
    const Segmented found = follow(segmenter, halvesAs(format), cut());
    EXPECT_EQ(found.labels().size(), 2u);
    int different = 0;
    for (std::size_t i = 0; i < found.cells.size(); ++i) {
      different += found.cells[i].label == rgb.cells[i].label ? 0 : 1;
      if (format == PixelFormat::kGrey8 || !rgb.cells[i].isInside) continue;
      EXPECT_NEAR(found.cells[i].luma, rgb.cells[i].luma, 3);
      EXPECT_NEAR(found.cells[i].cb, rgb.cells[i].cb, 3);
      EXPECT_NEAR(found.cells[i].cr, rgb.cells[i].cr, 3);
    }
    EXPECT_EQ(different, 0);
  }
}

}  // namespace
}  // namespace pleinair::tracking
