// The silhouette of a mover, which follows the picture's own edge and not the coarser labels.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "tests/gpu/painterly/painterly_fixture.h"

namespace pleinair::styles {
namespace {

/// A disc with a smooth edge passes before a wall.
class MoverSilhouette : public PainterlyTest {
 protected:
  static constexpr double kEdgePx = 30.0;  ///< from the disc's middle
  static constexpr double kDisc = 51.0;    ///< levels
  static constexpr double kWall = 180.0;

  /// The share of a pixel that the disc covers.
  double coverAt(int x, int y) const {
    return std::clamp(kEdgePx + 0.5 - glm::distance(glm::dvec2(x, y), middle_), 0.0, 1.0);
  }

  /// Levels by which the painting differs from the picture beside the disc's edge, in the mean,
  /// once it has come in and moves by fractions of a pixel.
  double errorAtEdge(const char* clip, const char* colourClip) {
    Painterly style(library_);
    style.setParameters(style.parameters()
                            .with("clip", clip)
                            .with("colour_clip", colourClip)
                            .with("opacity", "1")
                            .with("wash", "1")
                            .with("tooth", "0")
                            .with("relief", "0")
                            .with("gloss", "0")
                            .with("canvas", "0")
                            .with("saturation", "1")
                            .with("warmth", "0"));
    restart();
    double sum = 0.0;
    double count = 0.0;
    for (int frame = 0; frame < 14; ++frame) {
      middle_ = {-40.0 + 10.37 * frame, 72.3};
      hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = kSize});
      for (int y = 0; y < kSize.height; ++y) {
        auto* p = image.row(0, y).data();
        for (int x = 0; x < kSize.width; ++x, p += 4) {
          const double level = kWall + (kDisc - kWall) * coverAt(x, y);
          p[0] = p[1] = p[2] = static_cast<std::uint8_t>(level + 0.5);
          p[3] = 255;
        }
      }
      const std::vector<std::uint8_t> painting = paint(style, next(image));
      if (frame < 9) continue;
      for (int y = 0; y < kSize.height; ++y) {
        for (int x = 0; x < kSize.width; ++x) {
          const double away = glm::distance(glm::dvec2(x, y), middle_) - kEdgePx;
          if (std::abs(away) > 1.5) continue;
          const auto at = static_cast<std::size_t>(y * kSize.width + x) * 4;
          sum += std::abs(painting[at] - (kWall + (kDisc - kWall) * coverAt(x, y)));
          count += 1.0;
        }
      }
    }
    return sum / count;
  }

 private:
  glm::dvec2 middle_{0.0};
};

TEST_F(MoverSilhouette, FollowsThePicturesEdgeByPartsOfAPixel) {
  constexpr double kContrast = kWall - kDisc;
  const double followed = errorAtEdge("true", "1");
  EXPECT_LT(followed, 0.08 * kContrast);
  EXPECT_GT(errorAtEdge("false", "0"), 2.0 * followed) << "the control: strokes that run over it";
}

}  // namespace
}  // namespace pleinair::styles
