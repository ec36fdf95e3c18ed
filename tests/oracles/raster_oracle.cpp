#include "tests/oracles/raster_oracle.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::oracles {
namespace {

struct Corner {
  glm::dvec2 px;
  double depth;
  glm::dvec3 normal;
  glm::dvec2 texture;
  glm::dvec4 colour;
};

double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

double distanceToSegment(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 along = b - a;
  const double length2 = glm::dot(along, along);
  const double t = length2 > 0.0 ? std::clamp(glm::dot(p - a, along) / length2, 0.0, 1.0) : 0.0;
  return glm::distance(p, a + t * along);
}

class Picture {
 public:
  explicit Picture(hal::FrameSize size)
      : size_(size), pixels_(static_cast<std::size_t>(size.pixels())) {}

  void draw(const std::array<Corner, 3>& c, std::uint32_t id) {
    const double area = cross(c[1].px - c[0].px, c[2].px - c[0].px);
    if (area >= 0.0) return;  // image rows go down: front faces run clockwise
    glm::dvec2 low = glm::min(c[0].px, glm::min(c[1].px, c[2].px)) - 1.0;
    glm::dvec2 high = glm::max(c[0].px, glm::max(c[1].px, c[2].px)) + 1.0;
    low = glm::max(low, glm::dvec2(0.0));
    high = glm::min(high, glm::dvec2(size_.width, size_.height));
    for (int y = static_cast<int>(low.y); y < high.y; ++y) {
      for (int x = static_cast<int>(low.x); x < high.x; ++x) cover(c, area, id, x, y);
    }
  }

  std::vector<RasterPixel> take() { return std::move(pixels_); }

 private:
  void cover(const std::array<Corner, 3>& c, double area, std::uint32_t id, int x, int y) {
    RasterPixel& pixel =
        pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width) +
                static_cast<std::size_t>(x)];
    const glm::dvec2 p(x + 0.5, y + 0.5);
    std::array<double, 3> overDepth{};  // barycentric weights divided by each corner's depth
    bool isInside = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const Corner& a = c[(i + 1) % 3];
      const Corner& b = c[(i + 2) % 3];
      pixel.edgeDistancePx = std::min(pixel.edgeDistancePx, distanceToSegment(p, a.px, b.px));
      const double weight = cross(a.px - p, b.px - p) / area;
      isInside = isInside && weight >= 0.0;
      overDepth[i] = weight / c[i].depth;
    }
    if (!isInside) return;
    const double depth = 1.0 / (overDepth[0] + overDepth[1] + overDepth[2]);
    if (pixel.id != 0 && pixel.depthMetres <= depth) return;
    pixel.id = id;
    pixel.depthMetres = depth;
    pixel.cameraNormal = glm::normalize(overDepth[0] * c[0].normal + overDepth[1] * c[1].normal +
                                        overDepth[2] * c[2].normal);
    pixel.texture = depth * (overDepth[0] * c[0].texture + overDepth[1] * c[1].texture +
                             overDepth[2] * c[2].texture);
    pixel.colour = depth * (overDepth[0] * c[0].colour + overDepth[1] * c[1].colour +
                            overDepth[2] * c[2].colour);
  }

  hal::FrameSize size_;
  std::vector<RasterPixel> pixels_;
};

}  // namespace

std::vector<RasterPixel> rasterise(std::span<const PlacedMesh> meshes,
                                   const tracking::CameraModel& camera) {
  Picture picture(camera.imageSize());
  std::uint32_t object = 0;
  for (const PlacedMesh& placed : meshes) {
    ++object;
    const glm::dmat3 linear(placed.cameraFromModel);
    const glm::dmat3 rotation = linear / glm::length(linear[0]);
    for (std::uint32_t t = 0; t < placed.mesh->triangles.size(); ++t) {
      std::array<Corner, 3> corners{};
      for (std::size_t i = 0; i < 3; ++i) {
        const scene::MeshVertex& vertex = placed.mesh->vertices[placed.mesh->triangles[t][i]];
        const glm::dvec3 p(placed.cameraFromModel * glm::dvec4(glm::dvec3(vertex.position), 1.0));
        assert(p.z > 0.0);
        corners[i] = {camera.project(p), p.z, rotation * glm::dvec3(vertex.normal),
                      glm::dvec2(vertex.texture), glm::dvec4(vertex.colour)};
      }
      picture.draw(corners, object << scene::kTriangleBits | t);
    }
  }
  return picture.take();
}

double toonBand(double intensity) {
  if (intensity > 0.7) return 1.0;
  return intensity > 0.2 ? 0.4 : 0.1;
}

}  // namespace pleinair::oracles
