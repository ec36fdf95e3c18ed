#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "pipeline/tracking/homography.h"
#include "pipeline/tracking/image_motion_estimator.h"
#include "tests/support/textured_plane.h"

namespace pleinair::tracking {
namespace {

using support::nowFromThen;
using support::PlaneStep;
using support::WallView;

constexpr hal::FrameSize kSize{320, 240};

/// Follows what a camera sees of a wall.
class Watch {
 public:
  explicit Watch(ImageMotionOptions options = {}) : estimator_(options) {}

  const ImageMotion& see(const hal::Image& image) {
    const hal::ImageView view = image.view();
    return estimator_.follow(view.planes[0], view.format.size, sequence_++);
  }
  /// The wall, moved on by a step, with noise that differs from frame to frame.
  const ImageMotion& step(const glm::dmat3& nowFromThen) {
    view_.wallFromFrame = view_.wallFromFrame * glm::inverse(nowFromThen);
    ++view_.noiseSeed;
    return see(renderWall(view_));
  }
  WallView& view() { return view_; }

 private:
  ImageMotionEstimator estimator_;
  WallView view_{.size = kSize, .noiseSigma = 2.0};
  std::uint64_t sequence_ = 7;
};

double rmsOfFeatures(const ImageMotion& motion, const glm::dmat3& truth) {
  double sum = 0.0;
  for (const FeatureMotion& feature : motion.features) {
    const glm::dvec2 then(feature.then);
    const glm::dvec2 now(feature.now);
    const double off = glm::distance(now, movedBy(truth, then));
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
  const glm::dmat3 truth = nowFromThen(GetParam().step, kSize);
  EXPECT_TRUE(watch.step(glm::dmat3(1.0)).isCut);
  double worstPicture = 0.0;
  double worstFeatures = 0.0;
  double predicted = 0.0;
  double actual = 0.0;
  for (int i = 0; i < 12; ++i) {
    const ImageMotion& motion = watch.step(truth);
    ASSERT_FALSE(motion.isCut) << i;
    ASSERT_TRUE(motion.picture) << i;
    ASSERT_GT(motion.features.size(), 40U) << i;
    if (i < 2) continue;  // the first may still be held
    const double off = rmsMotion(glm::inverse(truth) * motion.picture->nowFromThen, kSize);
    worstPicture = std::max(worstPicture, off);
    worstFeatures = std::max(worstFeatures, rmsOfFeatures(motion, truth));
    std::printf("%d: %zu picture %.4f (%.4f) features %.4f\n", i, motion.features.size(), off,
                motion.picture->errorPx, rmsOfFeatures(motion, truth));
    for (const FeatureMotion& f : motion.features) {
      predicted += f.errorPx * f.errorPx;
      actual += std::pow(glm::distance(glm::dvec2(f.now), movedBy(truth, glm::dvec2(f.then))), 2);
    }
  }
  std::printf("predicted/actual %.3f\n", std::sqrt(predicted / actual));
  EXPECT_LT(worstPicture, 0.05);
  EXPECT_LT(worstFeatures, 0.2);
}

TEST(ImageMotion, StandsStillToTheBitInNoise) {
  Watch watch;
  for (int i = 0; i < 60; ++i) {
    const ImageMotion& motion = watch.step(glm::dmat3(1.0));
    if (i == 0) continue;
    ASSERT_TRUE(motion.picture);
    EXPECT_EQ(motion.picture->nowFromThen, glm::dmat3(1.0)) << i;
    ASSERT_GT(motion.features.size(), 40U);
    for (const FeatureMotion& feature : motion.features) EXPECT_EQ(feature.then, feature.now) << i;
  }
}

TEST(ImageMotion, LosesNothingOfASlowPan) {
  Watch watch;
  watch.step(glm::dmat3(1.0));
  glm::dmat3 total(1.0);
  glm::dmat3 found(1.0);
  const glm::dmat3 step = nowFromThen({.shift = {0.013, 0.0}}, kSize);
  for (int i = 0; i < 100; ++i) {
    const ImageMotion& motion = watch.step(step);
    total = step * total;
    ASSERT_TRUE(motion.picture);
    found = motion.picture->nowFromThen * found;
    EXPECT_LT(rmsMotion(glm::inverse(total) * found, kSize), 0.15) << i;
  }
}

TEST(ImageMotion, ACutIsACut) {
  Watch watch;
  for (int i = 0; i < 3; ++i) watch.step(nowFromThen({.shift = {2.0, 0.0}}, kSize));
  watch.view().wallSeed = 9;
  const ImageMotion& cut = watch.step(glm::dmat3(1.0));
  EXPECT_TRUE(cut.isCut);
  EXPECT_TRUE(cut.features.empty());
  EXPECT_FALSE(cut.picture);
  const ImageMotion& after = watch.step(nowFromThen({.shift = {2.0, 0.0}}, kSize));
  EXPECT_FALSE(after.isCut);
  EXPECT_GT(after.features.size(), 40U);
}

}  // namespace
}  // namespace pleinair::tracking
