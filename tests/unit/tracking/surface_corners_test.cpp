#include "pipeline/tracking/pose/surface_corners.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "hal/image.h"
#include "pipeline/tracking/image/luma.h"

namespace pleinair::tracking {
namespace {

/// An image of soft blobs, shifted; `covered` columns of it are grey.
hal::Image blobs(hal::FrameSize size, glm::dvec2 shift, int coveredTo = 0) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kGrey8, .size = size});
  for (int y = 0; y < size.height; ++y) {
    const auto row = image.row(0, y);
    for (int x = 0; x < size.width; ++x) {
      const double u = (x - shift.x) / 11.0;
      const double v = (y - shift.y) / 13.0;
      const double value = 128.0 + 45.0 * std::sin(u + 1.7 * std::sin(0.31 * v)) * std::cos(v) +
                           35.0 * std::sin(0.37 * u * 1.3 + 0.21 * v);
      row[static_cast<std::size_t>(x)] =
          x < coveredTo ? std::uint8_t{128} : static_cast<std::uint8_t>(value);
    }
  }
  return image;
}

void follow(SurfaceCorners& features, const hal::Image& image) {
  LumaFrame frame;
  frame.take(image.view());
  features.follow(frame.pyramid());
}

std::ptrdiff_t countFound(const SurfaceCorners& features) {
  return std::ranges::count_if(features.tracks(), &FeatureTrack::isFound);
}

class SurfaceCornersOf : public testing::TestWithParam<hal::FrameSize> {};

TEST_P(SurfaceCornersOf, FollowsAShiftToAFractionOfAPixel) {
  SurfaceCorners features;
  follow(features, blobs(GetParam(), {}));
  EXPECT_TRUE(features.tracks().empty()) << "no key frame yet";
  EXPECT_TRUE(features.isKeyStale());
  features.makeKey({});
  ASSERT_GT(features.tracks().size(), 40U);
  const glm::dvec2 shift(7.3, -4.6);
  follow(features, blobs(GetParam(), shift));
  EXPECT_GT(countFound(features), std::ssize(features.tracks()) * 8 / 10);
  for (const FeatureTrack& track : features.tracks()) {
    if (track.isFound) {
      EXPECT_LT(glm::distance(track.px - track.keyPx, shift), 0.25);
    }
  }
  EXPECT_FALSE(features.isKeyStale());
}
INSTANTIATE_TEST_SUITE_P(Sizes, SurfaceCornersOf,
                         testing::Values(hal::FrameSize{320, 240}, hal::FrameSize{640, 480},
                                         hal::FrameSize{1280, 720}));

TEST(SurfaceCorners, LosesWhatIsCoveredAndFindsItAgain) {
  const hal::FrameSize size{640, 480};
  SurfaceCorners features;
  follow(features, blobs(size, {}));
  features.makeKey({});
  follow(features, blobs(size, {}, 320));
  std::ptrdiff_t covered = 0;
  std::ptrdiff_t foundCovered = 0;  // some match similar blobs beyond the cover's edge
  for (const FeatureTrack& track : features.tracks()) {
    if (track.keyPx.x < 300.0) {
      ++covered;
      foundCovered += track.isFound ? 1 : 0;
    }
    if (track.keyPx.x > 350.0) {
      EXPECT_TRUE(track.isFound) << track.keyPx.x;
    }
  }
  EXPECT_GT(covered, 20);
  EXPECT_LT(foundCovered, covered / 4);
  EXPECT_TRUE(features.isKeyStale());
  follow(features, blobs(size, {2.0, 1.0}));
  EXPECT_GT(countFound(features), std::ssize(features.tracks()) * 9 / 10);
}

TEST(SurfaceCorners, GoOnUnderTheirIdInTheNextKeyFrame) {
  const hal::FrameSize size{640, 480};
  SurfaceCorners features;
  follow(features, blobs(size, {}));
  features.makeKey({});
  const FeatureTrack first = features.tracks()[20];
  const glm::dvec2 shift(90.0, 0.0);
  for (int step = 1; step <= 6; ++step) follow(features, blobs(size, shift * (step / 6.0)));
  EXPECT_TRUE(features.isKeyStale()) << "gone far";
  features.makeKey({});
  EXPECT_FALSE(features.isKeyStale());
  const auto same = std::ranges::find(features.tracks(), first.id, &FeatureTrack::id);
  ASSERT_NE(same, features.tracks().end());
  EXPECT_LT(glm::distance(same->keyPx, first.keyPx + shift), 0.3);
  EXPECT_TRUE(std::ranges::is_sorted(features.tracks(), {}, &FeatureTrack::id));
}

TEST(SurfaceCorners, ABlankOrTinyPictureHasNone) {
  for (const hal::FrameSize size : {hal::FrameSize{640, 480}, hal::FrameSize{5, 3}}) {
    SurfaceCorners features;
    const hal::Image blank({.pixelFormat = hal::PixelFormat::kGrey8, .size = size});
    follow(features, blank);
    features.makeKey({});
    follow(features, blank);
    EXPECT_TRUE(features.tracks().empty());
  }
}

}  // namespace
}  // namespace pleinair::tracking
