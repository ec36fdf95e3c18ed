#include "pipeline/tracking/faces/face_tracker.h"

#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/drawn_face.h"

namespace pleinair::tracking {
namespace {

using support::DrawnFace;
constexpr hal::FrameSize kSize{640, 480};
/// Frames of a search, and those in which a face comes wholly.
constexpr int kUntilThere = 18 + 13;

class FaceTrackerTest : public testing::Test {
 protected:
  /// The next frame.
  std::vector<Face> follow(const hal::Image& image, bool isCut = false) {
    luma_.take(image.view());
    time_ += std::chrono::milliseconds(stepMs_);
    const auto faces = tracker_.follow(luma_, time_, isCut);
    return {faces.begin(), faces.end()};
  }
  template <std::size_t count>
  std::vector<Face> follow(const std::array<DrawnFace, count>& faces, bool isCut = false) {
    return follow(support::drawnFaces(kSize, faces, 2.0, ++seed_), isCut);
  }

  static double errorOf(const Face& found, const DrawnFace& drawn) {
    return glm::distance(found.centre, drawn.centre) / drawn.side;
  }

  LumaFrame luma_;
  FaceTracker tracker_;
  hal::TimePoint time_{};
  int stepMs_ = 33;
  unsigned seed_ = 0;
};

TEST_F(FaceTrackerTest, FindsAFaceInTheFirstFrame) {
  for (const double side : {46.0, 90.0, 220.0}) {
    const DrawnFace drawn{{250.0, 230.0}, side};
    const std::vector<Face> found = follow(std::array{drawn}, true);
    ASSERT_EQ(found.size(), 1U) << side;
    EXPECT_LT(errorOf(found[0], drawn), 0.12) << side;
    EXPECT_NEAR(found[0].sidePx / side, 1.0, 0.15);
    EXPECT_EQ(found[0].presence, 1.0);
  }
}

TEST_F(FaceTrackerTest, HardlyEverFindsOneInChance) {
  std::mt19937 random(3);
  int found = 0;
  std::uniform_int_distribution<int> level(0, 255);
  hal::Image image({.pixelFormat = hal::PixelFormat::kGrey8, .size = kSize});
  for (int i = 0; i < 24; ++i) {
    const int block = std::array{3, 8, 20, 50}.at(static_cast<std::size_t>(i % 4));
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        if (x % block == 0 && y % block == 0) {
          image.row(0, y)[x] = static_cast<std::uint8_t>(level(random));
        } else {
          image.row(0, y)[x] = image.row(0, y - y % block)[x - x % block];
        }
      }
    }
    found += static_cast<int>(follow(image, true).size());
  }
  EXPECT_LE(found, 2) << "of 24 images";
}

TEST_F(FaceTrackerTest, AFaceAtRestRestsExactlyInNoise) {
  const DrawnFace drawn{{300.0, 200.0}, 80.0};
  const std::vector<Face> first = follow(std::array{drawn}, true);
  ASSERT_EQ(first.size(), 1U);
  std::array<hal::Image, 4> noisy;
  for (hal::Image& each : noisy) {
    each = support::drawnFaces(kSize, std::array{drawn}, 2.0, ++seed_);
  }
  for (std::size_t i = 0; i < 80; ++i) {
    const std::vector<Face> later = follow(noisy.at(i % noisy.size()));
    ASSERT_EQ(later.size(), 1U) << i;
    EXPECT_EQ(later[0].centre, first[0].centre) << i;
    EXPECT_EQ(later[0].sidePx, first[0].sidePx) << i;
    EXPECT_EQ(later[0].presence, 1.0) << i;
  }
}

TEST_F(FaceTrackerTest, FollowsFacesThatWalkAndOnesThatComeNearer) {
  DrawnFace walking{{120.0, 160.0}, 70.0};
  DrawnFace coming{{480.0, 240.0}, 60.0};
  ASSERT_EQ(follow(std::array{walking, coming}, true).size(), 2U);
  double largest = 0.0;
  double ratio = 1.0;
  for (int i = 0; i < 60; ++i) {
    walking.centre.x += 5.0;
    walking.centre.y += 3.0 * std::sin(0.4 * i);
    if (i == 20) coming.centre.x += 6.0;
    coming.side *= 1.015;
    if (walking.centre.x > 380.0) break;
    const std::vector<Face> found = follow(std::array{walking, coming});
    ASSERT_EQ(found.size(), 2U) << i;
    const bool isFirst = errorOf(found[0], walking) < errorOf(found[1], walking);
    largest = std::max({largest, errorOf(found[isFirst ? 0 : 1], walking),
                        errorOf(found[isFirst ? 1 : 0], coming)});
    ratio = std::max(ratio, coming.side / found[isFirst ? 1 : 0].sidePx);
  }
  EXPECT_LT(largest, 0.2);
  EXPECT_LT(ratio, 1.25);
  RecordProperty("largest_error", std::to_string(largest));
}

TEST_F(FaceTrackerTest, FacesComeAndGoGradually) {
  const DrawnFace drawn{{300.0, 200.0}, 80.0};
  ASSERT_TRUE(follow(std::array<DrawnFace, 0>{}, true).empty());
  double before = 0.0;
  const auto presence = [&](const std::vector<Face>& faces) {
    const double now = faces.empty() ? 0.0 : faces[0].presence;
    EXPECT_LT(std::abs(now - before), 0.1);
    return before = now;
  };
  for (int i = 0; i < kUntilThere; ++i) presence(follow(std::array{drawn}));
  EXPECT_EQ(before, 1.0);
  for (int i = 0; i < 20; ++i) presence(follow(std::array<DrawnFace, 0>{}));
  EXPECT_EQ(before, 0.0);
}

TEST_F(FaceTrackerTest, IsFollowedWhileItTurnsAway) {
  const DrawnFace drawn{{300.0, 200.0}, 80.0};
  ASSERT_EQ(follow(std::array{drawn}, true).size(), 1U);
  // A cheek over an eye and half of the mouth: no detector's face any more.
  for (int i = 0; i < 60; ++i) {
    hal::Image image = support::drawnFaces(kSize, std::array{drawn}, 2.0, ++seed_);
    const int turned = std::min(i, 36);
    for (int y = 170; y < 235; ++y) {
      for (int x = 300 - 40; x < 300 - 40 + turned; ++x) {
        for (int c = 0; c < 3; ++c) image.row(0, y)[std::ptrdiff_t{x} * 4 + c] = 185;
      }
    }
    const std::vector<Face> found = follow(image);
    ASSERT_EQ(found.size(), 1U) << i;
    EXPECT_EQ(found[0].presence, 1.0) << i;
    EXPECT_LT(errorOf(found[0], drawn), 0.2) << i;
    if (i < 59) continue;
    EXPECT_TRUE(follow(image, true).empty()) << "the control: nobody would find it";
  }
}

TEST_F(FaceTrackerTest, StaysAtAnyRateOfFrames) {
  const DrawnFace drawn{{300.0, 200.0}, 80.0};
  const hal::Image image = support::drawnFaces(kSize, std::array{drawn}, 2.0);
  for (const int stepMs : {16, 200, 500}) {
    tracker_.reset();
    for (int i = 0; i * stepMs < 6000; ++i) {
      stepMs_ = stepMs;
      const std::vector<Face> found = follow(image);
      ASSERT_EQ(found.size(), 1U) << stepMs << " ms, frame " << i;
      EXPECT_EQ(found[0].presence, 1.0);
    }
  }
}

TEST_F(FaceTrackerTest, AStallForgetsNobody) {
  const DrawnFace drawn{{300.0, 200.0}, 80.0};
  ASSERT_EQ(follow(std::array{drawn}, true).size(), 1U);
  stepMs_ = 60'000;
  const std::vector<Face> found = follow(std::array{drawn});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].presence, 1.0);
}

TEST_F(FaceTrackerTest, ACutIsAFirstFrame) {
  const std::array before{DrawnFace{{120.0, 160.0}, 70.0}};
  const std::array after{DrawnFace{{400.0, 260.0}, 110.0}};
  const hal::Image cut = support::drawnFaces(kSize, after, 2.0, 77);
  const std::vector<Face> anew = follow(cut, true);
  tracker_.reset();
  for (int i = 0; i < 5; ++i) follow(before, i == 0);
  const std::vector<Face> found = follow(cut, true);
  ASSERT_EQ(found.size(), 1U);
  ASSERT_EQ(anew.size(), 1U);
  EXPECT_EQ(found[0].centre, anew[0].centre);
  EXPECT_EQ(found[0].sidePx, anew[0].sidePx);
  EXPECT_EQ(found[0].presence, 1.0);
}

TEST_F(FaceTrackerTest, TheSameFramesGiveTheSameFaces) {
  const auto run = [this] {
    tracker_.reset();
    seed_ = 0;
    std::vector<glm::dvec2> places;
    for (int i = 0; i < 24; ++i) {
      const std::array faces{DrawnFace{{120.0 + 4.0 * i, 160.0}, 70.0},
                             DrawnFace{{450.0, 240.0}, 90.0}};
      for (const Face& each : follow(faces, i == 0)) places.push_back(each.centre);
    }
    return places;
  };
  const std::vector<glm::dvec2> first = run();
  EXPECT_EQ(first.size(), 48U);
  EXPECT_EQ(run(), first);
}

}  // namespace
}  // namespace pleinair::tracking
