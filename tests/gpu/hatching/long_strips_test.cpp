// Long strokes: their strips, and the ink that is drawn of them.
#include <numeric>
#include <optional>
#include <random>
#include <span>

#include <gmock/gmock.h>

#include "pipeline/gpu/render_target.h"
#include "pipeline/styles/strokes/brushes.h"
#include "pipeline/styles/strokes/stroke_drawing.h"
#include "tests/gpu/hatching/hatching_fixture.h"

namespace pleinair::styles {
namespace {

constexpr hal::FrameSize kPage{200, 120};

class LongStrips : public HatchingTest {
 protected:
  static DrawnLine line(const std::function<glm::vec2(float)>& place,
                        const std::function<float(float)>& halfWidth) {
    DrawnLine made{};
    for (std::size_t i = 0; i < 16; ++i) {
      const float part = static_cast<float>(i) / 15.0F;
      made.points.at(i) = place(part);
      made.halfWidths.at(i) = halfWidth(part);
      made.halfWidth = std::max(made.halfWidth, made.halfWidths.at(i));
    }
    made.paint = glm::vec4(1.0F);
    return made;
  }
  /// The sum of a line's ink, px².
  double inkOfLine(const DrawnLine& line) {
    double sum = 0.0;
    for (const std::uint8_t each : drawn(line)) sum += each / 255.0;
    return sum;
  }
  /// Lays the line out and draws it; the ink of each pixel, in 1/255.
  /// `grain`: of the brush's own mark; unset: by the program that does not know it.
  std::vector<std::uint8_t> drawn(const DrawnLine& line,
                                  std::optional<float> grain = std::nullopt) {
    const gpu::Buffer instances =
        gpu::Buffer::of(std::span<const DrawnLine>(&line, 1), gpu::BufferUsage::kDynamic);
    const std::array<std::uint32_t, 4> command{0, 1, 0, 0};
    const gpu::Buffer count =
        gpu::Buffer::of(std::span<const std::uint32_t>(command), gpu::BufferUsage::kDynamic);
    StrokeStripMaker maker(library_, StrokeForm::kLong);
    StrokeStrips strips;
    maker.lay(instances, count, StrokeQuads::kCurvature, strips);
    vertices_ = support::readBuffer<std::uint32_t>(strips.commands)[0];
    gpu::Texture ink(gpu::TextureFormat::kRgba8, kPage);
    const gpu::RenderTarget target({&ink});
    target.beginDiscarding();
    target.clearColour(0, glm::vec4(0.0F));
    gpu::Program program = library_.draw(
        "pipeline/styles/hatching/shaders/line.vert", "pipeline/styles/hatching/shaders/line.frag",
        grain ? gpu::ShaderDefines{{"GRAIN"}} : gpu::ShaderDefines{});
    program.use().set("scale", 1.0F).set("fullSize", glm::vec2(kPage.width, kPage.height));
    const gpu::Texture brush = makeBrush(Brush::kPencil, 16);
    if (grain) program.texture("brushes", brush).set("grain", *grain);
    StripDrawing().draw(program, strips, StripPart::kPlain, target);
    const std::vector<std::uint8_t> bytes = bytesOf(ink);
    std::vector<std::uint8_t> alphas;
    for (std::size_t i = 3; i < bytes.size(); i += 4) alphas.push_back(bytes[i]);
    return alphas;
  }
  static std::size_t quadsOf(std::uint32_t vertices) { return (vertices - 4) / 2; }

  std::uint32_t vertices_ = 0;
};

// The ink of a line is its width times its length, also where it is thinner than a pixel.
TEST_F(LongStrips, InkIsWidthTimesLength) {
  for (const float width : {0.2F, 0.6F, 1.0F, 1.7F, 3.0F, 6.0F}) {
    for (const glm::vec2 along : {glm::vec2(150, 0), glm::vec2(130, 61), glm::vec2(33, 90)}) {
      const double found =
          inkOfLine(line([&](float part) { return glm::vec2(20.3F, 12.6F) + part * along; },
                         [&](float) { return 0.5F * width; }));
      EXPECT_NEAR(found / (width * glm::length(along)), 1.0, 0.06) << width << " " << along.x;
      EXPECT_LE(quadsOf(vertices_), 9U);
    }
  }
}

TEST_F(LongStrips, WidthsSwellAlongTheLine) {
  // A spindle: half of the largest width on average.
  const double found =
      inkOfLine(line([](float part) { return glm::vec2(20.0F + 150.0F * part, 60.0F); },
                     [](float part) { return 3.0F * (1.0F - std::abs(2.0F * part - 1.0F)); }));
  EXPECT_NEAR(found / (150.0 * 3.0), 1.0, 0.06);
  EXPECT_GE(quadsOf(vertices_), 9U);
  EXPECT_LE(quadsOf(vertices_), 9U);
}

/// If widths decided where a strip is divided, a little noise would change it at once.
TEST_F(LongStrips, NoiseOfTheWidthIsNotSeen) {
  const auto noisy = [&](unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> noise(-0.01F, 0.01F);
    return drawn(line(
        [](float part) {
          return glm::vec2(20.0F + 150.0F * part, 60.0F + 4.0F * std::sin(4.0F * part));
        },
        [&](float part) { return 0.8F + 0.2F * std::sin(9.0F * part) + noise(random); }));
  };
  const std::vector<std::uint8_t> first = noisy(1);
  int most = 0;
  for (unsigned seed = 2; seed < 12; ++seed) {
    const std::vector<std::uint8_t> other = noisy(seed);
    for (std::size_t i = 0; i < first.size(); ++i)
      most = std::max(most, std::abs(first[i] - other[i]));
  }
  EXPECT_GT(most, 0);
  EXPECT_LE(most, 6);
}

TEST_F(LongStrips, BendWithTheLine) {
  const auto arc = [](float part) {
    const float angle = 3.0F * part;
    return glm::vec2(100.0F + 50.0F * std::cos(angle), 40.0F + 50.0F * std::sin(angle));
  };
  const double found = inkOfLine(line(arc, [](float) { return 1.0F; }));
  EXPECT_NEAR(found / (2.0 * 150.0), 1.0, 0.05);
  EXPECT_GE(quadsOf(vertices_), 7U);
}

TEST_F(LongStrips, NoWidthIsNoInk) {
  EXPECT_EQ(inkOfLine(line([](float part) { return glm::vec2(20.0F + 150.0F * part, 60.0F); },
                           [](float) { return 0.0F; })),
            0.0);
}

TEST_F(LongStrips, GrainIsTheMarkOfTheBrush) {
  const DrawnLine thick = line([](float part) { return glm::vec2(20.0F + 150.0F * part, 60.0F); },
                               [](float) { return 4.0F; });
  const std::vector<std::uint8_t> plain = drawn(thick);
  EXPECT_EQ(drawn(thick, 0.0F), plain);
  const std::vector<std::uint8_t> grainy = drawn(thick, 1.0F);
  EXPECT_LT(std::accumulate(grainy.begin(), grainy.end(), 0),
            0.97 * std::accumulate(plain.begin(), plain.end(), 0));
}

}  // namespace
}  // namespace pleinair::styles
