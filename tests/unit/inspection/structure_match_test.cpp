#include "pipeline/inspection/structure_match.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

namespace pleinair::inspection {
namespace {

constexpr int kSide = 160;

/// A picture by a function of px, in grey levels.
hal::Image picture(const std::function<double(double, double)>& grey) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kGrey8, .size = {kSide, kSide}});
  for (int y = 0; y < kSide; ++y) {
    const auto row = image.row(0, y);
    for (int x = 0; x < kSide; ++x) {
      row[static_cast<std::size_t>(x)] =
          static_cast<std::uint8_t>(std::clamp(grey(x, y), 0.0, 255.0));
    }
  }
  return image;
}

double texture(double x, double y) {
  return 120 + 40 * std::sin(0.31 * x + 1.7 * std::sin(0.11 * y)) + 30 * std::cos(0.23 * y);
}

TEST(StructureMatch, LightDoesNotMatter) {
  const hal::Image expected = picture(texture);
  const hal::Image darker =
      picture([](double x, double y) { return 0.5 * texture(x, y) + 0.1 * x; });
  const StructureMatch match = matchStructure(expected.view(), darker.view());
  EXPECT_GT(match.mean, 0.97);
  EXPECT_GT(match.worst, 0.95);
  EXPECT_GT(match.structured, 0.95);
}

TEST(StructureMatch, AFewPixelsOfShiftDoNotMatter) {
  const hal::Image expected = picture(texture);
  const hal::Image shifted = picture([](double x, double y) { return texture(x + 5, y - 4); });
  EXPECT_GT(matchStructure(expected.view(), shifted.view()).worst, 0.95);
}

TEST(StructureMatch, APieceThatIsMissingIsTheWorstPlace) {
  const hal::Image expected = picture(texture);
  const hal::Image hole = picture([](double x, double y) {
    return std::hypot(x - 90, y - 70) < 25 ? 120 + 0.3 * x : texture(x, y);
  });
  const StructureMatch match = matchStructure(expected.view(), hole.view());
  EXPECT_LT(match.worst, 0.4);
  EXPECT_GT(match.mean, 0.6);
}

TEST(StructureMatch, TheEdgeOfAShadowIsNotLookedFor) {
  const hal::Image expected = picture(texture);
  const hal::Image shaded = picture([](double x, double y) {
    return texture(x, y) * (0.7 - 0.3 * std::tanh((x + 0.3 * y - 100) / 4));
  });
  const StructureMatch match = matchStructure(expected.view(), shaded.view());
  EXPECT_GT(match.mean, 0.85);
  EXPECT_GT(match.worst, 0.6);
}

/// A relief of two parts, side by side, at these heights.
std::vector<ReliefPixel> twoParts(float left, float right) {
  std::vector<ReliefPixel> relief;
  for (int i = 0; i < kSide * kSide; ++i) {
    const bool isRight = i % kSide >= kSide / 2;
    relief.push_back(
        {.height = isRight ? right : left, .part = static_cast<std::uint16_t>(isRight ? 1 : 0)});
  }
  return relief;
}

TEST(StructureMatch, OfSeveralPartsTheOneThatIsMissingIsTheWorst) {
  const hal::Image expected = picture(texture);
  const hal::Image half =
      picture([](double x, double y) { return x >= kSide / 2.0 ? 120.0 : texture(x, y); });
  const std::vector<ReliefPixel> relief = twoParts(0.0F, 0.0F);
  const StructureMatch match = matchStructure(expected.view(), half.view(), {.relief = relief});
  EXPECT_LT(match.worst, 0.3);
  EXPECT_GT(match.mean, match.worst + 0.2);
}

TEST(StructureMatch, WhatIsBesideThePartsDoesNotCount) {
  const hal::Image expected = picture(texture);
  const hal::Image half =
      picture([](double x, double y) { return x >= 0.6 * kSide ? 120.0 : texture(x, y); });
  std::vector<ReliefPixel> relief = twoParts(0.0F, 0.0F);
  for (ReliefPixel& each : relief) {
    if (each.part == 1) each = {};
  }
  EXPECT_GT(matchStructure(expected.view(), half.view(), {.relief = relief}).worst, 0.95);
}

TEST(StructureMatch, ReliefMovesEdgesByItsHeightAndNoFarther) {
  const hal::Image expected = picture(texture);
  const auto movedRight = [&](double px) {
    return picture(
        [px](double x, double y) { return x < kSide / 2.0 ? texture(x, y) : texture(x - px, y); });
  };
  const std::vector<ReliefPixel> relief = twoParts(0.0F, 1.0F);
  const StructureSearch search{.relief = relief, .reliefPx = {8.0, 0.0}};
  EXPECT_GT(matchStructure(expected.view(), movedRight(8).view(), search).worst, 0.85);
  EXPECT_LT(matchStructure(expected.view(), movedRight(0).view(), search).worst, 0.8);
}

}  // namespace
}  // namespace pleinair::inspection
