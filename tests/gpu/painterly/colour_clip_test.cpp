// Strokes of models and movers leave out what is of quite another colour.
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/gpu/render_target.h"
#include "pipeline/styles/strokes/brushes.h"
#include "pipeline/styles/strokes/stroke_drawing.h"
#include "tests/gpu/painterly/painterly_fixture.h"
#include "tests/gpu/painterly/strip_fixture.h"

namespace pleinair::styles {
namespace {

using Pixel = std::array<int, 3>;

constexpr hal::FrameSize kClipped{96, 96};
constexpr Pixel kSkin{214, 172, 150};
constexpr Pixel kEye{62, 48, 44};
constexpr std::uint32_t kMoverLabel = 4095;

hal::Image plainPicture(const Pixel& colour, hal::FrameSize size) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = size});
  for (int y = 0; y < size.height; ++y) {
    auto* pixel = image.row(0, y).data();
    for (int x = 0; x < size.width; ++x, pixel += 4) {
      for (std::size_t c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(colour.at(c));
      pixel[3] = 255;
    }
  }
  return image;
}

/// A stroke of the skin's colour over an eye, which is 8 px wide.
class ClippedStroke : public StripTest {
 protected:
  struct Cover {
    int onEye = 0;   ///< alpha in the eye's middle
    int beside = 0;  ///< 20 px from it, along the stroke
  };
  /// A border, as borders.frag packs it, of which every pixel is.
  struct Border {
    std::uint32_t other = 0;
    std::uint32_t share = 0;  ///< of 31, the stroke's side
  };
  Cover drawn(std::uint32_t label, float colourClip) {
    return drawn(label, colourClip, {.other = label, .share = 31}, kEye);
  }
  Cover drawn(std::uint32_t label, float colourClip, const Border& border, const Pixel& eye) {
    hal::Image face = plainPicture(kSkin, {kClipped.width / 2, kClipped.height / 2});
    for (int y = 22; y < 26; ++y) {
      for (int x = 22; x < 26; ++x) {
        for (std::size_t c = 0; c < 3; ++c) {
          face.row(0, y)[static_cast<std::size_t>(4 * x) + c] =
              static_cast<std::uint8_t>(eye.at(c));
        }
      }
    }
    gpu::Texture picture(gpu::TextureFormat::kRgba8, face.size(), gpu::TextureFilter::kLinear);
    picture.upload(face.plane(0), static_cast<std::size_t>(face.size().width) * 4);
    const std::vector<std::uint32_t> pixels(static_cast<std::size_t>(kClipped.pixels()),
                                            label | border.other << 13U | border.share << 26U);
    gpu::Texture borders(gpu::TextureFormat::kR32ui, kClipped);
    borders.upload({reinterpret_cast<const std::uint8_t*>(pixels.data()), 4 * pixels.size()},
                   static_cast<std::size_t>(kClipped.width) * 4);
    LaidStroke stroke = straightStroke({8, 48}, {88, 48});
    stroke.halfWidth = 10.0F;
    stroke.paint = glm::vec4(glm::vec3(kSkin[0], kSkin[1], kSkin[2]) / 255.0F, 1.0F);
    stroke.label = static_cast<float>(label);
    lay({stroke}, StrokeQuads::kCurvature, {.clips = true});
    const gpu::Texture colour(gpu::TextureFormat::kRgba8, kClipped);
    const gpu::Texture height(gpu::TextureFormat::kRgba8, kClipped);
    const gpu::RenderTarget target({&colour, &height});
    target.beginKeeping();
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT);
    StrokeDrawing(library_).draw(strips_, makeBrush(Brush::kMarker, 16), {},
                                 {.borders = &borders, .picture = &picture, .colour = colourClip},
                                 kClipped, target);
    hal::Image image = support::readRgba8(colour);
    const auto row = image.row(0, 48);
    return {.onEye = row[48 * 4 + 3], .beside = row[68 * 4 + 3]};
  }
};

TEST_F(ClippedStroke, OfAMoverLeavesOutWhatIsOfAnotherColour) {
  const Cover with = drawn(kMoverLabel, 1.0F);
  EXPECT_LT(with.onEye, 8);
  EXPECT_GT(with.beside, 200);
  const Cover without = drawn(kMoverLabel, 0.0F);
  EXPECT_GT(without.onEye, 200) << "the control";
}

/// Labels reach beyond a mover here and there: the picture has the ground's colour then.
TEST_F(ClippedStroke, AtAMoversBorderLeavesOutTheGroundsColourButNoMixture) {
  constexpr Border kBorder{.other = 0, .share = 20};
  EXPECT_LT(drawn(kMoverLabel, 1.0F, kBorder, kEye).onEye, 8);
  EXPECT_GT(drawn(kMoverLabel, 0.0F, kBorder, kEye).onEye, 200) << "the control";
  constexpr Pixel kMixed{164, 131, 115};  // a third of the eye's colour
  EXPECT_GT(drawn(kMoverLabel, 1.0F, kBorder, kMixed).onEye, 200);
  EXPECT_LT(drawn(kMoverLabel, 1.0F).onEye, 8);
  EXPECT_LT(drawn(kMoverLabel, 1.0F, {.other = kMoverLabel, .share = 31}, kMixed).onEye, 80)
      << "inside a mover, it is of another colour";
}

TEST_F(ClippedStroke, OfTheRestOfThePictureIsWhole) {
  const Cover with = drawn(0, 1.0F);
  EXPECT_EQ(with.onEye, with.beside);
  EXPECT_GT(with.onEye, 200);
}

class ColourClip : public PainterlyTest {};

TEST_F(ColourClip, LeavesPaintWhereThePictureIsItsColour) {
  std::vector<std::vector<std::uint8_t>> painted;
  for (const char* const clip : {"0", "1"}) {
    Painterly style(library_);
    style.setParameters(style.parameters().with("colour_clip", clip));
    restart();
    painted.push_back(paint(style, next(plainPicture(kSkin, kSize))));
  }
  EXPECT_LT(meanDifference(painted[0], painted[1]), 0.5);
}

TEST_F(ColourClip, ComparesLumaWhereThePaletteHasItsOwnHues) {
  // On a blue picture in sepia, all strokes would be of another colour.
  const hal::Image blue = plainPicture({60, 110, 190}, kSize);
  std::vector<std::vector<std::uint8_t>> painted;
  for (const char* const clip : {"0", "1"}) {
    Painterly style(library_);
    style.setParameters(
        style.parameters().with("colour_clip", clip).with("palette", "sepia").with("wash", "0"));
    restart();
    painted.push_back(paint(style, next(blue)));
  }
  EXPECT_LT(meanDifference(painted[0], painted[1]), 6.0);
}

}  // namespace
}  // namespace pleinair::styles
