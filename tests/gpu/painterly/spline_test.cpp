// The geometry of strokes: the spline's points compared with the thesis' formula on the CPU, and
// brushes.
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <span>

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <gmock/gmock.h>

#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/gpu_shaders.h"
#include "pipeline/gpu/handle.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/marks/marks_shaders.h"
#include "pipeline/styles/painterly/painterly_shaders.h"
#include "pipeline/styles/strokes/brushes.h"
#include "pipeline/styles/strokes/strokes_shaders.h"
#include "tests/oracles/stroke_oracle.h"
#include "tests/support/gl_test.h"
#include "tests/support/random_vectors.h"

namespace pleinair::styles {
namespace {

struct Instance {
  std::array<glm::vec2, 8> points;
  glm::vec4 paint{1.0F};
  glm::vec4 shape{4.0F, 0.0F, 0.0F, 0.0F};
};

/// Each vertex of each stroke writes where it would lie into a texel of its own.
constexpr std::array<gpu::EmbeddedShader, 2> kShaders{
    {{"tests/spline_points.vert",
      "#include \"pipeline/styles/strokes/shaders/stroke_spline.glsl\"\n"
      "uniform vec2 texels;\n"
      "flat out vec4 found;\n"
      "void main() {\n"
      "  SplinePlace place = splinePlace();\n"
      "  found = vec4(place.at, place.along);\n"
      "  vec2 texel = vec2(gl_VertexID, gl_InstanceID) + 0.5;\n"
      "  gl_Position = vec4(2.0 * texel / texels - 1.0, 0.0, 1.0);\n"
      "  gl_PointSize = 1.0;\n"
      "}\n"},
     {"tests/spline_points.frag",  // floats as their bits: integers are never rounded
      "flat in vec4 found;\n"
      "layout(location = 0) out uint x;\n"
      "layout(location = 1) out uint y;\n"
      "layout(location = 2) out uint alongX;\n"
      "layout(location = 3) out uint alongY;\n"
      "void main() {\n"
      "  x = floatBitsToUint(found.x);\n"
      "  y = floatBitsToUint(found.y);\n"
      "  alongX = floatBitsToUint(found.z);\n"
      "  alongY = floatBitsToUint(found.w);\n"
      "}\n"}}};

class SplineTest : public support::GlTest {};

TEST_F(SplineTest, PointsAreTheOracles) {
  gpu::ShaderLibrary library;
  library.add(gpu::gpuShaders());
  library.add(gpu::marksShaders());
  library.add(gpu::painterlyShaders());
  library.add(gpu::strokesShaders());
  library.add(kShaders);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> step(-6.0F, 6.0F);
  std::vector<Instance> instances(20);
  for (Instance& each : instances) {
    glm::vec2 at(100.0F + 10.0F * step(random), 100.0F);
    for (glm::vec2& point : each.points) {
      at += glm::vec2(8.0F, 0.0F) + glm::vec2(support::randomVec2(step, random));
      point = at;
    }
  }
  instances[1].points.fill(glm::vec2(50.0F));  // a dab
  gpu::Buffer buffer(instances.size() * sizeof(Instance), gpu::BufferUsage::kDynamic);
  buffer.write(std::as_bytes(std::span(instances)));
  const gpu::VertexArrayHandle vertices = gpu::VertexArrayHandle::make();
  glBindVertexArray(vertices.get());
  for (GLuint i = 0; i < 6; ++i) {
    glVertexAttribFormat(i, 4, GL_FLOAT, GL_FALSE, 16 * i);
    glVertexAttribBinding(i, 0);
    glEnableVertexAttribArray(i);
  }
  glVertexBindingDivisor(0, 1);
  glBindVertexBuffer(0, buffer.name(), 0, sizeof(Instance));
  gpu::Program program = library.draw("tests/spline_points.vert", "tests/spline_points.frag");
  for (const int quads : {1, 8, 36}) {
    const int count = 2 * (quads + 1);
    std::array<gpu::Texture, 4> written;
    for (gpu::Texture& each : written) {
      each = gpu::Texture(gpu::TextureFormat::kR32ui, {count, static_cast<int>(instances.size())});
    }
    const gpu::RenderTarget target({&written[0], &written[1], &written[2], &written[3]});
    program.use()
        .set("quads", static_cast<float>(quads))
        .set("texels", glm::vec2(count, static_cast<float>(instances.size())));
    target.beginKeeping();
    glBindVertexArray(vertices.get());
    glDrawArraysInstanced(GL_POINTS, 0, count, static_cast<GLsizei>(instances.size()));
    glBindVertexArray(0);
    std::array<std::vector<std::uint32_t>, 4> values;
    for (std::size_t k = 0; k < 4; ++k) values.at(k) = support::readR32ui(written.at(k));
    for (std::size_t i = 0; i < instances.size(); ++i) {
      const std::vector<glm::dvec2> points(instances[i].points.begin(), instances[i].points.end());
      for (int v = 0; v < count; ++v) {
        std::array<double, 4> is{};
        for (std::size_t k = 0; k < 4; ++k) {
          is.at(k) = std::bit_cast<float>(
              values.at(k).at(i * static_cast<std::size_t>(count) + static_cast<std::size_t>(v)));
        }
        const double s = 9.0 * (v / 2) / quads;
        const glm::dvec2 at = oracles::splinePlace(points, s);
        EXPECT_LT(glm::distance(at, glm::dvec2(is[0], is[1])), 2e-3) << quads << ": " << v;
        const glm::dvec2 along(is[2], is[3]);
        EXPECT_NEAR(glm::length(along), 1.0, 1e-4);
        if (i == 1 || s < 0.1 || s > 8.9) continue;
        const glm::dvec2 tangent =
            oracles::splinePlace(points, s + 1e-4) - oracles::splinePlace(points, s - 1e-4);
        EXPECT_GT(glm::dot(glm::normalize(tangent), along), 0.9999) << quads << ": " << v;
      }
    }
  }
  EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
}

/// The thesis's 4 (n + 2) quads are one of the numbers that a strip may have: n = 7 gives 36.
TEST(StrokeSpline, TheThesissSamplesAreAmongTheStripss) {
  std::vector<glm::dvec2> points;
  points.reserve(8);
  for (int i = 0; i < 8; ++i) points.emplace_back(i * i, 3.0 * i);
  const std::vector<glm::dvec2> samples = oracles::thesisSplineSamples(points);
  ASSERT_EQ(samples.size(), 37U);
  for (int i = 0; i <= 36; ++i) {
    EXPECT_LT(glm::distance(samples[static_cast<std::size_t>(i)],
                            oracles::splinePlace(points, 9.0 * i / 36)),
              1e-9);
  }
}

class BrushTest : public support::GlTest {};

TEST_F(BrushTest, BrushesDifferAndSoDoTheirVariants) {
  constexpr int kAcross = 16;
  std::vector<std::vector<float>> brushes;
  for (const Brush brush : kBrushes) {
    const gpu::Texture texture = makeBrush(brush, kAcross);
    ASSERT_EQ(texture.size(), (hal::FrameSize{4 * kAcross, kAcross * kBrushVariants}));
    hal::Image image = support::readRgba8(texture);
    std::vector<std::vector<float>> variants(kBrushVariants);
    double middle = 0.0;
    double ends = 0.0;
    for (int y = 0; y < image.size().height; ++y) {
      const auto row = image.row(0, y);
      for (std::size_t x = 0; x < row.size(); x += 4) {
        variants[static_cast<std::size_t>(y / kAcross)].push_back(row[x]);
      }
      ends += row[0] + row[row.size() - 4];
      if (y % kAcross == kAcross / 2) middle += row[row.size() / 2 / 4 * 4];
    }
    EXPECT_LT(ends / (2.0 * image.size().height), 20.0) << "paint ends before its texture does";
    EXPECT_GT(middle / kBrushVariants, 40.0);
    for (std::size_t i = 1; i < variants.size(); ++i) EXPECT_NE(variants[i], variants[0]);
    EXPECT_THAT(brushes, testing::Not(testing::Contains(variants[0])));
    brushes.push_back(variants[0]);
  }
}

}  // namespace
}  // namespace pleinair::styles
