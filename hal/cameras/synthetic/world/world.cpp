#include "hal/cameras/synthetic/world/world.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>
#include <thread>
#include <tuple>
#include <utility>

#include "hal/cameras/synthetic/world/light.h"
#include "hal/cameras/synthetic/world/workbench.h"

namespace pleinair::hal::synthetic {
namespace {

/// Runs work(i) for all i below `count`, on all processors; starts in rising order of i.
template <class Work>
void forAll(std::size_t count, const Work& work) {
  std::atomic<std::size_t> next{0};
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  const unsigned others = std::clamp(std::thread::hardware_concurrency(), 1U, 8U) - 1;
  std::vector<std::jthread> threads;
  for (unsigned i = 0; i < others; ++i) threads.emplace_back(run);
  run();
}

PatchTexture blank(const Patch& patch, double texelMetres) {
  constexpr double kTexelsAcrossAtLeast = 6;
  const double coarse = texelMetres * patch.coarseness;
  const double shorter = 2.0 * static_cast<double>(std::min(patch.half.x, patch.half.y));
  const double texel = std::min(coarse, shorter / kTexelsAcrossAtLeast);
  const auto texels = [texel](float half) {
    return static_cast<int>(std::ceil(2.0 * static_cast<double>(half) / texel));
  };
  return {MipTexture(texels(patch.half.x), texels(patch.half.y)), static_cast<float>(texel),
          patch.half};
}

bool isInUse(const Patch& patch, const WorldOptions& options) {
  return patch.body < kFirstOfFigures || options.hasFigures;
}

PatchTexture unused(const Patch& patch) {
  return {MipTexture(2, 2), std::max(patch.half.x, patch.half.y), patch.half};
}

glm::vec3 meanLinearRgb(const MipTexture::Level& level) {
  constexpr std::size_t kStride = 61;
  glm::vec3 sum(0);
  float count = 0;
  for (std::size_t i = 0; i < level.texels.size(); i += kStride, ++count) {
    sum += linearRgbOf(level.texels[i]);
  }
  return sum / count;
}

/// The largest patches first, so that no processor is left alone with a large one at the end.
std::vector<std::size_t> byFallingSize(const std::vector<PatchTexture>& textures) {
  std::vector<std::size_t> order(textures.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, std::greater{}, [&textures](std::size_t i) {
    return textures[i].texture.levels().front().texels.size();
  });
  return order;
}

}  // namespace

const Geometry& workbenchGeometry() {
  static const Geometry kGeometry = planWorkbench(1).geometry;
  return kGeometry;
}

World paintWorkbench(const WorldOptions& options) {
  const Plan plan = planWorkbench(options.seed);
  World world{workbenchGeometry(), {}};
  for (const Patch& patch : plan.patches) {
    world.textures.push_back(isInUse(patch, options) ? blank(patch, options.texelMetres)
                                                     : unused(patch));
  }
  const std::vector<std::size_t> order = byFallingSize(world.textures);
  std::vector<glm::vec3> colours(plan.patches.size());
  forAll(order.size(), [&](std::size_t i) {
    const std::size_t patch = order[i];
    if (!isInUse(plan.patches[patch], options)) return;
    PatchTexture& texture = world.textures[patch];
    Canvas canvas(texture.texture.base(), texture.half, texture.texelMetres);
    plan.patches[patch].paint(canvas);
    colours[patch] = meanLinearRgb(texture.texture.base());
  });
  const RoomLight light(plan.occluders, colours, options.hasSpotlight);
  forAll(order.size(), [&](std::size_t i) {
    const Patch& patch = plan.patches[order[i]];
    if (!isInUse(patch, options)) return;
    PatchTexture& texture = world.textures[order[i]];
    if (!patch.isEmissive) {
      applyLight(light.on(patch), texture.half, texture.texelMetres, texture.texture.base());
    }
    texture.texture.buildLevels();
  });
  return world;
}

std::shared_ptr<const World> sharedWorkbench(const WorldOptions& options) {
  static std::mutex mutex;
  static std::map<std::tuple<std::uint32_t, double, bool, bool>, std::weak_ptr<const World>> worlds;
  const std::scoped_lock lock(mutex);
  std::weak_ptr<const World>& known =
      worlds[{options.seed, options.texelMetres, options.hasFigures, options.hasSpotlight}];
  if (auto world = known.lock()) return world;
  auto world = std::make_shared<const World>(paintWorkbench(options));
  known = world;
  return world;
}

}  // namespace pleinair::hal::synthetic
