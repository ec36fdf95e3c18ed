#pragma once

#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "hal/image.h"
#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/handle.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/overlay/line_shapes.h"

namespace pleinair::overlay {

/// A picture on the GPU, RGBA8 with premultiplied alpha. Empty if the image is.
class Sprite {
 public:
  Sprite() = default;
  explicit Sprite(const hal::Image& image);
  hal::FrameSize size() const { return texture_.size(); }
  explicit operator bool() const { return static_cast<bool>(texture_); }
  const gpu::Texture& texture() const { return texture_; }

 private:
  gpu::Texture texture_;
};

/// Draws lines and pictures over a target. All calls on the thread of the GL context that it was
/// made in; allocates nothing after it was made.
class OverlayDrawing {
 public:
  explicit OverlayDrawing(const gpu::ShaderLibrary& library);

  /// `pxScale`: px of the target for each of one 640 px wide.
  void drawLines(const gpu::RenderTarget& target, std::span<const LineShape> shapes, float pxScale,
                 float opacity);
  void drawSprite(const gpu::RenderTarget& target, const Sprite& sprite, glm::ivec2 topLeft,
                  float opacity);
  /// Scaled to that size.
  void drawTexture(const gpu::RenderTarget& target, const gpu::Texture& picture, glm::ivec2 topLeft,
                   hal::FrameSize size, float opacity);

 private:
  struct LineVertex {
    glm::vec2 corner{0.0F};
    glm::vec4 firstPoints{0.0F};
    glm::vec4 lastPoint{0.0F};
  };

  gpu::Program line_;
  gpu::Program sprite_;
  gpu::Buffer lineVertices_;
  gpu::VertexArrayHandle lineArray_;
  gpu::VertexArrayHandle emptyArray_;
  std::vector<LineVertex> gathered_;
};

}  // namespace pleinair::overlay
