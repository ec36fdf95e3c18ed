// How anchors come and go: density with hysteresis, fades without a pop, what is hidden and what
// comes into view, cuts, and that the same frames give the same anchors.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "pipeline/scene/builtin_box.h"
#include "tests/gpu/marks/marks_fixture.h"
#include "tests/gpu/scene/moving_models.h"
#include "tests/support/allocation_count.h"

namespace pleinair::marks {
namespace {

using std::chrono::milliseconds;
using tracking::ImageMotion;

constexpr glm::ivec2 kGrid{40, 30};
constexpr int kCellPixels = 8;

ImageMotion following(const glm::dmat3& nowFromThen) {
  return {.picture = tracking::PictureHomography{.nowFromThen = nowFromThen, .errorPx = 0.01}};
}
ImageMotion panning(double x, double y) {
  return following({1, 0, 0, 0, 1, 0, x, y, 1});
}
ImageMotion zooming(double factor) {
  return following({factor, 0, 0, 0, factor, 0, 160.0 * (1.0 - factor), 120.0 * (1.0 - factor), 1});
}

class AnchorLife : public MarksTest {
 protected:
  static constexpr float kIn = 33.0F / 300.0F;
  static constexpr float kOut = 33.0F / 200.0F;
  static constexpr float kRounding = 1e-5F;

  void SetUp() override {
    MarksTest::SetUp();
    if (IsSkipped()) return;
    useScene({});
  }
  void TearDown() override {
    set_.reset();
    field_.reset();
    renderer_.reset();
    MarksTest::TearDown();
  }

  void useScene(const scene::Scene& scene) {
    renderer_.emplace(library_, scene);
    field_.emplace(library_, kSize);
    set_.emplace(library_, kSize, AnchorOptions{});
  }

  void advance(const ImageMotion& motion, const scene::PoseSet& poses = {}) {
    const scene::ArFrame frame = compose(*renderer_, poses, motion);
    field_->update(frame, timer_);
    set_->advance(frame, *field_, timer_);
  }
  std::vector<Anchor> next(const ImageMotion& motion, const scene::PoseSet& poses = {}) {
    advance(motion, poses);
    return set_->read();
  }

  std::optional<scene::ArFrameRenderer> renderer_;
  std::optional<MotionField> field_;
  std::optional<AnchorSet> set_;
};

bool isWithin(glm::vec2 px, float border) {
  return px.x >= border && px.y >= border && px.x < 320.0F - border && px.y < 240.0F - border;
}

int births(const std::vector<Anchor>& anchors, float border = 0.0F) {
  return static_cast<int>(std::ranges::count_if(anchors, [&](const Anchor& each) {
    return each.isAlive() && each.isBorn() && isWithin(each.px, border);
  }));
}

/// Of those that stay, row by row; `objects` or the picture.
std::vector<int> cellCounts(const std::vector<Anchor>& anchors, bool objects = false) {
  std::vector<int> counts(static_cast<std::size_t>(kGrid.x * kGrid.y));
  for (const Anchor& each : anchors) {
    if (!each.isStaying() || !isWithin(each.px, 0.0F) || (each.surface != 0) != objects) continue;
    const glm::ivec2 cell(each.px / static_cast<float>(kCellPixels));
    ++counts.at(static_cast<std::size_t>(cell.y * kGrid.x + cell.x));
  }
  return counts;
}

/// Watches that no anchor's fade jumps, from its birth to its end.
class FadeWatch {
 public:
  FadeWatch(float in, float out) : in_(in), out_(out) {}
  void add(const std::vector<Anchor>& anchors) {
    if (before_.empty()) before_ = anchors;
    for (std::size_t slot = 0; slot < anchors.size(); ++slot) {
      const Anchor& was = before_[slot];
      const Anchor& is = anchors[slot];
      const bool isSame = was.isAlive() && is.isAlive() && was.seed == is.seed;
      if (isSame) {
        risen_ = std::max(risen_, is.fade - was.fade);
        fallen_ = std::max(fallen_, was.fade - is.fade);
        continue;
      }
      // What comes in over the border does so with its marks, and takes them out again.
      if (is.isAlive() && isWithin(is.px, 4.0F)) risen_ = std::max(risen_, is.fade);
      if (was.isAlive() && isWithin(was.px, 4.0F)) fallen_ = std::max(fallen_, was.fade);
      if (was.isAlive()) ++ended_;
    }
    before_ = anchors;
  }
  void expectNoPop() const {
    EXPECT_LE(risen_, in_ + 1e-5F);
    EXPECT_LE(fallen_, out_ + 1e-5F);
  }
  int ended() const { return ended_; }

 private:
  float in_;
  float out_;
  std::vector<Anchor> before_;
  float risen_ = 0.0F;
  float fallen_ = 0.0F;
  int ended_ = 0;
};

TEST_F(AnchorLife, AStillSceneHasNoBirthsAndNoDeathsAndNothingMoves) {
  const std::vector<float> still(300, 0.02F);
  std::vector<glm::vec4> flow(1200);
  const std::vector<Anchor> first = next({});
  for (int i = 0; i < 60; ++i) {
    for (std::size_t k = 0; k < flow.size(); ++k) {  // of a sensor's noise
      const auto phase = static_cast<float>(k + 17U * static_cast<unsigned>(i));
      flow[k] = {0.2F * std::sin(phase), 0.2F * std::cos(1.7F * phase), 0.3F, 0.0F};
    }
    const std::vector<Anchor> now = next(
        {.flow = {.nodes = {40, 30}, .stepPx = glm::vec2(8.0F), .forward = flow, .backward = flow},
         .still = {.fields = {20, 15}, .errorPx = still}});
    ASSERT_EQ(births(now), 0);
    for (std::size_t slot = 0; slot < now.size(); ++slot) {
      ASSERT_EQ(now[slot].isAlive(), first[slot].isAlive());
      if (!now[slot].isAlive()) continue;
      ASSERT_EQ(now[slot].px, first[slot].px);
      ASSERT_EQ(now[slot].seed, first[slot].seed);
      ASSERT_EQ(now[slot].fade, 1.0F);
    }
  }
}

TEST_F(AnchorLife, APanBearsOnlyWhatComesIntoThePicture) {
  FadeWatch fades(kIn, kOut);
  next({});
  next(panning(-1.3, 0.4));
  int inside = 0;
  int all = 0;
  int whole = 0;
  for (int i = 0; i < 90; ++i) {
    const std::vector<Anchor> now = next(panning(-1.3, 0.4));
    fades.add(now);
    inside += births(now, 32.0F);
    all += births(now);
    for (const Anchor& each : now) whole += each.isAlive() && each.isBorn() && each.fade == 1.0F;
  }
  EXPECT_GT(all, 500) << "the border that comes in is filled";
  const double there = 2.0 * 32 * 22;  // 32 px and more from the border
  EXPECT_LT(inside / 90.0, 0.005 * there) << "a frame; 5 % would be seen to pop (decision 0014)";
  EXPECT_GT(whole, 20) << "those that come in with the picture are there at once";
  const std::vector<int> counts = cellCounts(set_->read());
  EXPECT_LE(std::ranges::max(counts), 5) << "one above where one goes each frame";
  EXPECT_EQ(std::ranges::count(counts, 0), 0);
  fades.expectNoPop();
}

TEST_F(AnchorLife, APanDoesNotRunOutOfSlots) {
  for (const DensityRule rule : {DensityRule{.target = 1, .birthBelow = 1, .deathAbove = 3},
                                 DensityRule{.target = 4, .birthBelow = 2, .deathAbove = 6}}) {
    set_.emplace(library_, kSize, AnchorOptions{.density = rule});
    for (int i = 0; i < 90; ++i) {
      const std::vector<Anchor> now = next(panning(-0.7, 0.3));
      ASSERT_EQ(std::ranges::count(cellCounts(now), 0), 0)
          << "in frame " << i << " for " << rule.target << " a cell";
    }
  }
}

TEST_F(AnchorLife, ZoomingInBearsWhereItGetsSparse) {
  FadeWatch fades(kIn, kOut);
  next({});
  int born = 0;
  for (int i = 0; i < 90; ++i) {
    const std::vector<Anchor> now = next(zooming(1.01));
    fades.add(now);
    born += births(now);
    ASSERT_EQ(std::ranges::count(cellCounts(now), 0), 0) << "in frame " << i;
  }
  EXPECT_GT(born, 1000);
  fades.expectNoPop();
}

TEST_F(AnchorLife, ZoomingOutFadesOutWhatCrowds) {
  FadeWatch fades(kIn, kOut);
  next({});
  double most = 0.0;
  for (int i = 0; i < 90; ++i) {
    const std::vector<Anchor> now = next(zooming(0.99));
    fades.add(now);
    const std::vector<int> counts = cellCounts(now);
    double sum = 0.0;
    for (const int count : counts) sum += count;
    most = std::max(most, sum / static_cast<double>(counts.size()));
  }
  EXPECT_GT(fades.ended(), 300);
  EXPECT_LE(most, 4.0);
  fades.expectNoPop();
}

TEST_F(AnchorLife, DyingOnesDoNotComeBack) {
  std::set<std::uint32_t> dying;
  next({});
  for (int i = 0; i < 60; ++i) {
    for (const Anchor& each : next(i < 30 ? zooming(0.97) : zooming(1.01))) {
      if (!each.isAlive()) continue;
      if ((each.state & Anchor::kDying) != 0) dying.insert(each.seed);
      ASSERT_TRUE((each.state & Anchor::kDying) != 0 || !dying.contains(each.seed));
    }
  }
  EXPECT_GT(dying.size(), 50U);
}

scene::Scene boxScene() {
  scene::Scene scene;
  scene::SceneModel box;
  box.source = scene::BoxSource{{0.12, 0.12, 0.01}};
  box.model = std::make_shared<const scene::Model>(scene::modelOf(box.source).value());
  scene.models.push_back(std::move(box));
  return scene;
}

/// The box's front, some 72 px wide, with its middle at this px of the picture.
scene::PoseSet boxAt(double x) {
  return {.cameraFromWorld =
              glm::translate(glm::dmat4(1.0), {(x - 162.0) / 300.0 * 0.5, 0.0, 0.5})};
}

TEST_F(AnchorLife, WhatIsHiddenFadesOutAndWhatComesIntoViewIsFilled) {
  useScene(boxScene());
  const ImageMotion none = panning(0.0, 0.0);
  FadeWatch fades(kIn, kOut);
  next({}, boxAt(100.0));
  next(none, boxAt(100.0));
  for (int i = 1; i <= 40; ++i) {
    const std::vector<Anchor> now = next(none, boxAt(100.0 + 3.0 * i));
    fades.add(now);
    for (const Anchor& each : now) {
      if (!each.isAlive() || each.surface != 0) continue;
      // Well inside the box: nothing of the picture is seen there.
      const bool isBehind = std::abs(each.px.x - (100.0F + 3.0F * static_cast<float>(i))) < 33.0F &&
                            std::abs(each.px.y - 118.0F) < 33.0F;
      ASSERT_FALSE(isBehind && each.isStaying());
    }
  }
  const std::vector<Anchor> last = set_->read();
  const std::vector<int> inImage = cellCounts(last);
  // Where the box began: x 64 … 136, y 82 … 154.
  for (int y = 11; y < 18; ++y) {
    for (int x = 9; x < 16; ++x) {
      EXPECT_GE(inImage.at(static_cast<std::size_t>(y * kGrid.x + x)), 1) << x << ", " << y;
    }
  }
  const std::vector<int> onBox = cellCounts(last, true);
  for (int y = 11; y < 18; ++y) {
    for (int x = 24; x < 30; ++x) {  // it is at x 184 … 256 now
      EXPECT_GE(onBox.at(static_cast<std::size_t>(y * kGrid.x + x)), 1) << x << ", " << y;
    }
  }
  EXPECT_GT(fades.ended(), 50);
  fades.expectNoPop();
}

TEST_F(AnchorLife, WithoutItsPoseAModelsAnchorsFadeOut) {
  useScene(boxScene());
  const ImageMotion none = panning(0.0, 0.0);
  next({}, boxAt(160.0));
  const auto onBox = [](const std::vector<Anchor>& anchors) {
    return std::ranges::count_if(
        anchors, [](const Anchor& each) { return each.isAlive() && each.surface != 0; });
  };
  EXPECT_GT(onBox(next(none, boxAt(160.0))), 100);
  FadeWatch fades(kIn, kOut);
  fades.add(set_->read());
  for (int i = 0; i < 7; ++i) fades.add(next(none));
  EXPECT_EQ(onBox(set_->read()), 0) << "after 200 ms";
  EXPECT_EQ(std::ranges::count(cellCounts(set_->read()), 0), 0);
  fades.expectNoPop();
}

TEST_F(AnchorLife, ACutBeginsAnew) {
  next({});
  EXPECT_TRUE(set_->hasBegunAnew());
  const std::vector<Anchor> before = next(panning(-1.0, 0.0));
  EXPECT_FALSE(set_->hasBegunAnew());
  ImageMotion cut = panning(-1.0, 0.0);
  cut.isCut = true;
  const std::vector<Anchor> after = next(cut);
  EXPECT_TRUE(set_->hasBegunAnew());
  std::set<std::uint32_t> old;
  for (const Anchor& each : before) {
    if (each.isAlive()) old.insert(each.seed);
  }
  for (const Anchor& each : after) {
    if (!each.isAlive()) continue;
    EXPECT_TRUE(each.isBorn());
    EXPECT_EQ(each.fade, 1.0F) << "there at once";
    EXPECT_FALSE(old.contains(each.seed));
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
  for (std::size_t slot = 0; slot < once.size(); ++slot) {
    if (once[slot].isAlive() != again[slot].isAlive() ||
        (once[slot].isAlive() && std::memcmp(&once[slot], &again[slot], sizeof(Anchor)) != 0)) {
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
      renderer_->compose(half, halfCamera, boxAt(160.0), ++sequence_, time_ += kStep, timer_,
                         {.surfaces = true, .pictureMovement = true});
  frame.fullSize = kSize;
  frame.pictureMovement = scene::PictureMovement{.motion = &motion_};
  field_->update(frame, timer_);
  set_->advance(frame, *field_, timer_);
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
    features[i] = {.then = at, .now = at + glm::vec2(-1.0F, 0.2F), .errorPx = 0.1F};
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
