#include "pipeline/overlay/label_layout.h"

#include <algorithm>
#include <chrono>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/tracking/pose/twist.h"
#include "tests/unit/overlay/overlay_views.h"

namespace pleinair::overlay {
namespace {

using namespace std::chrono_literals;

/// Labels of parts of 4 cm on a machine, and a layout that follows a camera.
class LabelLayoutTest : public testing::Test {
 protected:
  void addPart(const glm::dvec3& centre, const glm::dvec2& labelPx = {90, 24}) {
    PartShape shape;
    shape.centre = centre;
    for (std::size_t i = 0; i < 8; ++i) {
      shape.corners[i] = centre + 0.02 * glm::dvec3((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1,
                                                    (i & 4) != 0 ? 1 : -1);
    }
    shapes_.push_back(shape);
    targets_.push_back({.sizePx = labelPx, .anchor = centre});
  }
  std::span<const PlacedLabel> place(const glm::dmat4& cameraFromModel,
                                     hal::Duration later = 33ms) {
    now_ += later;
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      targets_[i].box = boxOf(shapes_[i], cameraFromModel, camera_);
      if (targets_[i].box) targets_[i].aim = *targets_[i].box;
    }
    return layout_.place({.camera = &camera_,
                          .cameraFromModel = cameraFromModel,
                          .keepClear = keepClear_,
                          .time = now_},
                         targets_);
  }
  PxBox boxAt(const PlacedLabel& label, std::size_t index) const {
    const glm::dvec2 low(label.topLeft);
    return {low, low + targets_[index].sizePx};
  }
  void expectClear(std::span<const PlacedLabel> labels) const {
    for (std::size_t i = 0; i < labels.size(); ++i) {
      ASSERT_TRUE(labels[i].isShown);
      for (std::size_t k = 0; k < labels.size(); ++k) {
        EXPECT_FALSE(targets_[k].box->overlaps(boxAt(labels[i], i))) << i << " over part " << k;
        const bool isOther = k != i;
        EXPECT_FALSE(isOther && boxAt(labels[k], k).overlaps(boxAt(labels[i], i))) << i << k;
      }
    }
  }

  tracking::CameraModel camera_ = testCamera();
  std::vector<PartShape> shapes_;
  std::vector<LabelTarget> targets_;
  std::vector<PxBox> keepClear_;
  LabelLayout layout_;
  hal::TimePoint now_;
};

TEST_F(LabelLayoutTest, LiesBesidePartsPanelsAndOtherLabels) {
  for (const double x : {-0.12, -0.04, 0.04, 0.12}) addPart({x, 0.0, 0.0});
  keepClear_.push_back({{0.0, 0.0}, {640.0, 150.0}});
  const auto labels = place(ahead(0.7));
  expectClear(labels);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    EXPECT_FALSE(keepClear_[0].overlaps(boxAt(labels[i], i)));
    EXPECT_TRUE((PxBox{{0, 0}, {640, 480}}).holds(boxAt(labels[i], i)));
  }
}

TEST_F(LabelLayoutTest, AStepWithoutLabelsAfterOneThatHadThemHasNone) {
  addPart({0.0, 0.0, 0.0});
  EXPECT_EQ(place(ahead(0.7)).size(), 1U);
  layout_.reset();
  EXPECT_TRUE(
      layout_.place({.camera = &camera_, .cameraFromModel = ahead(0.7), .time = now_}, {}).empty());
}

TEST_F(LabelLayoutTest, StaysOnItsPixelWhileThePoseTrembles) {
  addPart({0.0, 0.0, 0.0});
  addPart({0.08, 0.05, 0.0});
  std::mt19937 random(7);
  std::normal_distribution<double> tremble(0.0, 1.2e-4);  // a tenth of a pixel
  const glm::dmat4 still = ahead(0.6, 10.0);
  const std::vector<PlacedLabel> first(place(still).begin(), place(still).end());
  for (int frame = 0; frame < 300; ++frame) {
    const glm::dmat4 seen =
        tracking::movedBy(still, {.rotation = {tremble(random), tremble(random), tremble(random)},
                                  .shift = {tremble(random), tremble(random), tremble(random)}});
    const auto labels = place(seen);
    for (std::size_t i = 0; i < labels.size(); ++i) {
      ASSERT_EQ(labels[i].topLeft, first[i].topLeft) << "frame " << frame;
    }
  }
}

TEST_F(LabelLayoutTest, MovesWithTheMachine) {
  addPart({0.0, 0.0, 0.0});
  const glm::ivec2 before = place(ahead(0.6))[0].topLeft;
  const glm::dmat4 shifted = glm::translate(glm::dmat4(1.0), {0.05, 0.0, 0.0}) * ahead(0.6);
  const glm::ivec2 after = place(shifted)[0].topLeft;
  EXPECT_NEAR(after.x - before.x, 560.0 * 0.05 / 0.6, 1.5);
  EXPECT_NEAR(after.y - before.y, 0.0, 1.0);
}

TEST_F(LabelLayoutTest, KeepsItsPlaceUntilTheViewHasTurned) {
  addPart({0.0, 0.0, 0.0});
  addPart({0.1, 0.0, 0.0});
  place(ahead(0.6));
  glm::dvec2 widest(0.0);
  for (double turn = 0.0; turn <= 60.0; turn += 0.5) {
    const glm::dmat4 view = ahead(0.6, turn);
    const auto labels = place(view, 50ms);
    expectClear(labels);
    const glm::dvec2 part = targets_[0].box->centre();
    widest = glm::max(widest, glm::abs(glm::dvec2(labels[0].topLeft) - part));
  }
  EXPECT_LT(widest.x, 250.0) << "it stays near its part";
}

TEST_F(LabelLayoutTest, IsLaidOutAgainOnlyAfterLyingBadlyForAWhile) {
  addPart({0.0, 0.0, 0.0});
  const glm::ivec2 first = place(ahead(0.6))[0].topLeft;
  const PxBox where = boxAt(place(ahead(0.6))[0], 0);
  keepClear_.push_back(where);  // a panel opens there
  EXPECT_EQ(place(ahead(0.6))[0].topLeft, first);
  EXPECT_EQ(place(ahead(0.6), 200ms)[0].topLeft, first);
  for (int i = 0; i < 20; ++i) place(ahead(0.6));
  const PlacedLabel moved = place(ahead(0.6))[0];
  EXPECT_NE(moved.topLeft, first);
  EXPECT_FALSE(where.overlaps(boxAt(moved, 0)));
}

TEST_F(LabelLayoutTest, OfPartsBehindTheCameraNothingIsShown) {
  addPart({0.0, 0.0, 0.0});
  EXPECT_FALSE(place(ahead(-0.5))[0].isShown);
  EXPECT_TRUE(place(ahead(0.5))[0].isShown);
}

TEST_F(LabelLayoutTest, OfAThousandLabelsTheFirstAreShown) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place3(-0.2, 0.2);
  for (int i = 0; i < 1000; ++i) addPart({place3(random), place3(random), 0.0}, {20, 12});
  const auto labels = place(ahead(0.7));
  EXPECT_EQ(labels.size(), 1000U);
  EXPECT_EQ(std::ranges::count(labels, true, &PlacedLabel::isShown), LabelLayout::kMost);
}

}  // namespace
}  // namespace pleinair::overlay
