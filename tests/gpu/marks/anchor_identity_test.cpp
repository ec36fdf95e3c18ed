// That the same frames give the same anchors, and what begins anew: cuts, resets, other levels of
// quality, seeds.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "tests/gpu/marks/anchor_life_fixture.h"
#include "tests/support/allocation_count.h"

namespace pleinair::marks {
namespace {

using tracking::ImageMotion;

bool hasSameAnchors(const std::vector<Anchor>& a, const std::vector<Anchor>& b) {
  return std::ranges::equal(a, b, [](const Anchor& one, const Anchor& other) {
    return one.isAlive() == other.isAlive() &&
           (!one.isAlive() || (one.seed == other.seed && one.px == other.px));
  });
}

TEST_F(AnchorLife, ACutBeginsAnewAsAFirstFrame) {
  const std::vector<Anchor> first = next({});
  EXPECT_TRUE(set_->hasBegunAnew());
  const std::vector<Anchor> before = next(panning(-1.0, 0.0));
  EXPECT_FALSE(set_->hasBegunAnew());
  ImageMotion cut = panning(-1.0, 0.0);
  cut.isCut = true;
  const std::vector<Anchor> after = next(cut);
  EXPECT_TRUE(set_->hasBegunAnew());
  EXPECT_FALSE(hasSameAnchors(before, first));
  EXPECT_TRUE(hasSameAnchors(after, first));
  for (const Anchor& each : after) {
    if (!each.isAlive()) continue;
    EXPECT_TRUE(each.isBorn());
    EXPECT_EQ(each.fade, 1.0F) << "there at once";
  }
  EXPECT_THAT(cellCounts(after), testing::Each(2));
}

TEST_F(AnchorLife, TheSameFramesGiveTheSameAnchorsToTheBit) {
  const auto play = [&] {
    sequence_ = 0;
    time_ = {};
    useScene(boxScene());
    std::vector<Anchor> last;
    for (int i = 0; i < 40; ++i) {
      last = next(i == 0 ? ImageMotion{} : zooming(i % 20 < 10 ? 1.01 : 0.985),
                  boxAt(100.0 + 2.0 * i));
    }
    return last;
  };
  const std::vector<Anchor> once = play();
  const std::vector<Anchor> again = play();
  ASSERT_EQ(once.size(), again.size());
  std::size_t different = 0;
  const auto bytesOf = [](const Anchor& anchor) { return std::as_bytes(std::span(&anchor, 1)); };
  for (std::size_t slot = 0; slot < once.size(); ++slot) {
    if (once[slot].isAlive() != again[slot].isAlive() ||
        (once[slot].isAlive() && !std::ranges::equal(bytesOf(once[slot]), bytesOf(again[slot])))) {
      ++different;
    }
  }
  EXPECT_EQ(different, 0U);
}

TEST_F(AnchorLife, AfterAResetItIsAsAtFirst) {
  const std::vector<Anchor> first = next({});
  for (int i = 0; i < 5; ++i) next(panning(-1.0, 0.3));
  set_->reset();
  field_->reset();
  const std::vector<Anchor> again = next({});
  EXPECT_TRUE(set_->hasBegunAnew());
  std::multiset<std::pair<float, float>> was;
  std::multiset<std::pair<float, float>> is;
  for (const Anchor& each : first) {
    if (each.isAlive()) was.emplace(each.px.x, each.px.y);
  }
  for (const Anchor& each : again) {
    if (each.isAlive()) is.emplace(each.px.x, each.px.y);
  }
  EXPECT_EQ(was, is);
}

TEST_F(AnchorLife, SeedsAreTheirOwnAndSayNothingOfPlaces) {
  next({});
  std::set<std::uint32_t> seeds;
  std::size_t born = 0;
  glm::dvec2 products(0.0);
  for (int i = 0; i < 40; ++i) {
    for (const Anchor& each : next(zooming(1.02))) {
      if (!each.isAlive() || !each.isBorn()) continue;
      ++born;
      seeds.insert(each.seed);
      const glm::dvec2 inCell = glm::fract(glm::dvec2(each.px) / double{kCellPixels});
      products += (inCell - 0.5) * (each.seed / 4294967296.0 - 0.5);
    }
  }
  EXPECT_GT(born, 1000U);
  EXPECT_GE(seeds.size(), born - 1) << "two in thousands may meet";
  // Correlations of independent ones: 1/√n is a standard deviation.
  const glm::dvec2 correlations = 12.0 * products / static_cast<double>(born);
  const double most = 5.0 / std::sqrt(static_cast<double>(born));
  EXPECT_LT(std::abs(correlations.x), most);
  EXPECT_LT(std::abs(correlations.y), most);
}

TEST_F(AnchorLife, LevelsOfQualityChangeNothingOfPlaces) {
  useScene(boxScene());
  const gpu::Texture half = plainPicture({160, 120});
  const tracking::CameraModel halfCamera({.fx = 150.0, .fy = 151.0, .cx = 81.0, .cy = 59.0}, {},
                                         {160, 120});
  next({}, boxAt(160.0));
  const std::vector<Anchor> before = next(panning(0.0, 0.0), boxAt(160.0));
  motion_ = panning(0.0, 0.0);
  motion_.frameSize = kSize;
  motion_.sinceSequence = sequence_;
  scene::ArFrame frame =
      renderer_->compose(half, halfCamera, boxAt(160.0), ++sequence_, time_ += kStep,
                         {.surfaces = true, .measuredMotion = true});
  frame.fullSize = kSize;
  frame.measuredMotion = scene::MeasuredMotion{.motion = &motion_};
  field_->update(frame);
  set_->advance(frame, *field_);
  const std::vector<Anchor> after = set_->read();
  int onBox = 0;
  for (std::size_t slot = 0; slot < before.size(); ++slot) {
    if (!before[slot].isStaying()) continue;
    ASSERT_TRUE(after[slot].isAlive());
    ASSERT_LT(glm::distance(before[slot].px, after[slot].px), 1e-3F);
    if (before[slot].surface != 0) ++onBox;
  }
  EXPECT_GT(onBox, 100);
  EXPECT_EQ(births(after), 0);
}

TEST_F(AnchorLife, AllocatesNothingInSteadyState) {
  scene::Scene scene = boxScene();
  scene::SceneModel occluder = scene.models.front();
  occluder.isOccluder = true;
  occluder.attachFromModel = glm::translate(glm::dmat4(1.0), {0.05, 0.05, -0.1});
  scene.models.push_back(std::move(occluder));
  scene.planes.push_back({.name = "desk", .sizeMetres = {0.5, 0.5}});
  useScene(scene);
  const std::vector<float> still(300, 0.5F);
  const std::vector<glm::vec4> flow(1200, glm::vec4(-1.0F, 0.2F, 0.3F, 0.0F));
  std::vector<tracking::FeatureMotion> features(200);
  for (std::size_t i = 0; i < features.size(); ++i) {
    const glm::vec2 at(static_cast<float>(i % 20) * 16.0F, static_cast<float>(i / 20) * 24.0F);
    features[i] = {.previous = at, .current = at + glm::vec2(-1.0F, 0.2F), .errorPx = 0.1F};
  }
  ImageMotion motion = panning(-1.0, 0.2);
  motion.features = features;
  motion.flow = {.nodes = {40, 30}, .stepPx = glm::vec2(8.0F), .forward = flow, .backward = flow};
  motion.still = {.fields = {20, 15}, .errorPx = still};
  for (int i = 0; i < 5; ++i) advance(motion, boxAt(100.0 + i));
  EXPECT_EQ(support::allocationsIn([&] {
              for (int i = 0; i < 40; ++i) advance(motion, boxAt(105.0 + i));
            }),
            0)
      << support::allocationSites();
}

}  // namespace
}  // namespace pleinair::marks
