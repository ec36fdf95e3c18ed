#include "pipeline/scene/surface_pass.h"

#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/geometric.hpp>

#include "pipeline/scene/lens_uniforms.h"

namespace pleinair::scene {
namespace {

using SquareRoot = std::array<std::array<double, 6>, 6>;

/// The lower triangle L with L Lᵀ = a + b (Cholesky); a direction without variance stays without.
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
  std::array<glm::vec4, 3> rows;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<int>(i);
    rows[i] = glm::vec4(m[0][row], m[1][row], m[2][row], m[3][row]);
  }
  return rows;
}

}  // namespace

SurfacePass::SurfacePass(const gpu::ShaderLibrary& library, const Scene& scene,
                         const PosedGeometry& geometry)
    : scene_(scene),
      geometry_(geometry),
      program_(library.compute("pipeline/scene/shaders/surface.comp")),
      nothing_(sizeof(glm::vec4), gpu::BufferUsage::kStatic) {
  static_assert(sizeof(GpuBody) == 21 * sizeof(glm::vec4));
  const std::size_t bodies = scene.planes.size() + scene.models.size();
  assert(bodies > 0);
  staged_.resize(bodies);
  bodies_ = gpu::Buffer(std::span(staged_).size_bytes(), gpu::BufferUsage::kDynamic);
}

SurfacePass::Buffers SurfacePass::makeBuffers(hal::FrameSize size) {
  return {.motion = gpu::Texture(gpu::TextureFormat::kRgba16f, size),
          .barycentrics = gpu::Texture(gpu::TextureFormat::kR32ui, size),
          .parts = gpu::Texture(gpu::TextureFormat::kR32ui, size)};
}

SurfacePass::GpuBody SurfacePass::gpuBody(const Body& body) {
  GpuBody made;
  if (!body.now) return made;
  made.now = rowsOf(body.now->cameraFromBody);
  if (!body.then) return made;
  made.then = rowsOf(body.then->cameraFromBody);
  made.turnsAbout = glm::vec4(body.now->attachment.turnsAbout, 1.0F);
  // Both poses' errors move the pixel, the earlier one's very nearly as the later one's.
  const SquareRoot root =
      squareRootOfSum(body.now->attachment.covariance, body.then->attachment.covariance);
  for (std::size_t k = 0; k < 6; ++k) {
    made.errorTurns[k] = glm::vec4(root[0][k], root[1][k], root[2][k], 0.0F);
    made.errorShifts[k] = glm::vec4(root[3][k], root[4][k], root[5][k], 0.0F);
  }
  return made;
}

void SurfacePass::writeBodies(const SceneBodies& bodies) {
  const std::size_t planes = scene_.planes.size();
  for (std::size_t i = 0; i < planes; ++i) {
    GpuBody& plane = staged_[i];
    plane = gpuBody(bodies.plane(i));
    if (bodies.plane(i).now) plane.extent = glm::vec4(0.5 * scene_.planes[i].sizeMetres, 1.0, 0.0);
  }
  for (std::size_t i = 0; i < scene_.models.size(); ++i) {
    GpuBody& model = staged_[planes + i];
    model = gpuBody(bodies.model(i));
    const ObjectPlace place = geometry_.place(i);
    if (!place.firstThen) model.turnsAbout.w = 0.0F;
    model.extent.z = scene_.models[i].isOccluder ? 1.0F : 0.0F;
    model.places = {place.firstTriangle, place.firstNow, place.firstThen.value_or(0), 0};
  }
  bodies_.write(std::as_bytes(std::span(staged_)));
}

void SurfacePass::run(const gpu::Texture& ids, const tracking::CameraModel& camera,
                      const SceneBodies& bodies, const Buffers& buffers) {
  assert(ids.size() == camera.imageSize() && buffers.motion.size() == ids.size());
  writeBodies(bodies);
  const tracking::Intrinsics& pinhole = camera.intrinsics();
  program_.use()
      .texture("ids", ids)
      .storage(0, geometry_.isEmpty() ? nothing_ : geometry_.posed())
      .storage(1, geometry_.isEmpty() ? nothing_ : geometry_.triangles())
      .storage(2, bodies_)
      .image(0, buffers.motion, gpu::ImageAccess::kWrite)
      .image(1, buffers.barycentrics, gpu::ImageAccess::kWrite)
      .image(2, buffers.parts, gpu::ImageAccess::kWrite)
      .set("planeCount", static_cast<int>(scene_.planes.size()))
      .set("focal", glm::vec2(pinhole.fx, pinhole.fy))
      .set("centre", glm::vec2(pinhole.cx, pinhole.cy));
  setLens(program_, camera);
  program_.dispatch({ids.size().width, ids.size().height}, {8, 8},
                    GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

}  // namespace pleinair::scene
