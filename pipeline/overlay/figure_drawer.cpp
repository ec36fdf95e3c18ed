#include "pipeline/overlay/figure_drawer.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "pipeline/scene/models/mesh.h"
#include "pipeline/scene/render/scene_uniforms.h"

namespace pleinair::overlay {
namespace {

constexpr double kNearestMetres = 0.005;
constexpr int kFigureAttributes = 3;

float wayOf(const Ghost& ghost) {
  if (ghost.stays) return 2.0F;
  return ghost.comesHome ? 1.0F : 0.0F;
}

}  // namespace

FigureDrawer::FigureDrawer(const gpu::ShaderLibrary& library, hal::FrameSize size)
    : program_(library.draw("pipeline/overlay/shaders/figure.vert",
                            "pipeline/overlay/shaders/figure.frag")),
      figure_(gpu::TextureFormat::kRgba8, size),
      depth_(gpu::TextureFormat::kDepth24, size),
      target_({&figure_}, &depth_),
      array_(gpu::VertexArrayHandle::make()) {
  glBindVertexArray(array_.get());
  glVertexAttribFormat(0, 3, GL_FLOAT, GL_FALSE, offsetof(Vertex, position));
  glVertexAttribFormat(1, 3, GL_FLOAT, GL_FALSE, offsetof(Vertex, normal));
  glVertexAttribFormat(2, 4, GL_FLOAT, GL_FALSE, offsetof(Vertex, travel));
  for (GLuint i = 0; i < kFigureAttributes; ++i) {
    glVertexAttribBinding(i, 0);
    glEnableVertexAttribArray(i);
  }
  glBindVertexArray(0);
}

void FigureDrawer::gather(const scene::Model& model, std::size_t index, const glm::vec4& travel,
                          Gathered& into) {
  const scene::ModelPart& part = model.parts[index];
  const glm::dmat3 normals = scene::normalsAlong(glm::dmat3(part.modelFromPart));
  for (std::size_t i = 0; i < part.surfaceCount; ++i) {
    const scene::Mesh& mesh = model.surfaces[part.firstSurface + i].mesh;
    const auto first = static_cast<std::uint32_t>(into.vertices.size());
    for (const scene::MeshVertex& each : mesh.vertices) {
      const glm::dvec4 at = part.modelFromPart * glm::dvec4(glm::dvec3(each.position), 1.0);
      into.vertices.push_back({.position = glm::vec3(at),
                               .normal = glm::vec3(normals * glm::dvec3(each.normal)),
                               .travel = travel});
    }
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t corner : triangle) into.indices.push_back(first + corner);
    }
  }
}

void FigureDrawer::take(const scene::Model& model, const OverlayContent& content) {
  Gathered all;
  for (std::size_t i = 0; i < content.looks.size(); ++i) {
    const PartLook look = content.looks[i];
    if (look == PartLook::kFocus || look == PartLook::kTint || look == PartLook::kOutline) {
      gather(model, i, glm::vec4(0.0F), all);
    }
  }
  focusIndices_ = all.indices.size();
  for (const Ghost& ghost : content.ghosts) {
    gather(model, ghost.part, {glm::vec3(ghost.apartMetres), wayOf(ghost)}, all);
  }
  ghostIndices_ = all.indices.size() - focusIndices_;
  if (all.indices.empty()) return;
  vertices_ = gpu::Buffer::of(std::span<const Vertex>(all.vertices));
  indices_ = gpu::Buffer::of(std::span<const std::uint32_t>(all.indices));
  glm::dvec3 low(all.vertices.front().position);
  glm::dvec3 high(low);
  for (const Vertex& each : all.vertices) {
    for (const glm::vec3& at : {each.position, each.position + glm::vec3(each.travel)}) {
      low = glm::min(low, glm::dvec3(at));
      high = glm::max(high, glm::dvec3(at));
    }
  }
  middle_ = 0.5 * (low + high);
  reach_ = 0.5 * glm::length(high - low);
}

void FigureDrawer::draw(const glm::dmat4& cameraFromModel, const tracking::CameraModel& camera,
                        float phase) {
  target_.beginDiscarding();
  target_.clearColour(0, glm::vec4(0.0F));
  target_.clearDepth();
  if (focusIndices_ + ghostIndices_ > 0) {
    const double reach = reach_ * scene::largestScale(cameraFromModel);
    const double z = (cameraFromModel * glm::dvec4(middle_, 1.0)).z;
    const double far = std::max(z + reach, 2.0 * kNearestMetres) * 1.001;
    const double near = std::max({z - reach, kNearestMetres, far / 1000.0}) * 0.999;
    const glm::dvec2 size(camera.imageSize().width, camera.imageSize().height);
    const tracking::Intrinsics& pinhole = camera.intrinsics();
    program_.use()
        .set("cameraFromModel", glm::mat4(cameraFromModel))
        .set("clipFocal", glm::vec2(2.0 * glm::dvec2(pinhole.fx, pinhole.fy) / size))
        .set("clipCentre", glm::vec2(2.0 * glm::dvec2(pinhole.cx, pinhole.cy) / size - 1.0))
        .set("clipDepth", glm::vec2((far + near) / (far - near), -2.0 * far * near / (far - near)))
        .set("phase", phase);
    scene::setLens(program_, camera);
    glBindVertexArray(array_.get());
    glBindVertexBuffer(0, vertices_.name(), 0, sizeof(Vertex));
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
    const gpu::PassTimer::Scope scope = program_.measure();
    const auto drawRange = [&](std::size_t first, std::size_t count) {
      if (count == 0) return;
      glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(count), GL_UNSIGNED_INT,
                     reinterpret_cast<const void*>(first * sizeof(std::uint32_t)));
    };
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);  // a mask has no depth
    glColorMask(GL_TRUE, GL_FALSE, GL_FALSE, GL_FALSE);
    drawRange(0, focusIndices_);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_FALSE);
    drawRange(focusIndices_, ghostIndices_);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(0);
  }
  target_.discardDepth();
}

}  // namespace pleinair::overlay
