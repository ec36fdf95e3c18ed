// Segments of the camera image: strokes stay on theirs, whose border follows the pixels' colours,
// and rests while the camera stands.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "pipeline/gpu/render_target.h"
#include "pipeline/marks/movers/layer_textures.h"
#include "pipeline/marks/tensors/segment_map.h"
#include "pipeline/tracking/segments/image_segmenter.h"
#include "tests/gpu/painterly/painterly_fixture.h"
#include "tests/gpu/painterly/spill.h"

namespace pleinair::styles {
namespace {

class SegmentsTest : public PainterlyTest {
 protected:
  static constexpr double kRadius = 40.0;

  static double beyondDisc(double x, double y, double shift) {
    return std::hypot(x + 0.5 - 96.0 - shift, y + 0.5 - 72.0) - kRadius;
  }
  /// A red disc on blue, with a pixel of both at the rim.
  static hal::Image disc(double noiseSigma = 0.0, unsigned seed = 1, double shift = 0.0) {
    hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = kSize});
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, 1.0);
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        auto* p = image.row(0, y).data() + std::ptrdiff_t{x} * 4;
        const double in = std::clamp(0.5 - beyondDisc(x, y, shift), 0.0, 1.0);
        const double levels[3] = {20.0 + 200.0 * in, 40.0, 220.0 - 200.0 * in};
        for (int c = 0; c < 3; ++c) {
          p[c] = static_cast<std::uint8_t>(
              std::clamp(levels[c] + noiseSigma * noise(random) + 0.5, 0.0, 255.0));
        }
        p[3] = 255;
      }
    }
    return image;
  }

  /// The next frame, with its segments.
  scene::ArFrame segmented(const hal::Image& image, double motionPixels = 0.0) {
    scene::ArFrame frame = next(image, motionPixels);
    motion_.isCut = number_ == 1;
    motion_.noiseLevels = 3.0;
    frame.measuredSegments =
        scene::MeasuredSegments{.segments = &segmenter_.follow(image.view(), motion_)};
    return frame;
  }

  int spilled(const char* segments) {
    restart();
    Painterly style(library_);
    style.setParameters(spilling(style.parameters(), {{"segments", segments}}));
    std::vector<std::uint8_t> painted;
    for (int i = 0; i < 3; ++i) {
      // As the engine does.
      const bool isAsked = style.needs().segments;
      scene::ArFrame frame = segmented(disc());
      if (!isAsked) frame.measuredSegments.reset();
      painted = paint(style, frame);
    }
    return spilledPixels(painted, kSize, [](int x, int y) { return beyondDisc(x, y, 0.0); });
  }

  /// The labels of pixels and their shares (borders.frag), two textures in turn.
  std::vector<std::uint32_t> borders(const scene::ArFrame& frame, bool isHeld) {
    map_.update(frame);
    if (!layerTextures_) {
      layerTextures_ = std::make_unique<marks::LayerTextures>();
      for (gpu::Texture& each : borders_) each = {gpu::TextureFormat::kR32ui, kSize};
    }
    now_ = 1 - now_;
    gpu::Program program = library_.fragmentPass("pipeline/styles/strokes/shaders/borders.frag");
    marks::SegmentMap::bind(program.use(), &map_, borders_[0]);
    program.texture("forms", borders_.at(1 - now_))
        .texture("moverShares", layerTextures_->sharesOf(nullptr))
        .texture("picture", *frame.colour)
        .texture("before", borders_.at(1 - now_))
        .set("hasObjects", 0)
        .set("isHeld", isHeld ? 1 : 0)
        .set("size", glm::vec2(kSize.width, kSize.height))
        .set("pixelsOfFull", glm::vec2(1.0F))
        .drawFullscreen(gpu::RenderTarget({&borders_.at(now_)}));
    return support::readR32ui(borders_.at(now_));
  }
  tracking::ImageSegmenter segmenter_;
  marks::SegmentMap map_;
  std::array<gpu::Texture, 2> borders_;
  std::unique_ptr<marks::LayerTextures> layerTextures_;
  std::size_t now_ = 0;
};

constexpr std::uint32_t kLabelMask = 8191;

TEST_F(SegmentsTest, NoPaintRunsOverASegmentsBorder) {
  const int clipped = spilled("true");
  const int unclipped = spilled("false");
  RecordProperty("pixels", std::to_string(clipped) + " of " + std::to_string(unclipped));
  EXPECT_GT(unclipped, 60) << "strokes are to reach over where there are no segments";
  EXPECT_LE(clipped, 2);
}

TEST_F(SegmentsTest, TheStyleAsksForThemIfTheyAreOn) {
  Painterly style(library_);
  EXPECT_FALSE(style.needs().segments);
  style.setParameters(style.parameters().with("segments", "true"));
  EXPECT_TRUE(style.needs().segments);
}

TEST_F(SegmentsTest, TheViewShowsEachInAColourOfItsOwn) {
  Painterly style(library_);
  style.setParameters(style.parameters().with("segments", "true"));
  const std::vector<std::uint8_t> shown = paint(style, segmented(disc()), "segments");
  const auto colourAt = [&](int x, int y) {
    const std::size_t at = static_cast<std::size_t>(y * kSize.width + x) * 4;
    return std::array{shown[at], shown[at + 1], shown[at + 2]};
  };
  EXPECT_EQ(colourAt(96, 72), colourAt(120, 90));
  EXPECT_EQ(colourAt(5, 5), colourAt(180, 140));
  EXPECT_NE(colourAt(96, 72), colourAt(5, 5));
}

/// To the pixel, though cells are two px wide; and under a pan of fractions of a pixel.
TEST_F(SegmentsTest, BordersFollowThePixels) {
  double shift = 0.0;
  for (int i = 0; i < 6; ++i, shift += 0.7) {
    const std::vector<std::uint32_t> found = borders(
        segmented(disc(3.0, 7U + static_cast<unsigned>(i), shift), i == 0 ? 0.0 : -0.7), false);
    const auto labelAt = [&](int x, int y) {
      return found[static_cast<std::size_t>(y * kSize.width + x)] & kLabelMask;
    };
    const std::uint32_t inside = labelAt(96, 72);
    const std::uint32_t outside = labelAt(5, 5);
    EXPECT_GE(std::min(inside, outside), 4096U);
    EXPECT_NE(inside, outside);
    int wrong = 0;
    double area = 0.0;
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        const double beyond = beyondDisc(x, y, shift);
        const std::uint32_t border = found[static_cast<std::size_t>(y * kSize.width + x)];
        const double share = (border >> 26U & 31U) / 31.0;
        area += (border & kLabelMask) == inside ? share : 1.0 - share;
        if (std::abs(beyond) > 1.5) wrong += labelAt(x, y) != (beyond < 0.0 ? inside : outside);
      }
    }
    EXPECT_EQ(wrong, 0) << i;
    EXPECT_NEAR(area, 3.14159 * kRadius * kRadius, 0.01 * 3.14159 * kRadius * kRadius) << i;
  }
}

TEST_F(SegmentsTest, BordersRestWhileTheCameraStands) {
  std::vector<std::uint32_t> before;
  for (unsigned i = 0; i < 32; ++i) {
    const std::vector<std::uint32_t> now = borders(segmented(disc(3.0, i)), i > 0);
    if (i > 26) {
      EXPECT_TRUE(now == before) << i;
    }
    before = now;
  }
  EXPECT_FALSE(borders(segmented(disc(3.0, 99)), false) == before) << "the control: not held";
}

}  // namespace
}  // namespace pleinair::styles
