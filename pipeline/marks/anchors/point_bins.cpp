#include "pipeline/marks/anchors/point_bins.h"

#include <cassert>
#include <cstddef>
#include <vector>

namespace pleinair::marks {
namespace {

const std::string kShaders = "pipeline/marks/anchors/shaders/";

}  // namespace

PointBins::PointBins(const gpu::ShaderLibrary& library)
    : link_(library.compute(kShaders + "point_bins_link.comp")),
      scan_(library.compute(kShaders + "point_bins_scan.comp")),
      gather_(library.compute(kShaders + "point_bins_gather.comp")) {}

void PointBins::allocate(hal::FrameSize bins, std::uint32_t slots) {
  bins_ = {bins.width, bins.height};
  slots_ = slots;
  const auto binCount = static_cast<std::size_t>(bins.pixels());
  // Each sort clears the counts and lists for the next.
  const std::vector<std::uint32_t> empty(2 * binCount + slots, 0);
  links_ = gpu::Buffer::of(std::span<const std::uint32_t>(empty), gpu::BufferUsage::kDynamic);
  starts_ = gpu::Buffer((binCount + 1) * sizeof(std::uint32_t), gpu::BufferUsage::kDynamic);
  sorted_ = gpu::Buffer(std::size_t{slots} * sizeof(BinnedPoint), gpu::BufferUsage::kDynamic);
}

glm::vec2 PointBins::binPixels(hal::FrameSize picture) const {
  return glm::vec2(picture.width, picture.height) / glm::vec2(bins_);
}

void PointBins::sort(const gpu::Buffer& points, hal::FrameSize picture) {
  assert(points.sizeBytes() == std::size_t{slots_} * sizeof(BinnedPoint));
  const int count = bins_.x * bins_.y;
  link_.use()
      .storage("Points", points)
      .storage("Links", links_)
      .set("bins", bins_)
      .set("binPixels", binPixels(picture))
      .set("slots", static_cast<int>(slots_))
      .dispatch({static_cast<int>(slots_), 1}, GL_SHADER_STORAGE_BARRIER_BIT);
  scan_.use()
      .storage("Links", links_)
      .storage("Starts", starts_)
      .set("count", count)
      .dispatch({1, 1}, GL_SHADER_STORAGE_BARRIER_BIT);
  gather_.use()
      .storage("Points", points)
      .storage("Links", links_)
      .storage("Starts", starts_)
      .storage("Sorted", sorted_)
      .set("bins", bins_)
      .set("binPixels", binPixels(picture))
      .set("slots", static_cast<int>(slots_))
      .dispatch({count, 1}, GL_SHADER_STORAGE_BARRIER_BIT);
}

}  // namespace pleinair::marks
