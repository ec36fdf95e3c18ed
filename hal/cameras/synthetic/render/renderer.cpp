#include "hal/cameras/synthetic/render/renderer.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>

#include <glm/vec3.hpp>

#include "hal/cameras/synthetic/render/sampler.h"
#include "hal/cameras/synthetic/world/srgb.h"

namespace pleinair::hal::synthetic {
namespace {

constexpr std::size_t kCodedSteps = 4096;

/// Converts between coded levels in sixty-fourths and linear light.
struct LevelCoding {
  std::array<float, (kLevelSteps >> 4) + 2> linear{};  // by quarters of a level
  std::array<std::int16_t, kCodedSteps + 1> level{};
  LevelCoding() {
    for (std::size_t i = 0; i < linear.size(); ++i) {
      const float coded = static_cast<float>(i) / 4;
      const auto below = static_cast<std::uint8_t>(std::min(coded, 254.0F));
      const float low = linearFromLevel(below);
      const float high = linearFromLevel(static_cast<std::uint8_t>(below + 1));
      linear[i] = low + (high - low) * (coded - static_cast<float>(below));
    }
    for (std::size_t i = 0; i <= kCodedSteps; ++i) {
      const float light = static_cast<float>(i) / kCodedSteps;
      level[i] = static_cast<std::int16_t>(std::lround(levelFromLinear(light) * 64));
    }
  }
  float linearOf(std::int16_t coded) const {
    return linear[static_cast<std::size_t>(std::max<std::int16_t>(coded, 0)) >> 4];
  }
  std::int16_t levelOf(float light) const {
    return level[static_cast<std::size_t>(std::clamp(light, 0.0F, 1.0F) * kCodedSteps)];
  }
};

const LevelCoding& coding() {
  static const LevelCoding kCoding;
  return kCoding;
}

}  // namespace

void Renderer::begin(const Exposure& exposure) {
  exposure_ = &exposure;
  row_ = 0;
  next_ = 0;
  active_.clear();
  line_.resize(exposure.size().width);
  levels_.assign(3 * static_cast<std::size_t>(exposure.size().width) + 1, 0);
  candidates_.clear();
  constexpr int kMoments = 9;
  moments_.clear();
  for (int moment = 0; moment < (exposure.rolls() ? kMoments : 1); ++moment) {
    moments_.push_back(momentAt(exposure.size().height * (moment / (kMoments - 1.0))));
  }
  for (const Solid& solid : world_->geometry.solids) {
    if (!moments_.front().bodies.has(solid.body)) continue;
    exposure.rolls() ? addRolling(solid, moments_) : addStanding(solid, moments_.front());
  }
  order_.resize(candidates_.size());
  std::iota(order_.begin(), order_.end(), std::uint16_t{0});
  std::ranges::sort(order_, {}, [this](std::uint16_t i) { return candidates_[i].firstRow; });
}

Renderer::Moment Renderer::momentAt(double y) const {
  const CameraView view = exposure_->viewAt(y);
  Moment moment{view.intrinsics, exposure_->bodiesAt(y), {}};
  moment.cameraFromBody[kRoom] = view.cameraFromWorld;
  for (Body body = kRoom + 1; body < kBodies; ++body) {
    if (!moment.bodies.has(body)) continue;
    moment.cameraFromBody[body] = view.cameraFromWorld * moment.bodies[body];
  }
  return moment;
}

bool Renderer::isWithin(const ProjectedFacet& facet, float margin) const {
  const FrameSize size = exposure_->size();
  return facet.right + margin > 0 && facet.left - margin < static_cast<float>(size.width) &&
         facet.bottom + margin > 0 && facet.top - margin < static_cast<float>(size.height);
}

ProjectedFacet& Renderer::slotFor(std::size_t index) {
  assert(index < ScanLine::kNothing);
  if (projected_.size() <= index) projected_.resize(index + 1);
  return projected_[index];
}

void Renderer::addCandidate(std::uint32_t facet, Body body, float top, float bottom) {
  const auto height = static_cast<float>(exposure_->size().height);
  candidates_.push_back({facet, body, static_cast<int>(std::floor(std::clamp(top, 0.0F, height))),
                         static_cast<int>(std::ceil(std::clamp(bottom, 0.0F, height)))});
}

void Renderer::addStanding(const Solid& solid, const Moment& moment) {
  const glm::dmat4& pose = moment.cameraFromBody[solid.body];
  if (!mayBeVisible(solid, pose, moment.intrinsics, exposure_->size(), 0)) return;
  for (std::uint32_t i = solid.firstFacet; i < solid.firstFacet + solid.facets; ++i) {
    ProjectedFacet& slot = slotFor(candidates_.size());
    if (!project(world_->geometry, i, pose, moment.intrinsics, slot)) continue;
    if (isWithin(slot, 0)) addCandidate(i, solid.body, slot.top, slot.bottom);
  }
}

/// Adds the facets of a solid at the times of several rows, with a margin for the motion between.
void Renderer::addRolling(const Solid& solid, std::span<const Moment> moments) {
  constexpr float kMarginPx = 3;
  const int height = exposure_->size().height;
  for (std::uint32_t i = solid.firstFacet; i < solid.firstFacet + solid.facets; ++i) {
    float top = std::numeric_limits<float>::infinity();
    float bottom = -top;
    float margin = kMarginPx;
    float lastTop = 0;
    float lastBottom = 0;
    bool isSeen = false;
    for (const Moment& moment : moments) {
      const glm::dmat4& pose = moment.cameraFromBody[solid.body];
      if (!project(world_->geometry, i, pose, moment.intrinsics, scratch_)) continue;
      if (top <= bottom) {
        margin = std::max({margin, kMarginPx + std::abs(scratch_.top - lastTop),
                           kMarginPx + std::abs(scratch_.bottom - lastBottom)});
      }
      lastTop = scratch_.top;
      lastBottom = scratch_.bottom;
      top = std::min(top, scratch_.top);
      bottom = std::max(bottom, scratch_.bottom);
      isSeen |= isWithin(scratch_, static_cast<float>(height) / 8);
    }
    if (!isSeen) continue;
    slotFor(candidates_.size());
    addCandidate(i, solid.body, top - margin, bottom + margin);
  }
}

std::span<const std::int16_t> Renderer::nextRow() {
  assert(exposure_ != nullptr && row_ < exposure_->size().height);
  std::erase_if(active_, [this](std::uint16_t i) { return candidates_[i].endRow <= row_; });
  for (; next_ < order_.size() && candidates_[order_[next_]].firstRow <= row_; ++next_) {
    if (candidates_[order_[next_]].endRow > row_) active_.push_back(order_[next_]);
  }
  if (exposure_->rolls()) projectActive();
  line_.trace(row_, projected_, active_);
  shade();
  ++row_;
  return std::span(levels_).first(levels_.size() - 1);
}

void Renderer::projectActive() {
  const Moment moment = momentAt(row_ + 0.5);
  for (const std::uint16_t slot : active_) {
    const Candidate& candidate = candidates_[slot];
    ProjectedFacet& facet = projected_[slot];
    const glm::dmat4& pose = moment.cameraFromBody[candidate.body];
    if (!project(world_->geometry, candidate.facet, pose, moment.intrinsics, facet)) {
      facet.top = facet.bottom = -1;  // faces away at this row's time
    }
  }
}

void Renderer::shade() {
  const int width = exposure_->size().width;
  for (int x = 0; x < width;) {
    const std::uint16_t index = line_.indexAt(x);
    if (index == ScanLine::kMixed) {
      shadeMixed(x++);
      continue;
    }
    int end = x + 1;
    while (end < width && line_.indexAt(end) == index) ++end;
    sampleOrDark(index, x, end - x, levels_.data() + std::ptrdiff_t{3} * x);
    x = end;
  }
}

void Renderer::sampleOrDark(std::uint16_t index, int x, int count, std::int16_t* levels) const {
  if (index == ScanLine::kNothing) {
    std::fill_n(levels, 3 * count + 1, std::int16_t{0});
    return;
  }
  const ProjectedFacet& facet = projected_[index];
  const Facet& flat = world_->geometry.facets[facet.facet];
  sample(facet, world_->textures[flat.patch], x, row_, count, levels);
}

void Renderer::shadeMixed(int x) {
  glm::vec3 light(0);
  for (const ScanLine::Share& share : line_.sharesAt(x)) {
    std::array<std::int16_t, 4> levels{};
    sampleOrDark(share.index, x, 1, levels.data());
    light += share.coverage * glm::vec3(coding().linearOf(levels[0]), coding().linearOf(levels[1]),
                                        coding().linearOf(levels[2]));
  }
  for (std::size_t channel = 0; channel < 3; ++channel) {
    levels_[3 * static_cast<std::size_t>(x) + channel] =
        coding().levelOf(light[static_cast<glm::vec3::length_type>(channel)]);
  }
}

}  // namespace pleinair::hal::synthetic
