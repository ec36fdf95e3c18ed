#include "pipeline/styles/painterly/palette.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "hal/linear_light.h"

namespace pleinair::styles {
namespace {

constexpr std::size_t kMinPigments = 2;
constexpr std::size_t kMaxPigments = 8;

struct Named {
  std::string_view name;
  std::string_view pigments;
};
constexpr std::array<Named, 5> kNamed{{
    {"all", ""},
    // Anders Zorn's: white, black, yellow ochre, vermilion.
    {"zorn", "#f6f1e4 #14120f #c8952f #c8311c"},
    {"earth", "#f3ead6 #1d1611 #b5813a #8c3b22 #5a6245 #6f7f8c"},
    {"primaries", "#fbf7ea #101018 #f2c313 #d5281f #1f4fa3"},
    {"sepia", "#f7f0e1 #21150c #8a5a34"},
}};

constexpr hal::LumaWeights kLuma = hal::lumaWeights(hal::ColorMatrix::kBt601);
/// A space in which distances are nearly those that are seen: brightness, and two axes of hue.
const glm::dmat3 kOpponent = glm::transpose(glm::dmat3{
    glm::dvec3(kLuma.red, kLuma.green, kLuma.blue) * 1.6,
    glm::dvec3(-0.169, -0.331, 0.5),
    glm::dvec3(0.5, -0.419, -0.081),
});

using Points = std::vector<glm::dvec3>;

glm::dvec3 nearestOnSegment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 ab = b - a;
  const double squared = glm::dot(ab, ab);
  if (squared <= 0.0) return a;
  return a + std::clamp(glm::dot(p - a, ab) / squared, 0.0, 1.0) * ab;
}

/// Inside the triangle, or none: then a side is nearest.
std::optional<glm::dvec3> nearestInside(const glm::dvec3& p, const glm::dvec3& a,
                                        const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 u = b - a;
  const glm::dvec3 v = c - a;
  const double uu = glm::dot(u, u);
  const double uv = glm::dot(u, v);
  const double vv = glm::dot(v, v);
  const double determinant = uu * vv - uv * uv;
  if (determinant <= 1e-12) return std::nullopt;
  const double pu = glm::dot(p - a, u);
  const double pv = glm::dot(p - a, v);
  const double s = (vv * pu - uv * pv) / determinant;
  const double t = (uu * pv - uv * pu) / determinant;
  if (s < 0.0 || t < 0.0 || s + t > 1.0) return std::nullopt;
  return a + s * u + t * v;
}

bool isInside(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
              const glm::dvec3& d) {
  const glm::dmat3 sides(b - a, c - a, d - a);
  if (std::abs(glm::determinant(sides)) <= 1e-12) return false;
  const glm::dvec3 part = glm::inverse(sides) * (p - a);
  return part.x >= 0.0 && part.y >= 0.0 && part.z >= 0.0 && part.x + part.y + part.z <= 1.0;
}

/// The nearest over all tetrahedra and triangles of the points, of which there are few.
glm::dvec3 nearestInHull(const Points& points, const glm::dvec3& p) {
  glm::dvec3 nearest = points.front();
  const auto offer = [&](const glm::dvec3& place) {
    if (glm::distance(p, place) < glm::distance(p, nearest)) nearest = place;
  };
  const std::size_t n = points.size();
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = a + 1; b < n; ++b) {
      offer(nearestOnSegment(p, points[a], points[b]));
      for (std::size_t c = b + 1; c < n; ++c) {
        const auto inside = nearestInside(p, points[a], points[b], points[c]);
        if (inside) offer(*inside);
        for (std::size_t d = c + 1; d < n; ++d) {
          if (isInside(p, points[a], points[b], points[c], points[d])) return p;
        }
      }
    }
  }
  return nearest;
}

std::optional<glm::vec3> colourOf(std::string_view text) {
  if (text.size() != 7 || text.front() != '#') return std::nullopt;
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data() + 1, text.data() + 7, value, 16);
  if (error != std::errc() || end != text.data() + 7) return std::nullopt;
  return glm::vec3(value >> 16U, (value >> 8U) & 0xFFU, value & 0xFFU) / 255.0F;
}

std::optional<Pigments> listed(std::string_view text) {
  Pigments found;
  while (!text.empty()) {
    const std::size_t start = text.find_first_not_of(' ');
    if (start == std::string_view::npos) break;
    text.remove_prefix(start);
    const std::size_t length = std::min(text.find(' '), text.size());
    const auto colour = colourOf(text.substr(0, length));
    if (!colour) return std::nullopt;
    found.push_back(*colour);
    text.remove_prefix(length);
  }
  return found;
}

std::optional<Pigments> pigmentsIn(std::string_view text) {
  const auto* named = std::ranges::find(kNamed, text, &Named::name);
  if (named != kNamed.end()) return listed(named->pigments);
  auto own = listed(text);
  if (!own || own->size() < kMinPigments || own->size() > kMaxPigments) return std::nullopt;
  return own;
}

}  // namespace

bool isPalette(std::string_view text) {
  return pigmentsIn(text).has_value();
}

Pigments pigmentsOf(std::string_view text) {
  auto found = pigmentsIn(text);
  assert(found);
  return *std::move(found);
}

glm::vec3 mixedOf(const Pigments& pigments, const glm::vec3& colour) {
  if (pigments.empty()) return colour;
  Points points;
  points.reserve(pigments.size());
  for (const glm::vec3& each : pigments) points.push_back(kOpponent * glm::dvec3(each));
  const glm::dvec3 nearest = nearestInHull(points, kOpponent * glm::dvec3(colour));
  return glm::vec3(glm::inverse(kOpponent) * nearest);
}

gpu::Texture makeMixtures(const Pigments& pigments) {
  const hal::FrameSize size{kMixtures * kMixtures, kMixtures};
  std::vector<std::uint8_t> bytes;
  bytes.reserve(static_cast<std::size_t>(size.pixels()) * 4);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const glm::vec3 mixed =
          mixedOf(pigments, glm::vec3(x % kMixtures, y, x / kMixtures) / float{kMixtures - 1});
      for (int i = 0; i < 3; ++i) {
        const float part = std::clamp(mixed[i], 0.0F, 1.0F);
        bytes.push_back(static_cast<std::uint8_t>(std::lround(255.0F * part)));
      }
      bytes.push_back(255);
    }
  }
  gpu::Texture texture(gpu::TextureFormat::kRgba8, size);
  texture.upload(bytes, static_cast<std::size_t>(size.width) * 4);
  return texture;
}

}  // namespace pleinair::styles
