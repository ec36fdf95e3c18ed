// How many strokes come and go: few under a pan, once it goes on, and none on a still scene.
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "pipeline/measure/anchor_measures.h"
#include "tests/gpu/painterly/painterly_fixture.h"

namespace pleinair::styles {
namespace {

constexpr hal::FrameSize kSize{320, 240};
constexpr int kTwoSeconds = 60;  // frames
constexpr int kMeasured = 30;

class Turnover : public PainterlyTest {
 protected:
  /// The anchors' summaries, over all layers and for each, of a painting whose strokes are as large
  /// as at 640x480, under a given pan and with noise from frame to frame.
  std::vector<measure::AnchorSummary> under(glm::dvec2 pan, const char* hysteresis = "true") {
    restart();
    Painterly style(library_);
    style.setParameters(style.parameters().with("stroke_size", "8").with("hysteresis", hysteresis));
    std::vector<measure::AnchorMeasures> measures;
    for (int i = 0; i < kTwoSeconds + kMeasured; ++i) {
      const hal::Image picture = testPicture(kSize, static_cast<unsigned>(i), -pan.x * i);
      picture_ = support::textureOf(picture.view());
      scene::ArFrame frame = followed(picture_, i, pan, motion_);
      frame.captureTime = hal::TimePoint(hal::Duration(33'333'333) * i);
      style.paint(frame, "");
      if (i < kTwoSeconds) continue;
      measures.resize(1 + style.layerCount(), measure::AnchorMeasures({kSize.width, kSize.height}));
      measures[0].add(style.readAnchors(), nullptr, nullptr);
      for (std::size_t layer = 0; layer < style.layerCount(); ++layer) {
        measures[1 + layer].add(style.layer(layer).anchors.read(), nullptr, nullptr);
      }
    }
    std::vector<measure::AnchorSummary> found;
    for (const measure::AnchorMeasures& each : measures) found.push_back(*each.total());
    return found;
  }
};

TEST_F(Turnover, NothingComesOrGoesOnAStillScene) {
  const auto layers = under({0.0, 0.0});
  ASSERT_GT(layers.size(), 3U);
  EXPECT_GT(layers[0].alive, 1000.0);
  for (const measure::AnchorSummary& each : layers) {
    EXPECT_GT(each.alive, 10.0);
    EXPECT_EQ(each.births + each.deaths, 0.0);
    EXPECT_EQ(each.moved, 0.0);
  }
}

TEST_F(Turnover, IsSmallUnderAPan) {
  for (const glm::dvec2 pan : {glm::dvec2(-1.5, -0.5), {-1.3, 0.4}, {3.0, 0.0}}) {
    SCOPED_TRACE(std::to_string(pan.x) + ", " + std::to_string(pan.y));
    const auto layers = under(pan);
    std::string told;
    for (const measure::AnchorSummary& each : layers) {
      told += std::to_string(each.innerTurnoverPercent) + " ";
    }
    RecordProperty("percent_all_and_by_layer_" + std::to_string(pan.x), told);
    EXPECT_LE(layers[0].innerTurnoverPercent, 0.5) << told;
    EXPECT_GT(layers[0].births, 0.0) << "what comes in is painted";
  }
}

TEST_F(Turnover, WithoutHysteresisIsLarge) {
  EXPECT_GT(under({-1.5, -0.5}, "false")[0].innerTurnoverPercent, 2.0) << "the control";
}

}  // namespace
}  // namespace pleinair::styles
