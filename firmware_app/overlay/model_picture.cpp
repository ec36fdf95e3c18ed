#include "firmware_app/overlay/model_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>

#include "firmware_app/overlay/card.h"
#include "firmware_app/procedure/step_arrows.h"
#include "firmware_app/procedure/step_view.h"
#include "pipeline/overlay/reserved_colours.h"

namespace pleinair::app {
namespace {

using overlay::PartLook;

enum class Layer { kLeftOut, kAround, kFocus };

struct Facet {
  std::array<glm::vec3, 3> corners;  // in the model's frame
  glm::vec3 normal;
  Layer layer = Layer::kAround;
};

/// What a pixel shows.
struct Shown {
  float depth = std::numeric_limits<float>::max();
  float light = 0.0F;
  Layer layer = Layer::kLeftOut;
};

std::vector<Facet> facetsOf(const scene::Model& model, const std::vector<Layer>& layers) {
  std::vector<Facet> facets;
  for (std::size_t i = 0; i < model.parts.size(); ++i) {
    if (layers[i] == Layer::kLeftOut) continue;
    const scene::ModelPart& part = model.parts[i];
    const glm::mat4 place(part.modelFromPart);
    for (std::size_t s = 0; s < part.surfaceCount; ++s) {
      const scene::Mesh& mesh = model.surfaces[part.firstSurface + s].mesh;
      for (const auto& triangle : mesh.triangles) {
        Facet facet{.corners = {}, .normal = {}, .layer = layers[i]};
        for (std::size_t c = 0; c < 3; ++c) {
          facet.corners.at(c) =
              glm::vec3(place * glm::vec4(mesh.vertices[triangle.at(c)].position, 1.0F));
        }
        const glm::vec3 across =
            glm::cross(facet.corners[1] - facet.corners[0], facet.corners[2] - facet.corners[0]);
        const float area = glm::length(across);
        if (area <= 0.0F) continue;
        facet.normal = across / area;
        facets.push_back(facet);
      }
    }
  }
  return facets;
}

/// A depth buffer of facets seen by a pinhole.
class Raster {
 public:
  explicit Raster(hal::FrameSize size)
      : size_(size),
        pixels_(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height)) {}

  const std::vector<Shown>& pixels() const { return pixels_; }

  void draw(std::span<const Facet> facets, const glm::dmat4& cameraFromModel, bool focusOnly) {
    std::ranges::fill(pixels_, Shown{});
    const glm::mat4 camera(cameraFromModel);
    const glm::mat3 turn(cameraFromModel);
    const float focal = 0.5F * static_cast<float>(size_.height) /
                        std::tan(0.5F * glm::radians(static_cast<float>(kStepViewDeg)));
    const glm::vec2 centre(glm::dvec2(0.5 * size_.width, 0.5 * size_.height));
    for (const Facet& facet : facets) {
      if (focusOnly && facet.layer != Layer::kFocus) continue;
      std::array<glm::vec3, 3> px{};
      bool isBehind = false;
      for (std::size_t c = 0; c < 3; ++c) {
        const glm::vec3 at(camera * glm::vec4(facet.corners.at(c), 1.0F));
        isBehind = isBehind || at.z < 1e-3F;
        px.at(c) = glm::vec3(glm::vec2(at) * (focal / std::max(at.z, 1e-3F)) + centre, at.z);
      }
      if (!isBehind) fill(px, std::abs((turn * facet.normal).z), facet.layer);
    }
  }

 private:
  void fill(const std::array<glm::vec3, 3>& px, float light, Layer layer) {
    const auto [a, b, c] = px;
    const float area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (area == 0.0F) return;
    const auto range = [&](float u, float v, float w, int limit) {
      return std::pair(std::max(0, static_cast<int>(std::floor(std::min({u, v, w})))),
                       std::min(limit - 1, static_cast<int>(std::ceil(std::max({u, v, w})))));
    };
    const auto [left, right] = range(a.x, b.x, c.x, size_.width);
    const auto [top, bottom] = range(a.y, b.y, c.y, size_.height);
    for (int y = top; y <= bottom; ++y) {
      for (int x = left; x <= right; ++x) {
        const glm::vec2 p(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
        const float u = ((b.x - p.x) * (c.y - p.y) - (b.y - p.y) * (c.x - p.x)) / area;
        const float v = ((c.x - p.x) * (a.y - p.y) - (c.y - p.y) * (a.x - p.x)) / area;
        if (u < 0.0F || v < 0.0F || u + v > 1.0F) continue;
        const float depth = u * a.z + v * b.z + (1.0F - u - v) * c.z;
        Shown& shown = pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width) +
                               static_cast<std::size_t>(x)];
        if (depth < shown.depth) shown = {depth, light, layer};
      }
    }
  }

  hal::FrameSize size_;
  std::vector<Shown> pixels_;
};

scene::BoundingSphere sphereOf(std::span<const Facet> facets, bool focusOnly) {
  glm::vec3 low(std::numeric_limits<float>::max());
  glm::vec3 high(-low);
  for (const Facet& facet : facets) {
    if (focusOnly && facet.layer != Layer::kFocus) continue;
    for (const glm::vec3& corner : facet.corners) {
      low = glm::min(low, corner);
      high = glm::max(high, corner);
    }
  }
  if (low.x > high.x) return {};
  return {.centre = glm::dvec3(0.5F * (low + high)),
          .radiusMetres = 0.5 * glm::length(glm::dvec3(high - low))};
}

/// The view that shows most of the parts; the usual one is left only for a much better one.
glm::dmat4 bestView(std::span<const Facet> facets, const scene::BoundingSphere& focus,
                    const scene::BoundingSphere& whole, const glm::dmat3& uprightFromModel) {
  constexpr double kMuchBetter = 1.4;
  Raster trial({64, 48});
  glm::dmat4 best = cameraFromModel(candidateViews().front(), focus, whole, uprightFromModel);
  double most = -1.0;
  for (const ViewAngles& view : candidateViews()) {
    const glm::dmat4 camera = cameraFromModel(view, focus, whole, uprightFromModel);
    trial.draw(facets, camera, false);
    const auto shown =
        static_cast<double>(std::ranges::count(trial.pixels(), Layer::kFocus, &Shown::layer));
    if (shown <= kMuchBetter * most) continue;
    most = shown;
    best = camera;
  }
  return best;
}

glm::vec3 colourOf(const Shown& shown, bool hidesFocus, int x, int y) {
  const glm::vec3 reserved(overlay::kReservedRgb[0], overlay::kReservedRgb[1],
                           overlay::kReservedRgb[2]);
  const float light = 0.45F + 0.55F * shown.light;
  if (shown.layer == Layer::kFocus) return reserved * light;
  const glm::vec3 around =
      shown.layer == Layer::kAround ? glm::vec3(225.0F * light) : glm::vec3(246.0F);
  if (!hidesFocus) return around;
  constexpr int kHatch = 12;
  return (x + y) % kHatch < kHatch / 3 ? reserved : around;
}

}  // namespace

hal::Image modelPicture(const scene::Model& model, std::span<const PartLook> looks,
                        std::span<const overlay::Ghost> together,
                        std::span<const overlay::Arrow> arrows, hal::FrameSize size,
                        const glm::dmat3& uprightFromModel) {
  std::vector<Layer> layers(model.parts.size(), Layer::kAround);
  for (std::size_t i = 0; i < looks.size(); ++i) {
    if (looks[i] == PartLook::kHidden) layers[i] = Layer::kLeftOut;
    if (looks[i] == PartLook::kFocus || looks[i] == PartLook::kTint ||
        looks[i] == PartLook::kOutline) {
      layers[i] = Layer::kFocus;
    }
  }
  for (const overlay::Ghost& ghost : together) layers[ghost.part] = Layer::kFocus;
  const std::vector<Facet> facets = facetsOf(model, layers);
  const scene::BoundingSphere whole = sphereOf(facets, false);
  const scene::BoundingSphere focus = sphereOf(facets, true);
  const glm::dmat4 camera =
      bestView(facets, focus.radiusMetres > 0.0 ? focus : whole, whole, uprightFromModel);
  const hal::FrameSize large{2 * size.width, 2 * size.height};
  Raster all(large);
  Raster alone(large);
  all.draw(facets, camera, false);
  alone.draw(facets, camera, true);
  Card card(size);
  hal::Image picture({.pixelFormat = hal::PixelFormat::kRgb8, .size = size});
  for (int y = 0; y < size.height; ++y) {
    const auto row = picture.row(0, y);
    for (int x = 0; x < size.width; ++x) {
      glm::vec3 sum(0.0F);
      for (int i = 0; i < 4; ++i) {
        const int u = 2 * x + i % 2;
        const int v = 2 * y + i / 2;
        const auto at = static_cast<std::size_t>(v) * static_cast<std::size_t>(large.width) +
                        static_cast<std::size_t>(u);
        const bool hides = alone.pixels()[at].layer == Layer::kFocus;
        sum += 0.25F * colourOf(all.pixels()[at], hides, u, v);
      }
      for (int c = 0; c < 3; ++c) {
        row[3 * static_cast<std::size_t>(x) + static_cast<std::size_t>(c)] =
            static_cast<std::uint8_t>(std::clamp(sum[c], 0.0F, 255.0F));
      }
    }
  }
  drawArrows(picture, arrows, model, camera, stepCamera(size), size.width / 330.0);
  card.paste(picture, 0, 0);
  card.border({0, 0, size.width, size.height}, std::max(1, size.width / 100),
              overlay::kReservedRgb);
  return card.take();
}

}  // namespace pleinair::app
