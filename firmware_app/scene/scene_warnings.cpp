#include "firmware_app/scene/scene_warnings.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

#include "pipeline/scene/render/buffer_views.h"

namespace pleinair::app {

std::optional<std::string> assumedCameraWarning(const scene::Scene& scene, hal::FrameSize frame) {
  if (scene.camera || scene.tags.empty()) return std::nullopt;
  const double halfWidth = 0.5 * frame.width / scene::assumedCamera(frame).intrinsics().fx;
  return fmt::format(
      "the scene has no [camera]: a field of view of {:.0f}° from left to right is assumed",
      glm::degrees(2.0 * std::atan(halfWidth)));
}

std::optional<std::string> unseenTagsWarning(const scene::Scene& scene, const std::set<int>& seen,
                                             bool isOneFrame) {
  const bool anySeen = std::ranges::any_of(
      scene.tags, [&](const tracking::TagMarker& tag) { return seen.contains(tag.id); });
  std::set<int> unseen;
  if (anySeen && isOneFrame) return std::nullopt;
  if (anySeen) {
    for (const scene::SceneModel& model : scene.models) {
      if (model.tagId && !seen.contains(*model.tagId)) unseen.insert(*model.tagId);
    }
  } else {
    for (const tracking::TagMarker& tag : scene.tags) unseen.insert(tag.id);
  }
  if (unseen.empty()) return std::nullopt;
  const bool isOne = unseen.size() == 1;
  return fmt::format("{} {} of the scene {} never seen; seen: {}", isOne ? "tag" : "tags",
                     fmt::join(unseen, ", "), isOne ? "was" : "were",
                     seen.empty() ? "none" : fmt::format("{}", fmt::join(seen, ", ")));
}

std::optional<std::string> blackViewWarning(const scene::Scene& scene, std::string_view view,
                                            bool isOneFrame) {
  if (scene::findBufferView(view) == nullptr) return std::nullopt;
  if (!scene.models.empty() || !scene.planes.empty()) {
    if (!isOneFrame || (view != "motion" && view != "motion_error")) return std::nullopt;
    return fmt::format(
        "the view {} shows what has moved since the frame before, and one frame is painted: it is "
        "black; paint more, such as --from TIME --frames 2",
        view);
  }
  return fmt::format(
      "the view {} shows the scene's models and planes, and there are none: it is black; give "
      "--scene FILE",
      view);
}

}  // namespace pleinair::app
