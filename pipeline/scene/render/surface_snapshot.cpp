#include "pipeline/scene/render/surface_snapshot.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include <glm/packing.hpp>
#include <glm/vec4.hpp>

#include "pipeline/gpu/render_target.h"

namespace pleinair::scene {
namespace {

/// Reads an R32UI texture. Integer targets can always be read as four components.
std::vector<std::uint32_t> readNumbers(const gpu::Texture& texture) {
  const hal::FrameSize size = texture.size();
  std::vector<std::uint32_t> four(4 * static_cast<std::size_t>(size.pixels()));
  glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT);  // compute passes may have written it
  const gpu::RenderTarget target({&texture});
  target.beginKeeping();
  glReadPixels(0, 0, size.width, size.height, GL_RGBA_INTEGER, GL_UNSIGNED_INT, four.data());
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  std::vector<std::uint32_t> numbers(four.size() / 4);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = four[4 * i];
  return numbers;
}

/// As PosedGeometry::posed() stores it.
struct PosedVertex {
  glm::vec3 position{0.0F};
  std::uint32_t normal = 0;
};
static_assert(sizeof(PosedVertex) == 16);

/// The whole buffer; empty where it cannot be read.
template <class Item>
std::vector<Item> itemsOf(const gpu::Buffer& buffer) {
  std::vector<Item> items(buffer.sizeBytes() / sizeof(Item));
  if (!buffer.read(std::as_writable_bytes(std::span(items)))) items.clear();
  return items;
}

}  // namespace

SurfaceSnapshot::SurfaceSnapshot(hal::FrameSize size) {
  content_.size = size;
  content_.ids.assign(static_cast<std::size_t>(size.pixels()), 0);
  content_.barycentrics = content_.ids;
}

glm::vec2 SurfaceSnapshot::barycentrics(int x, int y) const {
  return glm::unpackUnorm2x16(content_.barycentrics[index(x, y)]);
}

std::optional<glm::dvec3> SurfaceSnapshot::inCamera(std::uint32_t id,
                                                    glm::vec2 barycentrics) const {
  const auto object =
      std::ranges::find(content_.objects, id >> kTriangleBits, &PosedObject::object);
  if (object == content_.objects.end()) return std::nullopt;
  const std::uint32_t triangle = object->firstTriangle + (id & (kMaxTriangles - 1U));
  if (triangle >= content_.triangles->size()) return std::nullopt;
  const auto& corners = (*content_.triangles)[triangle].corners;
  const glm::dvec3 weights(barycentrics.x, barycentrics.y, 1.0 - barycentrics.x - barycentrics.y);
  glm::dvec3 inModel(0.0);
  for (int i = 0; i < 3; ++i) {
    const std::uint32_t corner = corners.at(static_cast<std::size_t>(i));
    if (corner >= object->vertices.size()) return std::nullopt;
    inModel += weights[i] * glm::dvec3(object->vertices[corner]);
  }
  return glm::dvec3(object->cameraFromModel * glm::dvec4(inModel, 1.0));
}

std::optional<glm::dvec2> SurfaceSnapshot::place(std::uint32_t id, glm::vec2 barycentrics) const {
  const std::optional<glm::dvec3> point = inCamera(id, barycentrics);
  if (!point || !(point->z > 0.0)) return std::nullopt;
  return content_.camera->project(*point);
}

SurfaceSnapshot SurfaceReader::read(const PosedGeometry& geometry, const SceneBodies& bodies,
                                    std::span<const std::size_t> visible,
                                    std::span<const std::uint32_t> objects,
                                    const tracking::CameraModel& camera, const gpu::Texture& ids,
                                    const gpu::Texture& barycentrics) {
  assert(ids.size() == barycentrics.size());
  if (!triangles_) {
    triangles_ = std::make_shared<const std::vector<DrawnTriangle>>(
        itemsOf<DrawnTriangle>(geometry.triangles()));
  }
  SurfaceSnapshot::Content content{.size = ids.size(),
                                   .ids = readNumbers(ids),
                                   .barycentrics = readNumbers(barycentrics),
                                   .objects = {},
                                   .triangles = triangles_,
                                   .camera = camera};
  const std::vector<PosedVertex> posed = itemsOf<PosedVertex>(geometry.posed());
  for (const std::size_t model : visible) {
    const ObjectPlace place = geometry.place(model);
    const std::size_t count = geometry.vertexCount(model);
    if (place.firstCurrent + count > posed.size()) continue;
    SurfaceSnapshot::PosedObject object{
        .object = objects[model],
        .firstTriangle = place.firstTriangle,
        .cameraFromModel = bodies.model(model).current->cameraFromBody,
        .vertices = {}};
    object.vertices.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      object.vertices.push_back(posed[place.firstCurrent + i].position);
    }
    content.objects.push_back(std::move(object));
  }
  return SurfaceSnapshot(std::move(content));
}

}  // namespace pleinair::scene
