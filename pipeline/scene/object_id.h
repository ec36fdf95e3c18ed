#pragma once

#include <cstddef>
#include <cstdint>

#include "pipeline/scene/ar_frame.h"
#include "pipeline/scene/scene.h"

namespace pleinair::scene {

/// What ArFrame::ids say of a model of the scene, counted from 0.
inline std::uint32_t objectId(const Scene& scene, std::size_t model) {
  const auto number = static_cast<std::uint32_t>(model) + 1U;
  return scene.models[model].isOccluder ? number | kRealObject : number;
}

}  // namespace pleinair::scene
