#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "pipeline/marks/marks_shaders.h"
#include "pipeline/styles/painterly/painterly_shaders.h"
#include "pipeline/styles/strokes/stroke_strips.h"
#include "pipeline/styles/strokes/strokes_shaders.h"
#include "tests/support/gl_test.h"

namespace pleinair::styles {

/// A stroke as marks::StrokeSet lays it out.
struct LaidStroke {
  std::array<glm::vec2, 8> points;
  glm::vec4 paint{1.0F};
  float halfWidth = 4.0F;
  float variant = 0.0F;  // 4 more where it is mirrored
  float label = 0.0F;
  float age = 0.0F;
};
static_assert(sizeof(LaidStroke) == marks::StrokeSet::kInstanceBytes);

/// Its side fades out over a pixel.
inline float drawnHalfWidth(const LaidStroke& stroke) {
  return stroke.halfWidth + 0.75F;
}

/// Its points evenly from one place to another.
inline LaidStroke straightStroke(glm::vec2 from, glm::vec2 to) {
  LaidStroke stroke;
  for (std::size_t i = 0; i < 8; ++i) {
    const float part = static_cast<float>(i) / 7.0F;
    stroke.points.at(i) = from + part * (to - from);
  }
  return stroke;
}

/// A vertex of shaders/stroke_strips.comp.
struct StripVertex {
  glm::vec2 at;
  std::array<std::uint16_t, 2> brush;
  std::array<std::int16_t, 2> along;
  std::array<std::uint16_t, 4> paint;
  std::array<std::uint16_t, 2> shape;
  std::uint32_t label;
};
static_assert(sizeof(StripVertex) == StrokeStrips::kVertexBytes);

/// Strokes that a test lays out by hand.
class StripTest : public support::GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    if (IsSkipped()) return;
    library_.add(gpu::marksShaders());
    library_.add(gpu::painterlyShaders());
    library_.add(gpu::strokesShaders());
    maker_.emplace(library_);
  }

  /// Fills strips_; slots are more than there are strokes.
  void lay(const std::vector<LaidStroke>& strokes, StrokeQuads quads = StrokeQuads::kCurvature,
           const StripClipping& clipping = {}) {
    layInSlots(3 * strokes.size() + 5, strokes, quads, clipping);
  }
  void layInSlots(std::size_t slotCount, const std::vector<LaidStroke>& strokes,
                  StrokeQuads quads = StrokeQuads::kCurvature, const StripClipping& clipping = {}) {
    std::vector<LaidStroke> slots = strokes;
    slots.resize(slotCount);
    const auto instances =
        gpu::Buffer::of(std::span<const LaidStroke>(slots), gpu::BufferUsage::kDynamic);
    const std::array<std::uint32_t, 4> command{0, static_cast<std::uint32_t>(strokes.size()), 0, 0};
    const auto drawn =
        gpu::Buffer::of(std::span<const std::uint32_t>(command), gpu::BufferUsage::kDynamic);
    maker_->lay(instances, drawn, quads, strips_, clipping);
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
  }
  std::vector<StripVertex> vertices() const {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    auto all = support::readBuffer<StripVertex>(strips_.vertices);
    const auto commands = support::readBuffer<std::uint32_t>(strips_.commands);
    std::size_t count = 0;
    for (std::size_t part = 0; part < kStripParts; ++part) {
      EXPECT_EQ(commands[4 * part + 1], 1U);
      EXPECT_EQ(commands[4 * part + 2], part == 2 ? count : 0U);
      count += commands[4 * part];
    }
    EXPECT_LE(count, all.size());
    all.resize(count);
    return all;
  }

  gpu::ShaderLibrary library_;
  std::optional<StrokeStripMaker> maker_;
  StrokeStrips strips_;
};

}  // namespace pleinair::styles
