#include "hal/cameras/synthetic/renderer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "hal/cameras/synthetic/desk_world.h"

namespace pleinair::hal::synthetic {
namespace {

// The compilers' portable vectors: SSE and NEON alike.
using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));
using Word8 = std::uint16_t __attribute__((vector_size(16)));
static_assert(2 * sizeof(Texel) == sizeof(Word8));

/// Finer than the footprint's own level: crisp edges, which the two taps keep from shimmering.
constexpr float kLevelBias = -0.8F;

struct TexelPair {
  Float4 left, right;
};

/// A texel and the next in its row, 65535 for 1. Widens with zero words, for little-endian machines
/// (all of ours): the compilers convert 16-bit vectors one by one.
TexelPair load(const Texel* texel) {
  Word8 words;
  std::memcpy(&words, texel, sizeof(words));
  const Word8 zero{};
  const Word8 left = __builtin_shufflevector(words, zero, 0, 8, 1, 9, 2, 10, 3, 11);
  const Word8 right = __builtin_shufflevector(words, zero, 4, 12, 5, 13, 6, 14, 7, 15);
  return {__builtin_convertvector(Int4(left), Float4),
          __builtin_convertvector(Int4(right), Float4)};
}

Float4 clamped(Float4 value, Float4 highest) {
  const Float4 fromZero = value > 0.0F ? value : Float4{};
  return fromZero < highest ? fromZero : highest;
}

/// The ray's foot on a plane this far below the eye, with its derivatives by the pixel's x and y.
struct Foot {
  glm::vec2 point{0};
  glm::vec2 alongX{0};
  glm::vec2 alongY{0};
};

struct RowRays {
  glm::vec3 eye{0};
  glm::vec3 first{0};    ///< direction through the first pixel's centre
  glm::vec3 acrossX{0};  ///< its change from pixel to pixel
  glm::vec3 acrossY{0};  ///< its change from row to row

  Foot footOf(glm::vec3 direction, float depthBelowEye) const {
    const float t = -depthBelowEye / direction.z;
    const glm::vec2 slope = glm::vec2(direction) / direction.z;
    return {glm::vec2(eye) + glm::vec2(direction) * t, (glm::vec2(acrossX) - slope * acrossX.z) * t,
            (glm::vec2(acrossY) - slope * acrossY.z) * t};
  }
};

RowRays raysFrom(const CameraView& view, int x, int y) {
  const Ray first = view.through({x + 0.5, y + 0.5});
  const Ray right = view.through({x + 1.5, y + 0.5});
  const Ray below = view.through({x + 0.5, y + 1.5});
  return {glm::vec3(first.origin), glm::vec3(first.direction),
          glm::vec3(right.direction - first.direction),
          glm::vec3(below.direction - first.direction)};
}

/// The desk's texture, read with one footprint: two taps on each of two levels, in a lane each.
class FootSampler {
 public:
  FootSampler(const DeskPicture& desk, const Foot& foot);

  /// Premultiplied linear light and coverage, 65535 for 1; `point` in metres.
  Float4 at(glm::vec2 point) const {
    const Float4 x = clamped(point.x * scale_ + offsetX_, highestX_);
    const Float4 y = clamped(point.y * scale_ + offsetY_, highestY_);
    const Int4 column = __builtin_convertvector(x, Int4);
    const Int4 row = __builtin_convertvector(y, Int4);
    const Float4 tx = x - __builtin_convertvector(column, Float4);
    const Float4 ty = y - __builtin_convertvector(row, Float4);
    const Int4 index = row * width_ + column;
    const Float4 far = weight_ * ty;
    const Float4 near = weight_ - far;
    const auto tap = [&](int lane) {
      const Texel* texel = texels_[lane] + index[lane];
      const TexelPair above = load(texel);
      const TexelPair below = load(texel + width_[lane]);
      const Float4 left = above.left * near[lane] + below.left * far[lane];
      const Float4 right = above.right * near[lane] + below.right * far[lane];
      return left + (right - left) * tx[lane];
    };
    return tap(0) + tap(1) + tap(2) + tap(3);  // by hand: in a loop, lanes go through memory
  }

 private:
  static constexpr int kLanes = 4;
  const Texel* texels_[kLanes] = {};
  Int4 width_{};
  Float4 scale_{}, offsetX_{}, offsetY_{};  // texels a metre, and texels
  Float4 highestX_{}, highestY_{};          // so that the next texel is there
  Float4 weight_{};
};

FootSampler::FootSampler(const DeskPicture& desk, const Foot& foot) {
  const auto& levels = desk.texture.levels();
  glm::vec2 longer = foot.alongX;
  glm::vec2 shorter = foot.alongY;
  if (glm::dot(longer, longer) < glm::dot(shorter, shorter)) std::swap(longer, shorter);
  const float footprint = std::max(glm::length(shorter), glm::length(longer) / 2);  // metres
  const float lod = std::log2(footprint / static_cast<float>(desk.texelMetres)) + kLevelBias;
  const float highest = static_cast<float>(levels.size()) - 1.01F;
  const float level = lod > 0 ? std::min(lod, highest) : 0.0F;
  const auto fine = static_cast<std::size_t>(level);
  const float coarseShare = level - static_cast<float>(fine);
  for (int lane = 0; lane < kLanes; ++lane) {
    const bool isCoarse = lane >= 2;
    const std::size_t index = fine + (isCoarse ? 1 : 0);
    const MipTexture::Level& source = levels[index];
    const glm::vec2 tap = (lane % 2 == 0 ? -0.25F : 0.25F) * longer;
    const float scale = static_cast<float>(1 / desk.texelMetres) / static_cast<float>(1U << index);
    texels_[lane] = source.texels.data();
    width_[lane] = source.width;
    scale_[lane] = scale;
    offsetX_[lane] = (tap.x - static_cast<float>(desk.originMetres.x)) * scale - 0.5F;
    offsetY_[lane] = (tap.y - static_cast<float>(desk.originMetres.y)) * scale - 0.5F;
    highestX_[lane] = static_cast<float>(source.width) - 1.01F;
    highestY_[lane] = static_cast<float>(source.height) - 1.01F;
    weight_[lane] = 0.5F * (isCoarse ? coarseShare : 1 - coarseShare);
  }
}

}  // namespace

Renderer::Renderer(std::shared_ptr<const DeskPicture> desk) : desk_(std::move(desk)) {}

void Renderer::renderRun(const CameraView& view, int x, int y,
                         std::span<glm::vec3> linearRgb) const {
  const RowRays rays = raysFrom(view, x, y);
  const auto half = static_cast<float>(linearRgb.size()) / 2;
  const FootSampler sampler(*desk_, rays.footOf(rays.first + half * rays.acrossX, rays.eye.z));
  for (std::size_t i = 0; i < linearRgb.size(); ++i) {
    const glm::vec3 direction = rays.first + static_cast<float>(i) * rays.acrossX;
    if (direction.z >= 0) {
      linearRgb[i] = hazeLinearRgb();
      continue;
    }
    const glm::vec2 slope = glm::vec2(direction) / direction.z;
    const glm::vec2 eye(rays.eye);
    const Float4 desk = sampler.at(eye - rays.eye.z * slope) * (1 / 65535.0F);
    linearRgb[i] = {desk[0], desk[1], desk[2]};
    if (desk[3] < 0.9999F) {
      const float depthOfFloor = rays.eye.z - static_cast<float>(kFloorZ);
      linearRgb[i] += (1 - desk[3]) * floorLinearRgb(eye - depthOfFloor * slope);
    }
  }
}

}  // namespace pleinair::hal::synthetic
