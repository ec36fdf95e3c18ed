#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/handle.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/overlay/overlay_content.h"
#include "pipeline/scene/models/model.h"
#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::overlay {

/// Draws the parts of a step by themselves, as if nothing hid them, and their ghosts: where other
/// parts are in front, and where parts go. Parts are at rest (skins and morph targets are not
/// looked at). All calls on the thread of the GL context that it was made in.
class FigureDrawer {
 public:
  FigureDrawer(const gpu::ShaderLibrary& library, hal::FrameSize size);

  /// Takes the parts of another content: those in focus, and the ghosts. Allocates.
  void take(const scene::Model& model, const OverlayContent& content);

  /// Draws them. `phase`: of the ghosts' movement, 0 … 1. `camera`: of images of the given size.
  void draw(const glm::dmat4& cameraFromModel, const tracking::CameraModel& camera, float phase);
  /// RGBA8, of the given size: R 1 where parts in focus are, seen or not; G the shading of ghosts.
  const gpu::Texture& figure() const { return figure_; }

 private:
  struct Vertex {
    glm::vec3 position{0.0F};
    glm::vec3 normal{0.0F};
    glm::vec4 travel{0.0F};
  };
  struct Gathered {
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
  };
  static void gather(const scene::Model& model, std::size_t part, const glm::vec4& travel,
                     Gathered& into);

  gpu::Program program_;
  gpu::Texture figure_;
  gpu::Texture depth_;
  gpu::RenderTarget target_;
  gpu::Buffer vertices_;
  gpu::Buffer indices_;
  gpu::VertexArrayHandle array_;
  std::size_t focusIndices_ = 0;
  std::size_t ghostIndices_ = 0;  ///< after those
  glm::dvec3 middle_{0.0};        ///< of all, in the model's frame
  double reach_ = 0.0;
};

}  // namespace pleinair::overlay
