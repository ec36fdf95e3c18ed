#include "firmware_app/overlay/model_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <vector>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>

#include "firmware_app/overlay/card.h"
#include "firmware_app/procedure/step_arrows.h"
#include "firmware_app/procedure/step_composite.h"
#include "firmware_app/procedure/step_ghosts.h"
#include "firmware_app/procedure/step_view.h"
#include "pipeline/overlay/reserved_colours.h"

namespace pleinair::app {
namespace {

using overlay::PartLook;

struct Facet {
  std::array<glm::vec3, 3> corners;  // in the model's frame
  glm::vec3 normal;
  StepPixel look = StepPixel::kContext;
  bool isSubject = false;
};

/// What a pixel shows.
struct Shown {
  float depth = std::numeric_limits<float>::max();
  float light = 0.0F;
  StepPixel look = StepPixel::kGround;
  bool isSubject = false;
};

/// How a part is drawn, and where.
struct DrawnPart {
  std::size_t part = 0;
  StepPixel look = StepPixel::kContext;
  bool isSubject = false;
  glm::dvec3 apartMetres{0.0};
};

StepPixel pixelOf(PartLook look) {
  switch (look) {
    case PartLook::kPlain:
      return StepPixel::kContext;
    case PartLook::kFocus:
      return StepPixel::kFocus;
    case PartLook::kTint:
      return StepPixel::kTint;
    case PartLook::kOutline:
      return StepPixel::kOutline;
    case PartLook::kHidden:
      return StepPixel::kGround;
  }
  return StepPixel::kContext;
}

bool isMarked(StepPixel look) {
  return look != StepPixel::kGround && look != StepPixel::kContext;
}

std::vector<Facet> facetsOf(const scene::Model& model, std::span<const DrawnPart> parts) {
  std::vector<Facet> facets;
  for (const DrawnPart& drawn : parts) {
    const scene::ModelPart& part = model.parts[drawn.part];
    const glm::mat4 place(glm::translate(glm::dmat4(1.0), drawn.apartMetres) *
                          glm::dmat4(part.modelFromPart));
    for (std::size_t s = 0; s < part.surfaceCount; ++s) {
      const scene::Mesh& mesh = model.surfaces[part.firstSurface + s].mesh;
      for (const auto& triangle : mesh.triangles) {
        Facet facet{.corners = {}, .normal = {}, .look = drawn.look, .isSubject = drawn.isSubject};
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

  void draw(std::span<const Facet> facets, const glm::dmat4& cameraFromModel) {
    std::ranges::fill(pixels_, Shown{});
    const glm::mat4 camera(cameraFromModel);
    const glm::mat3 turn(cameraFromModel);
    const float focal = 0.5F * static_cast<float>(size_.height) /
                        std::tan(0.5F * glm::radians(static_cast<float>(kStepViewDeg)));
    const glm::vec2 centre(glm::dvec2(0.5 * size_.width, 0.5 * size_.height));
    for (const Facet& facet : facets) {
      std::array<glm::vec3, 3> px{};
      bool isBehind = false;
      for (std::size_t c = 0; c < 3; ++c) {
        const glm::vec3 at(camera * glm::vec4(facet.corners.at(c), 1.0F));
        isBehind = isBehind || at.z < 1e-3F;
        px.at(c) = glm::vec3(glm::vec2(at) * (focal / std::max(at.z, 1e-3F)) + centre, at.z);
      }
      if (!isBehind) fill(px, std::abs((turn * facet.normal).z), facet);
    }
  }

 private:
  void fill(const std::array<glm::vec3, 3>& px, float light, const Facet& facet) {
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
        if (depth < shown.depth) shown = {depth, light, facet.look, facet.isSubject};
      }
    }
  }

  hal::FrameSize size_;
  std::vector<Shown> pixels_;
};

scene::BoundingSphere sphereOf(std::span<const Facet> facets, bool subjectOnly) {
  glm::vec3 low(std::numeric_limits<float>::max());
  glm::vec3 high(-low);
  for (const Facet& facet : facets) {
    if (subjectOnly && !facet.isSubject) continue;
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
    trial.draw(facets, camera);
    const auto shown =
        static_cast<double>(std::ranges::count(trial.pixels(), true, &Shown::isSubject));
    if (shown <= kMuchBetter * most) continue;
    most = shown;
    best = camera;
  }
  return best;
}

std::vector<DrawnPart> drawnParts(const scene::Model& model, const ModelPictureContent& content) {
  std::vector<DrawnPart> parts(model.parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const PartLook look = i < content.looks.size() ? content.looks[i] : PartLook::kPlain;
    parts[i] = {.part = i, .look = pixelOf(look)};
  }
  for (const overlay::Ghost& ghost : content.ghosts) {
    if (!isStill(ghost)) parts[ghost.part].look = StepPixel::kFocus;
  }
  for (DrawnPart& each : parts) {
    each.isSubject = content.parts.empty()
                         ? isMarked(each.look)
                         : std::ranges::find(content.parts, each.part) != content.parts.end();
  }
  std::erase_if(parts, [](const DrawnPart& each) { return each.look == StepPixel::kGround; });
  return parts;
}

std::vector<DrawnPart> stillGhosts(const ModelPictureContent& content) {
  std::vector<DrawnPart> ghosts;
  for (const overlay::Ghost& each : content.ghosts) {
    if (!isStill(each)) continue;
    ghosts.push_back({.part = each.part,
                      .look = StepPixel::kFocus,
                      .isSubject = true,
                      .apartMetres = each.apartMetres});
  }
  return ghosts;
}

/// The drawing at twice its size.
struct Layers {
  hal::Image shaded;
  std::vector<StepPixel> pixels;
  std::vector<bool> ghosts;
};

Layers layersOf(const Raster& all, const Raster& focus, const Raster& ghosts, hal::FrameSize size) {
  constexpr float kGround = 246.0F;
  constexpr float kSurface = 200.0F;
  Layers layers{.shaded = hal::Image({.pixelFormat = hal::PixelFormat::kRgb8, .size = size}),
                .pixels = {},
                .ghosts = {}};
  std::size_t at = 0;
  for (int y = 0; y < size.height; ++y) {
    const auto row = layers.shaded.row(0, y);
    for (std::size_t x = 0; x < static_cast<std::size_t>(size.width); ++x, ++at) {
      const Shown& shown = all.pixels()[at];
      const bool isGround = shown.look == StepPixel::kGround;
      const float grey = isGround ? kGround : kSurface * (0.35F + 0.65F * shown.light);
      std::fill_n(row.begin() + static_cast<std::ptrdiff_t>(3 * x), 3,
                  static_cast<std::uint8_t>(grey));
      const bool hides = !isGround && shown.look != StepPixel::kFocus &&
                         focus.pixels()[at].look == StepPixel::kFocus;
      layers.pixels.push_back(hides ? StepPixel::kFocusHidden : shown.look);
      layers.ghosts.push_back(ghosts.pixels()[at].depth < shown.depth);
    }
  }
  return layers;
}

}  // namespace

hal::Image modelPicture(const scene::Model& model, const ModelPictureContent& content,
                        hal::FrameSize size, const glm::dmat3& uprightFromModel) {
  const std::vector<Facet> facets = facetsOf(model, drawnParts(model, content));
  const std::vector<Facet> ghostFacets = facetsOf(model, stillGhosts(content));
  std::vector<Facet> inFocus;
  std::ranges::copy_if(facets, std::back_inserter(inFocus),
                       [](const Facet& each) { return each.look == StepPixel::kFocus; });
  std::vector<Facet> together = facets;
  together.insert(together.end(), ghostFacets.begin(), ghostFacets.end());
  const scene::BoundingSphere whole = sphereOf(facets, false);
  const scene::BoundingSphere focus = sphereOf(together, true);
  const glm::dmat4 camera =
      bestView(facets, focus.radiusMetres > 0.0 ? focus : whole, whole, uprightFromModel);
  const hal::FrameSize large{2 * size.width, 2 * size.height};
  Raster all(large);
  all.draw(facets, camera);
  Raster alone(large);
  alone.draw(inFocus, camera);
  Raster ghosts(large);
  ghosts.draw(ghostFacets, camera);
  const Layers layers = layersOf(all, alone, ghosts, large);
  hal::Image picture = stepComposite(layers.shaded, layers.pixels, layers.ghosts);
  drawArrows(picture, content.arrows, model, camera, stepCamera(size), size.width / 330.0);
  Card card(size);
  card.paste(picture, 0, 0);
  card.border({0, 0, size.width, size.height}, std::max(1, size.width / 100),
              overlay::kReservedRgb);
  return card.take();
}

}  // namespace pleinair::app
