#include "pipeline/scene/render/surface_pass.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/geometric.hpp>

#include "pipeline/scene/render/ar_frame.h"
#include "pipeline/scene/render/scene_bodies.h"
#include "pipeline/scene/render/scene_uniforms.h"

namespace pleinair::scene {
namespace {

using SquareRoot = std::array<std::array<double, 6>, 6>;

/// The lower triangle L with L Lᵀ = a + b (Cholesky); a direction without variance gets zeros.
SquareRoot squareRootOfSum(const tracking::PoseCovariance& a, const tracking::PoseCovariance& b) {
  SquareRoot root{};
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = a[6 * i + j] + b[6 * i + j];
      for (std::size_t k = 0; k < j; ++k) sum -= root[i][k] * root[j][k];
      if (i == j) {
        root[i][i] = std::sqrt(std::max(sum, 0.0));
      } else {
        root[i][j] = root[j][j] > 0.0 ? sum / root[j][j] : 0.0;
      }
    }
  }
  return root;
}

std::array<glm::vec4, 3> rowsOf(const glm::dmat4& m) {
  std::array<glm::vec4, 3> rows{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<int>(i);
    rows[i] = glm::vec4(m[0][row], m[1][row], m[2][row], m[3][row]);
  }
  return rows;
}

}  // namespace

SurfacePass::SurfacePass(const gpu::ShaderLibrary& library, const Scene& scene,
                         const PosedGeometry& geometry)
    : scene_(scene), geometry_(geometry) {
  static_assert(sizeof(GpuBody) % gpu::kUniformAlignment == 0);
  static_assert(sizeof(GpuBody) == SurfaceAccess::kBodyBytes);
  if (!scene.models.empty())
    surface_ = library.compute("pipeline/scene/render/shaders/surface.comp");
  if (std::ranges::any_of(scene.models, &SceneModel::isOccluder)) {
    realSurface_ = library.compute("pipeline/scene/render/shaders/surface.comp", {{"REAL"}});
  }
  if (!scene.planes.empty())
    planes_ = library.compute("pipeline/scene/render/shaders/plane_motion.comp");
  assert(!scene.planes.empty() || !scene.models.empty());
  staged_.resize(kMaxPlanes + scene.models.size());  // a block has room for all planes
  bodies_ = gpu::Buffer(std::span(staged_).size_bytes(), gpu::BufferUsage::kDynamic);
}

SurfacePass::Buffers::Buffers(hal::FrameSize size)
    : motion(gpu::TextureFormat::kRgba16f, size),
      barycentrics(gpu::TextureFormat::kR32ui, size),
      parts(gpu::TextureFormat::kR32ui, size),
      forms(gpu::TextureFormat::kR32ui, size),
      target({&motion, &barycentrics, &parts, &forms}),
      written{{0, 0}, {size.width, size.height}} {}

SurfacePass::GpuBody SurfacePass::gpuBody(const Body& body) {
  GpuBody made;
  if (!body.current) return made;
  made.current = rowsOf(body.current->cameraFromBody);
  if (!body.previous) return made;
  made.previous = rowsOf(body.previous->cameraFromBody);
  made.turnsAbout = glm::vec4(body.current->attachment.turnsAbout, 1.0F);
  // The errors of both poses move the pixel; the earlier one's acts nearly as the later one's.
  const SquareRoot root =
      squareRootOfSum(body.current->attachment.covariance, body.previous->attachment.covariance);
  for (std::size_t k = 0; k < 6; ++k) {
    made.errorTurns[k] = glm::vec4(root[0][k], root[1][k], root[2][k], 0.0F);
    made.errorShifts[k] = glm::vec4(root[3][k], root[4][k], root[5][k], 0.0F);
  }
  return made;
}

void SurfacePass::writeBodies(const SceneBodies& bodies, std::span<const std::size_t> drawn) {
  for (std::size_t i = 0; i < scene_.planes.size(); ++i) {
    GpuBody& plane = staged_[i];
    plane = gpuBody(bodies.plane(i));
    if (bodies.plane(i).current)
      plane.extent = glm::vec4(0.5 * scene_.planes[i].sizeMetres, 0.0, 0.0);
  }
  for (std::size_t i = 0; i < scene_.models.size(); ++i) {
    GpuBody& model = staged_[kMaxPlanes + i];
    model = gpuBody(bodies.model(i));
    const ObjectPlace place = geometry_.place(i);
    if (!place.firstPrevious) model.turnsAbout.w = 0.0F;
    model.places = {place.firstTriangle, place.firstCurrent, place.firstPrevious.value_or(0), 0};
  }
  for (const std::size_t i : drawn) staged_[kMaxPlanes + i].places.w = 1;
  bodies_.write(std::as_bytes(std::span(staged_)));
}

ScreenArea SurfacePass::areaOfModel(std::size_t index, const Body& body,
                                    const tracking::CameraModel& camera) const {
  const glm::dmat4 cameraFromModel = body.current ? body.current->cameraFromBody : glm::dmat4(1.0);
  const double scale = glm::length(glm::dvec3(cameraFromModel[0]));
  ScreenArea area;
  for (const BoundingSphere& sphere : geometry_.spheres(index)) {
    const glm::dvec3 centre(cameraFromModel * glm::dvec4(sphere.centre, 1.0));
    const double radius = scale * sphere.radiusMetres;
    if (centre.z + radius <= 0.0) continue;  // behind the camera
    area = unionOf(area, areaAround({.centre = centre, .radiusMetres = radius}, camera));
  }
  return area;
}

ScreenArea SurfacePass::areaOfPlanes(const SceneBodies& bodies,
                                     const tracking::CameraModel& camera) const {
  ScreenArea area;
  for (std::size_t i = 0; i < scene_.planes.size(); ++i) {
    const auto& current = bodies.plane(i).current;
    if (!current) continue;
    const glm::dvec2 half = 0.5 * scene_.planes[i].sizeMetres;
    std::array<glm::dvec3, 4> corners{};
    for (unsigned c = 0; c < 4; ++c) {
      const glm::dvec4 corner((c & 1U) != 0 ? half.x : -half.x, (c & 2U) != 0 ? half.y : -half.y,
                              0.0, 1.0);
      corners[c] = glm::dvec3(current->cameraFromBody * corner);
    }
    area = unionOf(area, areaAround(corners, camera));
  }
  return area;
}

gpu::Program& SurfacePass::begin(gpu::Program& program, const gpu::Texture& ids,
                                 const tracking::CameraModel& camera, const ScreenArea& area) {
  const tracking::Intrinsics& pinhole = camera.intrinsics();
  program.use()
      .texture("ids", ids)
      .set("focal", glm::vec2(pinhole.fx, pinhole.fy))
      .set("centre", glm::vec2(pinhole.cx, pinhole.cy))
      .set("origin", area.origin)
      .set("size", area.size);
  setLens(program, camera);
  return program;
}

void SurfacePass::runPlanes(const gpu::Texture& ids, const tracking::CameraModel& camera,
                            const ScreenArea& area, const Buffers& buffers) {
  begin(planes_, ids, camera, area)
      .uniformBlock("Planes", bodies_, 0, kMaxPlanes * sizeof(GpuBody))
      .set("planeCount", static_cast<int>(scene_.planes.size()))
      .image("motion", buffers.motion, gpu::ImageAccess::kWrite)
      .dispatch(area.size, 0);
}

void SurfacePass::runModel(gpu::Program& program, std::size_t index, const gpu::Texture& ids,
                           const tracking::CameraModel& camera, const ScreenArea& area,
                           const Buffers& buffers) {
  begin(program, ids, camera, area)
      .uniformBlock("OneBody", bodies_, (kMaxPlanes + index) * sizeof(GpuBody), sizeof(GpuBody))
      .storage("Posed", geometry_.posed())
      .storage("Triangles", geometry_.triangles())
      .storage("Forms", geometry_.forms())
      .image("motion", buffers.motion, gpu::ImageAccess::kWrite)
      .image("barycentrics", buffers.barycentrics, gpu::ImageAccess::kWrite)
      .image("parts", buffers.parts, gpu::ImageAccess::kWrite)
      .image("forms", buffers.forms, gpu::ImageAccess::kWrite)
      .set("object", objectId(scene_, index))
      .dispatch(area.size, 0);
}

/// Clears only the written area: clearing a whole image costs as much as drawing a model.
void SurfacePass::clear(Buffers& buffers) {
  if (buffers.written.isEmpty()) return;
  buffers.target.beginKeeping();
  glEnable(GL_SCISSOR_TEST);
  glScissor(buffers.written.origin.x, buffers.written.origin.y, buffers.written.size.x,
            buffers.written.size.y);
  buffers.target.clearColour(0, glm::vec4(0.0F));
  buffers.target.clearUnsigned(1, glm::uvec4(0U));
  buffers.target.clearUnsigned(2, glm::uvec4(0U));
  buffers.target.clearUnsigned(3, glm::uvec4(0U));
  glDisable(GL_SCISSOR_TEST);
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);  // compute writes come after the clear
  buffers.written = {};
  buffers.objects = {};
}

void SurfacePass::run(const gpu::Texture& ids, const tracking::CameraModel& camera,
                      const SceneBodies& bodies, std::span<const std::size_t> models,
                      Buffers& buffers) {
  assert(ids.size() == camera.imageSize() && buffers.motion.size() == ids.size());
  clear(buffers);
  writeBodies(bodies, models);
  if (const ScreenArea area = areaOfPlanes(bodies, camera); !area.isEmpty()) {
    buffers.written = unionOf(buffers.written, area);
    runPlanes(ids, camera, area, buffers);
  }
  for (const std::size_t i : models) {
    const ScreenArea area = areaOfModel(i, bodies.model(i), camera);
    if (area.isEmpty() || geometry_.batches(i).empty()) continue;
    buffers.objects = unionOf(buffers.objects, area);
    runModel(scene_.models[i].isOccluder ? realSurface_ : surface_, i, ids, camera, area, buffers);
  }
  buffers.written = unionOf(buffers.written, buffers.objects);
  // for later readers, and for the next frame's clear()
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                  GL_FRAMEBUFFER_BARRIER_BIT);
}

void SurfacePass::warmUp(const gpu::Texture& ids, const tracking::CameraModel& camera,
                         const SceneBodies& bodies, Buffers& buffers) {
  clear(buffers);
  writeBodies(bodies, {});
  constexpr ScreenArea kCorner{{0, 0}, {1, 1}};
  buffers.written = kCorner;
  if (planes_) runPlanes(ids, camera, kCorner, buffers);
  if (geometry_.isEmpty()) return;
  for (gpu::Program* program : {&surface_, &realSurface_}) {
    if (*program) runModel(*program, 0, ids, camera, kCorner, buffers);
  }
}

}  // namespace pleinair::scene
