#include "pipeline/present/surface_drawer.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include <glm/vec4.hpp>

#include "hal/error.h"
#include "pipeline/gpu/images/aspect_fill.h"

namespace pleinair::present {
namespace {

constexpr std::size_t kUsualInFlight = 4;
constexpr glm::vec4 kBlack{0.0F, 0.0F, 0.0F, 1.0F};

}  // namespace

SurfaceDrawer::SurfaceDrawer(const gpu::ShaderLibrary& library, hal::FrameSize size,
                             int quarterTurns, gpu::GpuTestHook testHook)
    : size_(size),
      quarterTurns_(quarterTurns),
      testHook_(std::move(testHook)),
      program_(library.fragmentPass("pipeline/present/shaders/pack_rgba.frag")),
      pattern_(library.fragmentPass("pipeline/gpu/shaders/surface_pattern.frag")),
      resampler_(library) {
  inFlight_.reserve(kUsualInFlight);
}

void SurfaceDrawer::import(std::span<const hal::GpuSurface> surfaces,
                           std::span<const hal::FrameSize> pictureSizes) {
  imported_.clear();
  for (const hal::GpuSurface& each : surfaces) {
    assert(each.surface.format.size == size_);
    Imported imported{.id = each.surface.id,
                      .texture = gpu::importedTexture(each, testHook_),
                      .target = {},
                      .origin = {each.x, each.y}};
    imported.target = gpu::RenderTarget({&imported.texture});
    imported_.push_back(std::move(imported));
  }
  for (const hal::FrameSize each : pictureSizes) {
    draw(gpu::Texture(gpu::TextureFormat::kRgba8, each, gpu::TextureFilter::kLinear), each,
         imported_.front());
  }
  for (const Imported& each : imported_) {
    each.target.beginDiscarding();
    pattern_.use().set("surface", static_cast<int>(each.id));
    pattern_.drawArea(each.target, {0, 0}, each.target.size());
  }
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  hal::orThrow(gpu::Fence::insert().wait(testHook_));
}

void SurfaceDrawer::draw(const gpu::Texture& picture, hal::FrameSize fullSize,
                         const Imported& into) {
  const glm::dvec2 pixelsOfFull = glm::dvec2(picture.size().width, picture.size().height) /
                                  glm::dvec2(fullSize.width, fullSize.height);
  const hal::FrameSize upright =
      quarterTurns_ % 2 == 0 ? size_ : hal::FrameSize{size_.height, size_.width};
  const gpu::Texture& scaled = resampler_.resample(
      picture, upright,
      gpu::aspectFill(fullSize, upright).withPixels(pixelsOfFull, glm::dvec2(1.0)));
  into.target.beginDiscarding();
  if (into.target.size() != size_) into.target.clearColour(0, kBlack);
  program_.use()
      .texture("picture", scaled)
      .set("quarterTurns", quarterTurns_)
      .set("origin", into.origin);
  program_.drawArea(into.target, into.origin, size_);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void SurfaceDrawer::submit(const gpu::Texture& picture, hal::FrameSize fullSize,
                           hal::SurfaceId surface) {
  const auto into = std::ranges::find(imported_, surface, &Imported::id);
  assert(into != imported_.end());
  draw(picture, fullSize, *into);
  inFlight_.push_back(gpu::Fence::insert());
}

hal::Answer SurfaceDrawer::isReadyWithin(hal::Duration limit) const {
  assert(!isEmpty());
  return inFlight_.front().passed(testHook_, limit);
}

void SurfaceDrawer::pop() {
  assert(!isEmpty());
  inFlight_.erase(inFlight_.begin());
}

}  // namespace pleinair::present
