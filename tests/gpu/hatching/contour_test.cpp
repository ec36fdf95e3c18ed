// Contour lines against a CPU version of the difference of Gaussians, and where they are drawn.
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <gmock/gmock.h>

#include "pipeline/gpu/render_target.h"
#include "tests/gpu/hatching/hatching_fixture.h"

namespace pleinair::styles {
namespace {

class ContourTest : public HatchingTest {
 protected:
  /// Of a view, the red of a row.
  std::vector<double> rowOf(const hal::Image& image, std::string_view view, int y,
                            const char* inverted = "false") {
    Hatching style(library_);
    set(style, {{"inverted", inverted}});
    restart();
    const auto bytes = paint(style, next(image), view);
    std::vector<double> row;
    for (int x = 0; x < kSize.width; ++x) {
      row.push_back(bytes[static_cast<std::size_t>(y * kSize.width + x) * 4] / 255.0);
    }
    return row;
  }
  /// An edge, dark on the left.
  static hal::Image edge() {
    return imageOf(kSize, [](int x, int) { return 0.5 + 0.4 * std::tanh(x - 95.5); });
  }
};

TEST_F(ContourTest, EdgesAreTheOracles) {
  const std::vector<double> row = rowOf(edge(), "edges", 72);
  const double step = std::max(0.8, scaleOf(kSize));
  const auto lumaAt = [](double x) {
    const auto exactly = [](double at) {
      return std::round((0.5 + 0.4 * std::tanh(at - 95.5)) * 255.0) / 255.0;
    };
    const double left = std::floor(x);
    return exactly(left) + (x - left) * (exactly(left + 1.0) - exactly(left));
  };
  const auto gaussian = [](double i, double sigma) {
    return std::exp(-0.5 * i * i / sigma / sigma);
  };
  double most = 0.0;
  for (int x = 60; x < 130; ++x) {
    double narrow = 0.0;
    double wide = 0.0;
    double narrowSum = 0.0;
    double wideSum = 0.0;
    for (int i = -4; i <= 4; ++i) {
      const double luma = lumaAt(x + i * step);
      narrow += gaussian(i, 1.0) * luma;
      wide += gaussian(i, 1.6) * luma;
      narrowSum += gaussian(i, 1.0);
      wideSum += gaussian(i, 1.6);
    }
    const double difference = narrow / narrowSum - wide / wideSum;
    most = std::max(most, std::abs(difference));
    EXPECT_NEAR(row[static_cast<std::size_t>(x)], 0.5 + 8.0 * difference, 0.01) << x;
  }
  EXPECT_GT(most, 0.02);
}

TEST_F(ContourTest, LinesLieOnTheDarkSideAndInInvertedLooksOnTheLightOne) {
  const std::vector<double> dark = rowOf(edge(), "contours", 72);
  const std::vector<double> light = rowOf(edge(), "contours", 72, "true");
  for (std::size_t x = 20; x < 170; ++x) {
    const bool isLeft = x < 96;
    const bool isNear = x >= 88 && x <= 103;
    if (!isNear || !isLeft) {
      EXPECT_EQ(dark[x], 1.0) << x;
    }
    if (!isNear || isLeft) {
      EXPECT_EQ(light[x], 1.0) << x;
    }
  }
  EXPECT_LT(*std::ranges::min_element(dark), 0.2);
  EXPECT_LT(*std::ranges::min_element(light), 0.2);
}

TEST_F(ContourTest, NoiseGivesNone) {
  Hatching style(library_);
  std::mt19937 random(3);
  const hal::Image noise = imageOf(
      kSize, [&](int, int) { return 0.5 + (static_cast<double>(random() % 9U) - 4.0) / 255.0; });
  const auto bytes = paint(style, next(noise), "contours");
  for (std::size_t i = 0; i < bytes.size(); i += 4) ASSERT_GT(bytes[i], 200U);
}

/// A label ends in the middle of the picture, and what is behind was never seen.
TEST_F(ContourTest, AMoversLabelThatEndsWithinAThingHasNoOutline) {
  const auto inkAlongTheBorder = [&](const std::array<std::uint8_t, 3>& right) {
    hal::Image image = flat(0.5);
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = kSize.width / 2; x < kSize.width; ++x) {
        std::ranges::copy(right, image.row(0, y).data() + static_cast<std::ptrdiff_t>(4) * x);
      }
    }
    const gpu::Texture picture = support::textureOf(image.view());
    const hal::FrameSize cells{kSize.width / 2, kSize.height / 2};
    hal::Image labels({.pixelFormat = hal::PixelFormat::kRgba8, .size = cells});
    for (int y = 0; y < cells.height; ++y) {
      std::fill_n(labels.row(0, y).data(), 2 * cells.width, std::uint8_t{255});
    }
    const gpu::Texture movers = support::textureOf(labels.view());
    gpu::Texture none(gpu::TextureFormat::kRgba8, {1, 1}, gpu::TextureFilter::kLinear);
    none.upload(std::array<std::uint8_t, 4>{}, 4);
    const gpu::Texture noForms(gpu::TextureFormat::kR32ui, {1, 1});
    gpu::Texture made(gpu::TextureFormat::kRgba8, kSize);
    const gpu::RenderTarget target({&made});
    gpu::Program pass = library_.fragmentPass("pipeline/styles/hatching/shaders/contours.frag", {},
                                              {gpu::TextureFormat::kRgba8});
    pass.use()
        .texture("edges", none)
        .texture("picture", picture)
        .texture("background", none)
        .texture("movers", movers)
        .texture("field", none)
        .texture("modelField", none)
        .texture("moverField", none)
        .texture("forms", noForms)
        .set("hasForms", 0)
        .set("fieldScale", glm::vec2(1.0F))
        .set("size", glm::vec2(kSize.width, kSize.height))
        .set("pixelsOfFull", glm::vec2(1.0F))
        .set("step_", 1.0F)
        .set("threshold", 0.018F)
        .set("sign_", -1.0F)
        .drawFullscreen(target);
    const std::vector<std::uint8_t> ink = bytesOf(made);
    int most = 0;
    for (int x = kSize.width / 2 - 6; x < kSize.width / 2 + 6; ++x) {
      most = std::max<int>(most, ink[4U * static_cast<std::size_t>(72 * kSize.width + x)]);
    }
    return most;
  };
  EXPECT_EQ(inkAlongTheBorder({128, 128, 128}), 0);
  EXPECT_GT(inkAlongTheBorder({215, 102, 128}), 80) << "the control: of the same luma";
}

TEST_F(ContourTest, ModelsHaveSilhouettesPartBordersAndCreases) {
  // A model from x = 60 to 130: two parts, the second with a crease in its middle.
  std::vector<std::uint32_t> ids;
  std::vector<std::uint32_t> parts;
  hal::Image normals({.pixelFormat = hal::PixelFormat::kRgba8, .size = kSize});
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const bool isModel = x >= 60 && x < 130;
      ids.push_back(isModel ? 1U << scene::kTriangleBits : 0U);
      parts.push_back(isModel ? 1U << scene::kTriangleBits | (x < 90 ? 0U : 1U) : 0U);
      auto* p = normals.row(0, y).data() + static_cast<std::ptrdiff_t>(x) * 4;
      p[0] = x < 110 ? 128 : 255;
      p[1] = 128;
      p[2] = x < 110 ? 255 : 128;
      p[3] = 0;
    }
  }
  const std::size_t stride = static_cast<std::size_t>(kSize.width) * 4;
  const auto textureOf = [&](const std::vector<std::uint32_t>& words) {
    gpu::Texture texture(gpu::TextureFormat::kR32ui, kSize);
    texture.upload({reinterpret_cast<const std::uint8_t*>(words.data()), words.size() * 4}, stride);
    return texture;
  };
  const gpu::Texture idTexture = textureOf(ids);
  std::vector<std::uint32_t> forms;  // labels without directions
  for (std::size_t i = 0; i < ids.size(); ++i) {
    forms.push_back(ids[i] == 0U ? 0U : 1U + (parts[i] & 1U));
  }
  const gpu::Texture formTexture = textureOf(forms);
  const gpu::Texture partTexture = textureOf(parts);
  const gpu::Texture normalTexture = support::textureOf(normals.view());
  Hatching style(library_);
  scene::ArFrame frame = next(flat(0.5));
  frame.hasObjects = true;
  frame.ids = &idTexture;
  frame.barycentrics = &idTexture;
  frame.forms = &formTexture;
  frame.parts = &partTexture;
  frame.normalFocus = &normalTexture;
  const auto bytes = paint(style, frame, "contours");
  for (std::size_t x = 5; x < 187; ++x) {
    const int ink = 255 - bytes[(std::size_t{72} * 192 + x) * 4];
    const bool isSilhouette = x == 59 || x == 60 || x == 129 || x == 130;
    const bool isInner = x == 89 || x == 109;
    if (isSilhouette) {
      EXPECT_GT(ink, 200) << x;
    } else if (isInner) {
      EXPECT_GT(ink, 150) << x;
      EXPECT_LT(ink, 200) << x;
    } else {
      EXPECT_EQ(ink, 0) << x;
    }
  }
}

}  // namespace
}  // namespace pleinair::styles
