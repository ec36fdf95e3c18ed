#include "pipeline/scene/render/model_hiding.h"

#include <array>
#include <span>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

namespace pleinair::scene {

ModelHiding::ModelHiding(const gpu::ShaderLibrary& library)
    : picture_(library.fragmentPass("pipeline/scene/render/shaders/hide_models.frag")),
      surfaces_(library.fragmentPass("pipeline/scene/render/shaders/hide_surfaces.frag")) {}

void ModelHiding::warmUp() {
  constexpr hal::FrameSize kSize{1, 1};
  const gpu::Texture colour(gpu::TextureFormat::kRgba8, kSize);
  const gpu::Texture normalFocus(gpu::TextureFormat::kRgba8, kSize);
  const gpu::Texture camera(gpu::TextureFormat::kRgba8, kSize);
  const gpu::Texture depth(gpu::TextureFormat::kDepth24, kSize);
  const gpu::Texture front(gpu::TextureFormat::kRgba16f, kSize, gpu::TextureFilter::kLinear);
  const gpu::Texture motion(gpu::TextureFormat::kRgba16f, kSize);
  std::array<gpu::Texture, 4> numbers;
  for (gpu::Texture& each : numbers) each = gpu::Texture(gpu::TextureFormat::kR32ui, kSize);
  const gpu::RenderTarget picture({&colour, &numbers[0], &normalFocus}, &depth);
  const gpu::RenderTarget surfaces({&motion, &numbers[1], &numbers[2], &numbers[3]});
  ArFrame frame{.colour = &colour, .cameraColour = &camera, .hasObjects = true};
  frame.composition = Composition{.picture = &picture, .surfaces = &surfaces};
  const std::array<GLuint, 4> command{3, 1, 0, 0};
  const gpu::Buffer draw = gpu::Buffer::of(std::span<const GLuint>(command));
  hide(frame, {.places = &front, .command = &draw});
}

void ModelHiding::hide(const ArFrame& frame, const ModelCover& before) {
  if (!frame.hasObjects || !frame.composition || frame.cameraColour == nullptr) return;
  const glm::vec2 size(frame.size().width, frame.size().height);
  // Shadows on what is before a model lie beyond the model's own pixels.
  picture_.use()
      .texture("camera", *frame.cameraColour)
      .texture("front", *before.places)
      .set("size", size)
      .drawArea(*frame.composition->picture, {0, 0}, frame.size(), before.command);
  const gpu::RenderTarget* const surfaces = frame.composition->surfaces;
  if (surfaces == nullptr) return;
  const glm::ivec4 bounds(frame.objectBoundsOrAll());
  const glm::ivec2 extent = glm::ivec2(bounds.z, bounds.w) - glm::ivec2(bounds.x, bounds.y);
  if (extent.x <= 0 || extent.y <= 0) return;
  surfaces_.use().texture("front", *before.places).set("size", size);
  surfaces_.drawArea(*surfaces, {bounds.x, bounds.y}, {extent.x, extent.y}, before.command);
}

}  // namespace pleinair::scene
