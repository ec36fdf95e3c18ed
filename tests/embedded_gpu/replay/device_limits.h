#pragma once

#include <nlohmann/json.hpp>

namespace pleinair::embedded_gpu {

/// What the current context offers: "renderer", "version", "limits" by GL's names without GL_, and
/// those of the extensions that docs/gpu.md speaks of that it has, as "extensions".
nlohmann::json deviceLimits();

}  // namespace pleinair::embedded_gpu
