#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>
#include <gtest/gtest.h>

#include "pipeline/tracking/image/homography.h"
#include "pipeline/tracking/motion/image_motion_estimator.h"
#include "tests/support/textured_plane.h"
#include "tests/unit/tracking/motion_watch.h"

namespace pleinair::tracking {
namespace {

using support::currentFromPrevious;
using support::PlaneStep;
using support::WallView;

constexpr hal::FrameSize kSize{320, 240};

double rmsOfFeatures(const ImageMotion& motion, const glm::dmat3& truth) {
  double sum = 0.0;
  for (const FeatureMotion& feature : motion.features) {
    const glm::dvec2 previous(feature.previous);
    const glm::dvec2 current(feature.current);
    const double off = glm::distance(current, movedBy(truth, previous));
    sum += off * off;
  }
  return std::sqrt(sum / static_cast<double>(motion.features.size()));
}

struct Case {
  const char* name;
  PlaneStep step;
  friend std::ostream& operator<<(std::ostream& out, const Case& of) { return out << of.name; }
};

class ImageMotionOf : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(
    Motions, ImageMotionOf,
    testing::Values(Case{"shift", {.shift = {3.3, -1.7}}}, Case{"slow", {.shift = {0.21, 0.13}}},
                    Case{"fast", {.shift = {24.0, 9.0}}}, Case{"turn", {.turn = 0.02}},
                    Case{"zoom", {.zoom = 1.02}},
                    Case{"bend", {.shift = {1.0, 0.4}, .bend = {2e-5, -1e-5}}},
                    Case{"all", {.turn = -0.01, .zoom = 0.99, .shift = {2.0, 3.0}}}),
    [](const auto& each) { return std::string(each.param.name); });

TEST_P(ImageMotionOf, IsMeasuredInNoise) {
  Watch watch;
  const glm::dmat3 truth = currentFromPrevious(GetParam().step, kSize);
  EXPECT_TRUE(watch.step(glm::dmat3(1.0)).isCut);
  double worstPicture = 0.0;
  double worstFeatures = 0.0;
  double predicted = 0.0;
  double actual = 0.0;
  double predictedPicture = 0.0;
  double actualPicture = 0.0;
  for (int i = 0; i < 12; ++i) {
    const ImageMotion& motion = watch.step(truth);
    ASSERT_FALSE(motion.isCut) << i;
    ASSERT_TRUE(motion.picture) << i;
    ASSERT_GT(motion.features.size(), 40U) << i;
    if (i < 2) continue;  // the first frames may still be held
    const double off = rmsMotion(glm::inverse(truth) * motion.picture->currentFromPrevious, kSize);
    worstPicture = std::max(worstPicture, off);
    worstFeatures = std::max(worstFeatures, rmsOfFeatures(motion, truth));
    predictedPicture += motion.picture->errorPx * motion.picture->errorPx;
    actualPicture += off * off;
    for (const FeatureMotion& feature : motion.features) {
      const glm::dvec2 there = movedBy(truth, glm::dvec2(feature.previous));
      predicted += feature.errorPx * feature.errorPx;
      actual += std::pow(glm::distance(glm::dvec2(feature.current), there), 2);
    }
  }
  EXPECT_LT(worstPicture, 0.075);
  EXPECT_LT(worstFeatures, 0.22);
  EXPECT_GT(std::sqrt(predicted / actual), 0.5);
  EXPECT_LT(std::sqrt(predicted / actual), 2.0);
  EXPECT_GT(std::sqrt(predictedPicture / actualPicture), 0.5);
  EXPECT_LT(std::sqrt(predictedPicture / actualPicture), 2.0);
}

/// Corners that are detected anew in each frame jitter by half a pixel, and more on soft patches.
TEST_P(ImageMotionOf, IsMeasuredByTheReferenceTrackerToo) {
  Watch watch({.features = FeatureMethod::kHarrisSift, .flow = false, .staticRegions = false});
  watch.view().contrast = 1.6;
  watch.view().brightness = -72.0;
  const glm::dmat3 truth = currentFromPrevious(GetParam().step, kSize);
  watch.step(glm::dmat3(1.0));
  double predicted = 0.0;
  double actual = 0.0;
  for (int i = 0; i < 7; ++i) {
    const ImageMotion& motion = watch.step(truth);
    ASSERT_FALSE(motion.isCut) << i;
    ASSERT_TRUE(motion.picture) << i;
    ASSERT_GT(motion.features.size(), 20U) << i;
    if (i < 3) continue;
    EXPECT_LT(rmsMotion(glm::inverse(truth) * motion.picture->currentFromPrevious, kSize), 0.8)
        << i;
    for (const FeatureMotion& feature : motion.features) {
      const glm::dvec2 there = movedBy(truth, glm::dvec2(feature.previous));
      predicted += feature.errorPx * feature.errorPx;
      actual += std::pow(glm::distance(glm::dvec2(feature.current), there), 2);
    }
  }
  EXPECT_GT(std::sqrt(predicted / actual), 0.5);
  EXPECT_LT(std::sqrt(predicted / actual), 2.0);
}

TEST(ImageMotion, StandsStillToTheBitInNoise) {
  Watch watch;
  for (int i = 0; i < 40; ++i) {
    const ImageMotion& motion = watch.step(glm::dmat3(1.0));
    if (i == 0) continue;
    ASSERT_TRUE(motion.picture);
    EXPECT_EQ(motion.picture->currentFromPrevious, glm::dmat3(1.0)) << i;
    ASSERT_GT(motion.features.size(), 40U);
    for (const FeatureMotion& feature : motion.features)
      EXPECT_EQ(feature.previous, feature.current) << i;
  }
}

TEST(ImageMotion, LosesNothingOfASlowPan) {
  Watch watch;
  watch.step(glm::dmat3(1.0));
  glm::dmat3 total(1.0);
  glm::dmat3 found(1.0);
  const glm::dmat3 step = currentFromPrevious({.shift = {0.03, 0.0}}, kSize);
  for (int i = 0; i < 45; ++i) {
    const ImageMotion& motion = watch.step(step);
    total = step * total;
    ASSERT_TRUE(motion.picture);
    found = motion.picture->currentFromPrevious * found;
    EXPECT_LT(rmsMotion(glm::inverse(total) * found, kSize), 0.15) << i;
  }
}

/// The wall's leaves sway by up to 0.8 px, neighbours nearly alike, and all of them by 0.2. Grey8.
hal::Image inTheWind(const hal::Image& wall, double seconds) {
  hal::Image image(wall.format());
  const hal::FrameSize size = wall.format().size;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double phase = 3.0 * std::sin(0.045 * x) + 2.6 * std::cos(0.06 * y) + 0.02 * (x + y);
      const double swing = 0.8 * std::sin(3.1 * seconds + phase) + 0.2 * std::sin(4.0 * seconds);
      const double at = std::clamp(x + swing, 0.0, size.width - 1.001);
      const auto left = static_cast<int>(at);
      const std::uint8_t* row = wall.view().row(0, y).data();
      image.row(0, y)[static_cast<std::size_t>(x)] =
          static_cast<std::uint8_t>(std::lround(std::lerp(row[left], row[left + 1], at - left)));
    }
  }
  return image;
}

TEST(ImageMotion, LeavesInTheWindAreNotTheCamera) {
  Watch watch;
  constexpr int kKnown = 30;  // frames after which it is known what sways
  int atFirst = 0;
  int moved = 0;
  for (int i = 1; i < 120; ++i) {
    ++watch.view().noiseSeed;
    const ImageMotion& motion = watch.see(inTheWind(support::renderWall(watch.view()), i / 15.0));
    const bool stands = motion.picture && motion.picture->currentFromPrevious == glm::dmat3(1.0);
    if (i > 1) (i < kKnown ? atFirst : moved) += stands ? 0 : 1;
  }
  EXPECT_GT(atFirst, 0) << "the control: fits find a motion";
  EXPECT_EQ(moved, 0);
}

/// An object that moves on its own in front of the wall.
TEST(ImageMotion, TwoLayersMoveApart) {
  Watch watch;
  watch.step(glm::dmat3(1.0));
  const glm::dmat3 wall = currentFromPrevious({.shift = {-1.5, 0.5}}, kSize);
  const glm::dvec2 thing(2.0, -1.0);
  glm::dmat3 thingFromFrame(1.0);
  for (int i = 0; i < 16; ++i) {
    thingFromFrame = thingFromFrame * glm::inverse(currentFromPrevious({.shift = thing}, kSize));
    const WallView front{.size = kSize,
                         .wallFromFrame = thingFromFrame,
                         .noiseSigma = 2.0,
                         .noiseSeed = watch.view().noiseSeed + 100,
                         .wallSeed = 5};
    const glm::ivec2 corner(90 + 2 * i, 120 - i);
    const ImageMotion& motion = watch.stepBehind(wall, front, corner, corner + 100);
    if (i < 10) continue;  // features are searched on it now and then
    ASSERT_TRUE(motion.picture);
    EXPECT_LT(rmsMotion(glm::inverse(wall) * motion.picture->currentFromPrevious, kSize), 0.08)
        << i;
    int onThing = 0;
    int astray = 0;
    for (const FeatureMotion& feature : motion.features) {
      const glm::vec2 inThing = feature.previous - glm::vec2(corner);
      if (glm::any(glm::lessThan(inThing, glm::vec2(10.0F))) ||
          glm::any(glm::greaterThan(inThing, glm::vec2(90.0F)))) {
        continue;
      }
      ++onThing;
      astray += glm::distance(glm::dvec2(feature.current - feature.previous), thing) > 0.6 ? 1 : 0;
    }
    EXPECT_GT(onThing, 5) << i;
    EXPECT_LE(astray, 1) << i;
  }
}

/// Somebody walks through a room with few corners, slowly enough for a homography to bend to both.
TEST(ImageMotion, ALargeThingThatMovesBeforeAPlainWallIsNotTheCamera) {
  constexpr int kWide = 110;
  constexpr int kTop = 60;
  Watch watch;
  const std::vector<glm::ivec2> posters{{20, 20},  {95, 10},   {170, 20}, {270, 14},  {30, 100},
                                        {140, 90}, {250, 100}, {90, 170}, {180, 160}, {270, 180}};
  glm::dmat3 thingFromFrame(1.0);
  for (int i = 0; i < 240; ++i) {
    const double turn = 0.0015 * std::cos(0.1 * i);
    thingFromFrame = thingFromFrame *
                     glm::inverse(currentFromPrevious({.turn = turn, .shift = {1.5, 0.0}}, kSize));
    WallView wall{.size = kSize, .noiseSigma = 1.0, .noiseSeed = 1U + static_cast<unsigned>(i)};
    wall.contrast = 0.05;
    hal::Image image = support::renderWall(wall);
    wall.contrast = 1.0;
    for (const glm::ivec2& at : posters) support::overlayWall(image, wall, at, at + 36);
    WallView thing = wall;
    thing.wallFromFrame = thingFromFrame;
    thing.wallSeed = 5;
    const int left = -kWide + 3 * i / 2;
    const glm::ivec2 from(std::max(left, 0), kTop);
    const glm::ivec2 to(std::min(left + kWide, kSize.width), kSize.height);
    if (to.x > from.x) support::overlayWall(image, thing, from, to);
    const ImageMotion& motion = watch.see(image);
    if (i == 0) continue;
    ASSERT_TRUE(motion.picture) << i;
    EXPECT_EQ(motion.picture->currentFromPrevious, glm::dmat3(1.0)) << i;
  }
}

/// In how many of 40 frames the camera is found to move while somebody sways before a plain wall,
/// near enough to have most corners of the image: a head and a trunk that turn each by itself.
/// `posters`: what hangs on the wall.
int framesThatMove(ImageMotionOptions options, const std::vector<glm::ivec2>& posters) {
  Watch watch(options);
  std::array<glm::dmat3, 2> thingsFromFrame{glm::dmat3(1.0), glm::dmat3(1.0)};
  glm::dvec2 away(0.0);
  int moving = 0;
  for (int i = 0; i < 40; ++i) {
    WallView wall{.size = kSize, .noiseSigma = 1.0, .noiseSeed = 1U + static_cast<unsigned>(i)};
    wall.contrast = 0.0;
    wall.brightness = 110.0;
    hal::Image image = support::renderWall(wall);
    wall.contrast = 1.0;
    wall.brightness = 0.0;
    for (const glm::ivec2& at : posters) support::overlayWall(image, wall, at, at + 30);
    const glm::dvec2 sway(2.0 * std::cos(0.15 * i), 0.7 * std::sin(0.2 * i));
    away += sway;
    const glm::ivec2 corner(glm::round(glm::dvec2(85.0, 90.0) + away));
    const std::array<glm::ivec2, 2> from{corner + glm::ivec2(30, -70), corner};
    const std::array<glm::ivec2, 2> to{corner + glm::ivec2(110, 0), {corner.x + 140, kSize.height}};
    for (std::size_t part = 0; part < 2; ++part) {
      const double turn = (part == 0 ? 0.01 : -0.004) * std::cos(0.25 * i);
      const glm::dmat3 step = currentFromPrevious({.turn = turn, .shift = sway}, kSize);
      thingsFromFrame.at(part) = thingsFromFrame.at(part) * glm::inverse(step);
      WallView thing = wall;
      thing.wallFromFrame = thingsFromFrame.at(part);
      thing.wallSeed = 5 + static_cast<unsigned>(part);
      support::overlayWall(image, thing, from.at(part), to.at(part));
    }
    const ImageMotion& motion = watch.see(image);
    const bool isAtRest = motion.picture && motion.picture->currentFromPrevious == glm::dmat3(1.0);
    moving += i > 0 && !isAtRest ? 1 : 0;
  }
  return moving;
}

TEST(ImageMotion, AMountedCameraStandsWhoeverIsClose) {
  EXPECT_EQ(framesThatMove({.isMounted = true}, {}), 0);
  EXPECT_GT(framesThatMove({}, {}), 30) << "the image alone can tell";
}

TEST(ImageMotion, AFewThingsAtRestShowThatSomebodyCloseIsNotTheCamera) {
  EXPECT_EQ(framesThatMove({}, {{10, 20}, {280, 30}, {15, 120}, {275, 130}}), 0);
}

TEST(ImageMotion, AMountedCameraMovesWhereAllOfTheImageDoes) {
  Watch watch({.isMounted = true});
  for (int i = 0; i < 8; ++i) watch.step(glm::dmat3(1.0));
  const glm::dmat3 push = currentFromPrevious({.shift = {4.0, 1.0}}, kSize);
  for (int i = 0; i < 4; ++i) {
    const ImageMotion& motion = watch.step(push);
    ASSERT_TRUE(motion.picture) << i;
    EXPECT_LT(rmsMotion(glm::inverse(push) * motion.picture->currentFromPrevious, kSize), 0.2) << i;
  }
  for (int i = 0; i < 12; ++i) {
    const ImageMotion& motion = watch.step(glm::dmat3(1.0));
    ASSERT_TRUE(motion.picture) << i;
    EXPECT_LT(rmsMotion(motion.picture->currentFromPrevious, kSize), 0.2) << i;
  }
}

TEST(ImageMotion, AMountedCameraStandsBeforeNothing) {
  Watch watch({.isMounted = true});
  watch.view().contrast = 0.0;
  watch.view().brightness = 110.0;
  watch.step(glm::dmat3(1.0));
  for (int i = 0; i < 4; ++i) {
    const ImageMotion& motion = watch.step(glm::dmat3(1.0));
    ASSERT_TRUE(motion.picture) << i;
    EXPECT_EQ(motion.picture->currentFromPrevious, glm::dmat3(1.0)) << i;
  }
}

/// `step`: of the camera.
void expectALensToBeCovered(ImageMotionOptions options, const glm::dmat3& step) {
  Watch watch(options);
  for (int i = 0; i < 4; ++i) watch.step(step);
  const hal::Image covered({.pixelFormat = hal::PixelFormat::kGrey8, .size = kSize});
  for (int i = 0; i < 3; ++i) {
    const ImageMotion& motion = watch.see(covered);
    EXPECT_FALSE(motion.isCut);
    EXPECT_FALSE(motion.picture);
    EXPECT_TRUE(motion.features.empty());
  }
  EXPECT_FALSE(watch.step(step).isCut);
  const ImageMotion& back = watch.step(step);
  EXPECT_FALSE(back.isCut);
  EXPECT_GT(back.features.size(), 40U);
  EXPECT_TRUE(back.picture);
}

TEST(ImageMotion, ACoveredLensIsNoCutAndWhatItShowedIsFoundAgain) {
  expectALensToBeCovered({}, currentFromPrevious({.shift = {0.5, 0.0}}, kSize));
  expectALensToBeCovered({.isMounted = true}, glm::dmat3(1.0));
}

TEST(ImageMotion, AnotherViewAfterABareWallIsACut) {
  for (const double brightness : {120.0, 45.0}) {
    Watch watch;
    WallView wall{.size = kSize, .noiseSigma = 2.0};
    wall.contrast = 0.0;
    wall.brightness = brightness;
    for (int i = 0; i < 20; ++i) {
      ++wall.noiseSeed;
      EXPECT_EQ(watch.see(support::renderWall(wall)).isCut, i == 0) << i;
    }
    // Another wall, of another colour, with something large before it.
    wall.brightness = brightness + 60.0;
    hal::Image image = support::renderWall(wall);
    WallView thing{.size = kSize, .noiseSigma = 2.0};
    support::overlayWall(image, thing, {30, 90}, {130, kSize.height});
    EXPECT_TRUE(watch.see(image).isCut);
    EXPECT_TRUE(watch.see(support::renderWall({.size = kSize, .wallSeed = 9})).isCut);
  }
}

TEST(ImageMotion, SomebodyWhoComesBeforeABareWallIsNoCut) {
  Watch watch;
  for (int i = 0; i < 120; ++i) {
    WallView wall{.size = kSize, .noiseSigma = 2.0, .noiseSeed = 1U + static_cast<unsigned>(i)};
    wall.contrast = 0.0;
    wall.brightness = 120.0 - 0.4 * i;  // the sun sets
    hal::Image image = support::renderWall(wall);
    WallView person = wall;
    person.contrast = 1.0;
    person.brightness = 0.0;
    person.wallSeed = 5;
    const int right = std::min(5 * (i - 90), 150);
    if (right > 0) support::overlayWall(image, person, {0, 60}, {right, kSize.height});
    EXPECT_EQ(watch.see(image).isCut, i == 0) << i;
  }
}

TEST(ImageMotion, AFlashIsNoCut) {
  Watch watch;
  for (int i = 0; i < 3; ++i) watch.step(glm::dmat3(1.0));
  watch.view().brightness = 70.0;
  EXPECT_FALSE(watch.step(glm::dmat3(1.0)).isCut);
  watch.view().brightness = 0.0;
  EXPECT_FALSE(watch.step(glm::dmat3(1.0)).isCut);
  EXPECT_GT(watch.step(glm::dmat3(1.0)).features.size(), 40U);
}

TEST(ImageMotion, TakesPicturesOfAnySizeWithNothingInThem) {
  Watch watch;
  for (const hal::FrameSize size : {hal::FrameSize{1, 1}, {3, 700}, {16, 16}, {1280, 720}}) {
    const hal::Image blank({.pixelFormat = hal::PixelFormat::kGrey8, .size = size});
    for (int i = 0; i < 3; ++i) {
      const ImageMotion& motion = watch.see(blank);
      EXPECT_EQ(motion.frameSize, size);
      EXPECT_EQ(motion.isCut, i == 0);
      EXPECT_TRUE(motion.features.empty());
      EXPECT_FALSE(motion.picture);
    }
  }
}

TEST(ImageMotion, SaysSinceWhen) {
  Watch watch;
  watch.step(glm::dmat3(1.0));
  EXPECT_EQ(watch.step(glm::dmat3(1.0)).sinceSequence, 7U);
  watch.reset();
  EXPECT_TRUE(watch.step(glm::dmat3(1.0)).isCut);
  EXPECT_EQ(watch.step(glm::dmat3(1.0)).sinceSequence, 9U);
}

TEST(ImageMotion, ACutIsACut) {
  Watch watch;
  for (int i = 0; i < 3; ++i) watch.step(currentFromPrevious({.shift = {2.0, 0.0}}, kSize));
  watch.view().wallSeed = 9;
  const ImageMotion& cut = watch.step(glm::dmat3(1.0));
  EXPECT_TRUE(cut.isCut);
  EXPECT_TRUE(cut.features.empty());
  EXPECT_FALSE(cut.picture);
  const ImageMotion& after = watch.step(currentFromPrevious({.shift = {2.0, 0.0}}, kSize));
  EXPECT_FALSE(after.isCut);
  EXPECT_GT(after.features.size(), 40U);
}

}  // namespace
}  // namespace pleinair::tracking
