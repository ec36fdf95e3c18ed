#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "hal/pixel_format.h"
#include "pipeline/scene/description/scene.h"

namespace pleinair::app {

/// Warns that poses come from an assumed lens, for a scene with tags and without a camera.
std::optional<std::string> assumedCameraWarning(const scene::Scene& scene, hal::FrameSize frame);

/// Warns about the scene's tags with a model that no frame showed, or about all tags if none was
/// seen: most likely their id or family is wrong. `seen` holds the ids of all detected tags.
/// In a single frame (`isOneFrame`), tags may well be out of sight: only that none was seen counts.
std::optional<std::string> unseenTagsWarning(const scene::Scene& scene, const std::set<int>& seen,
                                             bool isOneFrame = false);

/// Warns that a debug view of the models (scene::bufferViews()) is black, for a scene without
/// models and planes, or because it shows what has moved since the frame before and only one frame
/// is painted.
std::optional<std::string> blackViewWarning(const scene::Scene& scene, std::string_view view,
                                            bool isOneFrame = false);

}  // namespace pleinair::app
