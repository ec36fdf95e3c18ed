#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "hal/pixel_format.h"
#include "pipeline/scene/description/scene.h"

namespace pleinair::app {

/// That poses come from an assumed lens, for a scene with tags and without a camera.
std::optional<std::string> assumedCameraWarning(const scene::Scene& scene, hal::FrameSize frame);

/// Which of the scene's tags no frame showed, of those that carry a model, or of all where none was
/// seen: most likely a wrong id or family. `seen` are the ids of all tags that were found.
std::optional<std::string> unseenTagsWarning(const scene::Scene& scene, const std::set<int>& seen);

/// That a view of the models (scene::bufferViews()) is black, where the scene has neither models
/// nor planes.
std::optional<std::string> blackViewWarning(const scene::Scene& scene, std::string_view view);

}  // namespace pleinair::app
