// Strokes on virtual objects go with the surface under each of their points, and stretch with it.
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "pipeline/marks/marks_shaders.h"
#include "pipeline/scene/builtin/builtin_box.h"
#include "pipeline/scene/render/ar_frame_renderer.h"
#include "pipeline/scene/scene_shaders.h"
#include "tests/gpu/marks/stroke_fixture.h"

namespace pleinair::marks {
namespace {

constexpr hal::FrameSize kSheet{256, 128};
constexpr float kSegmentPx = 8.0F;
constexpr float kSheetEdge = 200.0F;  ///< px: the object's right edge
constexpr std::uint32_t kObject = 1U << scene::kTriangleBits;

/// Where a point of the sheet goes in a frame: it bends, and stretches to the right.
glm::dvec2 moved(glm::dvec2 from) {
  return {1.05 * from.x + 2.0, from.y + 5.0 * std::sin(from.x / 12.0)};
}
glm::dvec2 cameFrom(glm::dvec2 to) {
  const double x = (to.x - 2.0) / 1.05;
  return {x, to.y - 5.0 * std::sin(x / 12.0)};
}
glm::mat2 jacobianAt(glm::dvec2 from) {
  return {glm::vec2(1.05, 5.0 / 12.0 * std::cos(from.x / 12.0)), glm::vec2(0.0, 1.0)};
}

class StrokeCarry : public support::GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    if (IsSkipped()) return;
    std::vector<glm::vec4> motion;
    std::vector<std::uint32_t> ids;
    for (int y = 0; y < kSheet.height; ++y) {
      for (int x = 0; x < kSheet.width; ++x) {
        const glm::dvec2 px(x + 0.5, y + 0.5);
        motion.emplace_back(px - cameFrom(px), 0.0F, 1.0F);
        ids.push_back(px.x < kSheetEdge ? kObject : 0U);
      }
    }
    const auto width = static_cast<std::size_t>(kSheet.width);
    motion_ = gpu::Texture(gpu::TextureFormat::kRgba32f, kSheet);
    motion_.upload({reinterpret_cast<const std::uint8_t*>(motion.data()), 16 * motion.size()},
                   16 * width);
    ids_ = gpu::Texture(gpu::TextureFormat::kR32ui, kSheet);
    ids_.upload({reinterpret_cast<const std::uint8_t*>(ids.data()), 4 * ids.size()}, 4 * width);
  }

  /// An anchor that was at `from`.
  static Anchor anchorFrom(glm::dvec2 from, std::uint32_t surface = kObject) {
    return {.px = moved(from),
            .displacementPx = moved(from) - from,
            .jacobian = jacobianAt(from),
            .surface = surface,
            .state = Anchor::kAlive | Anchor::kOnSurface};
  }
  static StrokeSlot straight(glm::vec2 ahead) {
    return {.ahead = {ahead, ahead, ahead, ahead},
            .behind = {-ahead, -ahead, -ahead, -ahead},
            .lengths = {4.0F, 4.0F},
            .exists = 1.0F,
            .state = 5U,
            .colour = {},
            .seen = 1.0F};
  }
  std::vector<StrokeSlot> carried(const std::vector<Anchor>& anchors, const StrokeSlot& stroke) {
    gpu::ShaderLibrary library;
    library.add(gpu::marksShaders());
    library.add(gpu::sceneShaders());
    const gpu::Buffer held = gpu::Buffer::of(std::span(anchors));
    const std::vector<StrokeSlot> all(anchors.size(), stroke);
    const gpu::Buffer strokes = gpu::Buffer::of(std::span(all));
    library.compute("pipeline/marks/strokes/shaders/stroke_carry.comp")
        .use()
        .storage("Anchors", held)
        .storage("Strokes", strokes)
        .texture("motion", motion_)
        .set("hasMotion", 1)
        .texture("ids", ids_)
        .set("pixelsOfFull", glm::vec2(1.0F))
        .set("segment", kSegmentPx)
        .set("arms", glm::ivec2(2, 4))
        .set("slots", static_cast<unsigned>(anchors.size()))
        .dispatch({static_cast<int>(anchors.size()), 1}, GL_BUFFER_UPDATE_BARRIER_BIT);
    return support::readBuffer<StrokeSlot>(strokes);
  }

  gpu::Texture motion_;
  gpu::Texture ids_;
};

/// The largest distance of a stroke's points from where the sheet has taken them.
double worstOff(const Anchor& anchor, glm::dvec2 from, const std::array<glm::vec2, 4>& arm,
                glm::dvec2 direction) {
  glm::dvec2 at(anchor.px);
  glm::dvec2 was = from;
  double worst = 0.0;
  for (const glm::vec2& each : arm) {
    at += double{kSegmentPx} * glm::dvec2(each);
    was += double{kSegmentPx} * direction;
    worst = std::max(worst, glm::distance(at, moved(was)));
  }
  return worst;
}

TEST_F(StrokeCarry, EachPointStaysOnTheBendingSurface) {
  std::vector<glm::dvec2> places;
  std::vector<Anchor> anchors;
  for (double x = 40.0; x < 150.0; x += 7.0) {
    places.emplace_back(x, 60.0);
    anchors.push_back(anchorFrom(places.back()));
  }
  const std::vector<StrokeSlot> strokes = carried(anchors, straight({1.0F, 0.0F}));
  double control = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_LT(worstOff(anchors[i], places[i], strokes[i].ahead, {1.0, 0.0}), 0.4) << i;
    EXPECT_LT(worstOff(anchors[i], places[i], strokes[i].behind, {-1.0, 0.0}), 0.4) << i;
    const glm::vec2 turned = glm::normalize(anchors[i].jacobian * glm::vec2(1.0F, 0.0F));
    control = std::max(
        control, worstOff(anchors[i], places[i], {turned, turned, turned, turned}, {1.0, 0.0}));
  }
  EXPECT_GT(control, 4.0) << "the control: strokes that turn as one";
}

TEST_F(StrokeCarry, WidthsStretchWithWhatIsAcross) {
  const std::vector<StrokeSlot> strokes =
      carried({anchorFrom({6.0 * std::numbers::pi, 60.0})}, straight({0.0F, 1.0F}));
  // There the sheet does not shear: it is 1.05 times as wide.
  const auto octaves = static_cast<double>(strokes[0].state >> 13U & 0xFFFU) / 2048.0;
  EXPECT_NEAR(std::exp2(octaves), 1.05, 0.001);
  EXPECT_EQ(strokes[0].state & 8191U, 5U) << "the label stays";
}

TEST_F(StrokeCarry, BeyondTheObjectAndWhereItIsHiddenTheStrokeTurnsAsOne) {
  Anchor hidden = anchorFrom({60.0, 60.0});
  hidden.state |= Anchor::kHidden;
  const std::vector<Anchor> anchors{anchorFrom({184.0, 60.0}), hidden};
  const std::vector<StrokeSlot> strokes = carried(anchors, straight({1.0F, 0.0F}));
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    const glm::vec2 turned = anchors[i].jacobian * glm::vec2(1.0F, 0.0F);
    EXPECT_LT(glm::distance(strokes[i].ahead[3], turned), 1e-4F) << i;
  }
}

TEST_F(StrokeCarry, ATriangleThatHasCollapsedLeavesTheDirection) {
  Anchor edgeOn = anchorFrom({60.0, 60.0});
  edgeOn.jacobian = glm::mat2(0.0F);
  edgeOn.state |= Anchor::kHidden;
  EXPECT_EQ(carried({edgeOn}, straight({1.0F, 0.0F}))[0].ahead[3], glm::vec2(1.0F, 0.0F));
}

TEST_F(StrokeCarry, OthersStayAsTheyAre) {
  Anchor born = anchorFrom({60.0, 60.0});
  born.state |= Anchor::kBorn;
  Anchor dormant = anchorFrom({60.0, 60.0});
  dormant.state = Anchor::kDormant | Anchor::kOnSurface;
  for (const StrokeSlot& stroke :
       carried({anchorFrom({60.0, 60.0}, 0U), born, dormant}, straight({1.0F, 0.0F}))) {
    EXPECT_EQ(stroke.ahead[0], glm::vec2(1.0F, 0.0F));
    EXPECT_EQ(stroke.behind[3], glm::vec2(-1.0F, 0.0F));
    EXPECT_EQ(stroke.state, 5U);
  }
}

/// A box that comes nearer by 1 % a frame.
class StrokeStretch : public StrokeTest {
 protected:
  void see(scene::ArFrameRenderer& renderer, double metres, const StrokeRule& rule) {
    const gpu::Texture picture =
        support::textureOf(greyPicture(kSize, [](glm::dvec2) { return 0.5; }).view());
    const tracking::CameraModel camera(
        {.fx = 260.0, .fy = 260.0, .cx = 0.5 * kSize.width, .cy = 0.5 * kSize.height}, {}, kSize);
    const glm::dmat4 place = glm::translate(glm::dmat4(1.0), {0.0, 0.0, metres});
    ++sequence_;
    scene::ArFrame frame = renderer.compose(
        picture, camera, {.cameraFromWorld = place}, sequence_,
        hal::TimePoint(kStep * static_cast<std::int64_t>(sequence_)), {.surfaces = true});
    tracking::ImageMotion still = standing();
    still.frameSize = kSize;
    still.sinceSequence = sequence_ - 1;
    frame.measuredMotion = scene::MeasuredMotion{.motion = &still};
    motionField_->update(frame);
    field_->update(frame, *frame.colour, *motionField_, kNoMemory);
    anchors_->advance(frame, *motionField_, {});
    const StrokePaint paints{.background = frame.colour,
                             .models = frame.colour,
                             .movers = frame.colour,
                             .fineModels = frame.colour};
    strokes_->update(frame, *anchors_, *field_, paints, rule);
  }
  /// Of the strokes that have lived for ten frames: the mean length of their directions.
  double meanStretch() const {
    const std::vector<StrokeSlot> strokes = readStrokes();
    double sum = 0.0;
    int count = 0;
    for (const auto& [slot, anchor] : alive()) {
      if (anchor.surface == 0U || anchor.ageSeconds() < 0.3F) continue;
      sum += glm::length(strokes[slot].ahead[0]);
      ++count;
    }
    EXPECT_GT(count, 10);
    return sum / count;
  }
  std::uint64_t sequence_ = 0;
};

TEST_F(StrokeStretch, IsTakenBackOnceTheSurfaceStands) {
  scene::Scene scene;
  scene.light.shadow = 0.0F;
  scene.models.push_back({.model = std::make_shared<const scene::Model>(
                              scene::singlePartModel("box", scene::boxMesh({0.2, 0.12, 0.08})))});
  scene::ArFrameRenderer renderer(library_, scene);
  StrokeRule rule;
  rule.segmentPx = 4.0F;
  double metres = 0.6;
  for (int i = 0; i < 20; ++i) see(renderer, metres *= 0.99, rule);
  const double stretched = meanStretch();
  EXPECT_GT(stretched, 1.06);
  EXPECT_LT(stretched, 1.0 / std::pow(0.99, 20)) << "all of it, had nothing been taken back";
  for (int i = 0; i < 60; ++i) see(renderer, metres, rule);
  EXPECT_NEAR(meanStretch(), 1.0, 0.02);
}

}  // namespace
}  // namespace pleinair::marks
