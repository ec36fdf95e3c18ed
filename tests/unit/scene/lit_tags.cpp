#include "tests/unit/scene/lit_tags.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "pipeline/scene/description/scene.h"

namespace pleinair::scene {
namespace {

double codedLevel(double linear) {
  const double l = std::clamp(linear, 0.0, 1.0);
  return 255.0 * (l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1.0 / 2.4) - 0.055);
}

glm::dvec3 lightOn(const RoomOfTags& room, const tracking::TagMarker& tag) {
  const glm::dvec3 normal = -glm::dvec3((*tag.worldFromTag)[2]);
  return room.ambient + room.key * std::max(0.0, glm::dot(normal, glm::normalize(room.towardKey)));
}

struct LitTag {
  glm::dmat4 tagFromCamera{1.0};
  double half = 0.0;
  glm::dvec3 light{0.0};
};

std::vector<LitTag> litTags(const RoomOfTags& room, const glm::dmat4& cameraFromWorld) {
  std::vector<LitTag> lit;
  for (const tracking::TagMarker& tag : room.tags) {
    lit.push_back({.tagFromCamera = glm::inverse(cameraFromWorld * *tag.worldFromTag),
                   .half = 0.5 * tag.edgeMetres,
                   .light = lightOn(room, tag)});
  }
  return lit;
}

/// Colour of the nearest surface that the ray through a pixel meets; light as it appears before the
/// gain.
glm::dvec3 seenAlong(const RoomOfTags& room, const std::vector<LitTag>& tags, const glm::dvec3& ray,
                     const glm::dvec2& inPicture) {
  double nearest = HUGE_VAL;
  glm::dvec3 seen = room.background * std::exp2(glm::dot(room.backgroundSlope, inPicture));
  for (const LitTag& tag : tags) {
    const glm::dvec3 from(tag.tagFromCamera[3]);
    const glm::dvec3 along = glm::dmat3(tag.tagFromCamera) * ray;
    const double t = -from.z / along.z;
    if (!(t > 0.0 && t < nearest && along.z > 0.0)) continue;
    const glm::dvec3 at = (from + t * along) / tag.half;
    const double reach = std::max(std::abs(at.x), std::abs(at.y));
    if (reach > 1.25) continue;
    nearest = t;
    seen = tag.light * (reach > 1.0 ? 1.0 : reach > 0.75 ? room.ink : 0.5);
  }
  return seen;
}

}  // namespace

tracking::CameraModel tagCamera() {
  return {{.fx = 420.0, .fy = 420.0, .cx = 160.0, .cy = 120.0}, {}, {320, 240}};
}

glm::dmat4 lookingAtOrigin(double metres, double downDegrees, double aroundDegrees) {
  const double down = glm::radians(downDegrees), around = glm::radians(aroundDegrees);
  const glm::dvec3 from = metres * glm::dvec3(std::sin(around) * std::cos(down),
                                              -std::cos(around) * std::cos(down), std::sin(down));
  // glm looks along −z with y up.
  return kTagFromAttach * glm::lookAt(from, glm::dvec3(0.0), glm::dvec3(0.0, 0.0, 1.0));
}

tracking::TagMarker placedTag(int id, const glm::dvec3& at, double aboutX, double aboutZ) {
  glm::dmat4 worldFromAttach = glm::translate(glm::dmat4(1.0), at);
  worldFromAttach = glm::rotate(worldFromAttach, glm::radians(aboutZ), glm::dvec3(0, 0, 1));
  worldFromAttach = glm::rotate(worldFromAttach, glm::radians(aboutX), glm::dvec3(1, 0, 0));
  return {.id = id, .edgeMetres = 0.1, .worldFromTag = worldFromAttach * kAttachFromTag};
}

hal::Image pictureOf(const RoomOfTags& room, const Shot& shot) {
  const tracking::CameraModel camera = tagCamera();
  const hal::FrameSize size = camera.imageSize();
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = size});
  constexpr int kSamples = 3;
  const std::vector<LitTag> tags = litTags(room, shot.cameraFromWorld);
  for (int y = 0; y < size.height; ++y) {
    const auto row = image.row(0, y);
    for (int x = 0; x < size.width; ++x) {
      glm::dvec3 sum(0.0);
      for (int sample = 0; sample < kSamples * kSamples; ++sample) {
        const glm::dvec2 px(x + (sample % kSamples + 0.5) / kSamples,
                            y + (sample / kSamples + 0.5) / kSamples);
        const glm::dvec2 inPicture =
            2.0 * px / glm::dvec2(size.width, size.height) - glm::dvec2(1.0);
        sum += seenAlong(room, tags, *camera.unproject(px), inPicture);
      }
      for (int c = 0; c < 3; ++c) {
        const double level = codedLevel(shot.gain[c] * sum[c] / (kSamples * kSamples));
        row[static_cast<std::size_t>(3 * x + c)] = static_cast<std::uint8_t>(std::lround(level));
      }
    }
  }
  return image;
}

hal::Image noisy(const hal::Image& image, std::uint32_t seed, double sigma) {
  hal::Image noisy(image.view());
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, sigma);
  for (std::uint8_t& byte : noisy.plane(0)) {
    byte = static_cast<std::uint8_t>(std::clamp(std::lround(byte + noise(random)), 0L, 255L));
  }
  return noisy;
}

Tracked trackedIn(const RoomOfTags& room, const Shot& shot) {
  const tracking::CameraModel camera = tagCamera();
  Tracked tracked{.cameraFromWorld = shot.cameraFromWorld};
  for (const tracking::TagMarker& marker : room.tags) {
    tracking::TrackedTag tag;
    tag.id = marker.id;
    tag.cameraFromTag = shot.cameraFromWorld * *marker.worldFromTag;
    const auto corners = tracking::tagCorners(marker.edgeMetres);
    for (std::size_t i = 0; i < 4; ++i) {
      tag.corners[i] = camera.project(glm::dvec3(*tag.cameraFromTag * glm::dvec4(corners[i], 1.0)));
    }
    tracked.tags.push_back(tag);
  }
  return tracked;
}

}  // namespace pleinair::scene
