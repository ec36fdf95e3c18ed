// The reduced pictures that strokes take their colours from.
#include "pipeline/styles/painterly/reduced_images.h"

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "pipeline/marks/motion_field.h"
#include "pipeline/marks/movers/motion_layers.h"
#include "tests/gpu/marks/wall_and_disc.h"
#include "tests/gpu/painterly/painterly_fixture.h"

namespace pleinair::styles {
namespace {

constexpr hal::FrameSize kPicture{70, 50};
constexpr int kEdge = 37;  // no multiple of a reduced pixel

/// Red on the left, a green model on the right.
struct TwoParts {
  TwoParts() {
    hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = kPicture});
    std::vector<std::uint32_t> numbers;
    for (int y = 0; y < kPicture.height; ++y) {
      for (int x = 0; x < kPicture.width; ++x) {
        auto* p = image.row(0, y).data() + std::size_t{4} * static_cast<std::size_t>(x);
        p[x < kEdge ? 0 : 1] = 200;
        p[3] = 255;
        numbers.push_back(x < kEdge ? 0U : 1U << 22U);
      }
    }
    picture = support::textureOf(image.view());
    ids = gpu::Texture(gpu::TextureFormat::kR32ui, kPicture);
    ids.upload({reinterpret_cast<const std::uint8_t*>(numbers.data()), numbers.size() * 4},
               std::size_t{kPicture.width} * 4);
  }
  scene::ArFrame frame(bool hasObjects) const {
    return {.colour = &picture, .ids = &ids, .hasObjects = hasObjects, .fullSize = kPicture};
  }
  gpu::Texture picture;
  gpu::Texture ids;
};

TEST_F(PainterlyTest, ReducedImagesMixNoModelIntoTheBackground) {
  const TwoParts parts;
  ReducedImages reduced(library_);
  reduced.update(parts.frame(true));
  for (const double px : {2.0, 4.0, 8.0, 16.0, 32.0}) {
    SCOPED_TRACE(px);
    const marks::StrokePaint paint = reduced.paintOf(px);
    EXPECT_EQ(paint.movers, paint.background) << "nothing is a mover";
    const auto expectPure = [&](const gpu::Texture& texture, std::size_t channel) {
      const std::vector<float> texels = support::readRgba32f(texture);
      double share = 0.0;
      for (std::size_t i = 0; i < texels.size(); i += 4) {
        share += texels[i + 3] / static_cast<double>(texture.size().pixels());
        if (texels[i + 3] < 1e-3F) continue;
        EXPECT_NEAR(texels[i + channel] / texels[i + 3], 200.0 / 255.0, 0.01);
        EXPECT_LT(texels[i + 1 - channel], 1e-3F);
      }
      return share;
    };
    const double background = expectPure(*paint.background, 0);
    const double models = expectPure(*paint.models, 1);
    EXPECT_NEAR(background + models, 1.0, 0.01) << "each pixel is of one of them";
    if (px <= 4.0) {
      EXPECT_NEAR(background, double{kEdge} / kPicture.width, 0.03);
    }
  }
}

/// An orange disc has come before a grey wall.
TEST_F(PainterlyTest, ReducedImagesMixNoMoverIntoTheBackground) {
  const marks::View wall{.noiseSigma = 1.0};
  const marks::View disc{.noiseSigma = 1.0, .disc = {90.0, 70.0}, .radius = 40.0};
  marks::MotionField motion(library_, kSize);
  marks::MotionLayers layers(library_, kSize);
  ReducedImages reduced(library_);
  for (int i = 0; i < 5; ++i) {
    const hal::Image image = marks::seen(i < 3 ? wall : disc, kSize, static_cast<unsigned>(i + 1));
    const scene::ArFrame frame = next(image);
    motion.update(frame);
    layers.update(frame, motion);
    reduced.update(frame, &layers);
  }
  const marks::StrokePaint paint = reduced.paintOf(4.0);
  // The mean of red less blue, and the share of the picture.
  const auto meanOf = [](const gpu::Texture& texture) {
    const std::vector<float> texels = support::readRgba32f(texture);
    double orange = 0.0;
    double share = 0.0;
    for (std::size_t i = 0; i < texels.size(); i += 4) {
      orange += static_cast<double>(texels[i] - texels[i + 2]);
      share += static_cast<double>(texels[i + 3]);
    }
    return std::pair(orange / share, share / static_cast<double>(texture.size().pixels()));
  };
  const auto [background, backgroundShare] = meanOf(*paint.background);
  const auto [mover, moverShare] = meanOf(*paint.movers);
  EXPECT_NEAR(moverShare, std::numbers::pi * 40.0 * 40.0 / (192.0 * 144.0), 0.02);
  EXPECT_NEAR(backgroundShare + moverShare, 1.0, 0.01);
  EXPECT_LT(background, 0.02) << "without labels it were 0.16";
  EXPECT_GT(mover, 0.8);
}

TEST_F(PainterlyTest, ReducedImagesWithoutModelsAreMeans) {
  const TwoParts parts;
  ReducedImages reduced(library_);
  reduced.update(parts.frame(false));
  EXPECT_EQ(reduced.paintOf(1.5).background, &parts.picture);
  const marks::StrokePaint paint = reduced.paintOf(9.0);
  EXPECT_EQ(paint.background, paint.models);
  EXPECT_EQ(paint.background, &reduced.whole(3));
  EXPECT_EQ(paint.background->size(), (hal::FrameSize{kPicture.width / 8, kPicture.height / 8}));
  const hal::Image mean = support::readRgba8(*paint.background);
  double red = 0.0;
  for (std::size_t x = 0; x < 8; ++x) red += mean.view().row(0, 2)[4 * x] / (8.0 * 200.0);
  EXPECT_NEAR(red, double{kEdge} / kPicture.width, 0.1);
  EXPECT_EQ(mean.view().row(0, 2)[0], 200);
}

}  // namespace
}  // namespace pleinair::styles
