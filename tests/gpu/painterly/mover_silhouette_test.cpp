// The silhouette of a mover, which follows the picture's own edge and not the coarser labels.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

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

  struct Edge {
    double error = 0.0;  ///< levels by which painting and picture differ there, in the mean
    double specksPercent =
        0.0;  ///< of the wall's pixels 1 to 3 px beside it, those that differ clearly
  };
  struct Settings {
    const char* clip = "true";
    const char* colourClip = "1";
    const char* relief = "0";
    const char* accents = "true";
    double spikes =
        0.0;  ///< the share of single pixels of the wall that are nearly as dark as the disc
  };

  /// How the disc's edge is painted, once it has come in and moves by fractions of a pixel.
  Edge paintedEdge(const Settings& settings) {
    Painterly style(library_);
    style.setParameters(style.parameters()
                            .with("clip", settings.clip)
                            .with("colour_clip", settings.colourClip)
                            .with("accents", settings.accents)
                            .with("opacity", "1")
                            .with("wash", "1")
                            .with("tooth", "0")
                            .with("relief", settings.relief)
                            .with("gloss", "0")
                            .with("canvas", "0")
                            .with("saturation", "1")
                            .with("warmth", "0"));
    restart();
    std::mt19937 random(7);
    std::bernoulli_distribution isSpike(settings.spikes);
    double sum = 0.0;
    double count = 0.0;
    double specks = 0.0;
    double beside = 0.0;
    for (int frame = 0; frame < 14; ++frame) {
      middle_ = {-40.0 + 10.37 * frame, 72.3};
      hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = kSize});
      for (int y = 0; y < kSize.height; ++y) {
        auto* p = image.row(0, y).data();
        for (int x = 0; x < kSize.width; ++x, p += 4) {
          double level = kWall + (kDisc - kWall) * coverAt(x, y);
          if (isSpike(random)) level = std::min(level, kDisc + 30.0);
          p[0] = p[1] = p[2] = static_cast<std::uint8_t>(level + 0.5);
          p[3] = 255;
        }
      }
      const std::vector<std::uint8_t> painting = paint(style, next(image));
      if (frame < 9) continue;
      for (int y = 0; y < kSize.height; ++y) {
        for (int x = 0; x < kSize.width; ++x) {
          const double away = glm::distance(glm::dvec2(x, y), middle_) - kEdgePx;
          const auto at = static_cast<std::size_t>(y * kSize.width + x) * 4;
          if (away > 1.0 && away < 3.0) {
            specks += std::abs(painting[at] - kWall) > 0.25 * (kWall - kDisc) ? 1.0 : 0.0;
            beside += 1.0;
          }
          if (std::abs(away) > 1.5) continue;
          sum += std::abs(painting[at] - (kWall + (kDisc - kWall) * coverAt(x, y)));
          count += 1.0;
        }
      }
    }
    return {.error = sum / count, .specksPercent = 100.0 * specks / beside};
  }

 private:
  glm::dvec2 middle_{0.0};
};

TEST_F(MoverSilhouette, FollowsThePicturesEdgeByPartsOfAPixel) {
  constexpr double kContrast = kWall - kDisc;
  const double followed = paintedEdge({}).error;
  EXPECT_LT(followed, 0.08 * kContrast);
  EXPECT_GT(paintedEdge({.clip = "false", .colourClip = "0"}).error, 2.0 * followed)
      << "the control: strokes that run over it";
}

TEST_F(MoverSilhouette, HasNoSpecksBesideIt) {
  // More strokes in what seems to be full of detail would show some of the wall's own.
  const double specks = paintedEdge({.accents = "false", .spikes = 0.04}).specksPercent;
  RecordProperty("specks", std::to_string(specks));
  EXPECT_LT(specks, 2.3) << "a pixel by itself: 3.4";
  EXPECT_LT(paintedEdge({.spikes = 0.04}).specksPercent, 4.0) << "all of the wall's own";
}

/// The paint of both sides is mixed there, and their heights differ by a step that no paint has.
TEST_F(MoverSilhouette, HasNoRelief) {
  const double flat = paintedEdge({}).error;
  const double lit = paintedEdge({.relief = "3"}).error;
  RecordProperty("flat", std::to_string(flat));
  RecordProperty("lit", std::to_string(lit));
  EXPECT_LT(lit, flat + 10.0);
}

}  // namespace
}  // namespace pleinair::styles
