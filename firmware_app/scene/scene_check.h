#pragma once

#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "hal/image.h"
#include "pipeline/scene/description/scene.h"
#include "pipeline/tracking/camera/camera_model.h"
#include "pipeline/tracking/pose/tracker.h"

namespace pleinair::app {

/// A box along the axes of a frame, in metres.
struct AxisBox {
  glm::dvec3 least{0.0};
  glm::dvec3 most{0.0};
};

/// The box around a model at rest, in the frame of what it is attached to.
AxisBox attachedBox(const scene::SceneModel& model);

/// One line for each model: where it is attached, its size and its place.
std::vector<std::string> modelLines(const scene::Scene& scene);

/// One line for each model that is likely to be placed wrongly, with its remedy: one that lies on
/// its back in its tag because its up is y, as in glTF.
std::vector<std::string> placementFindings(const scene::Scene& scene);

/// Draws into `picture` (RGB8, as large as the camera's image): the edges and numbers of the tags,
/// the axes of their attach frames (x red, y green, z blue, one tag's edge long), the axes of the
/// world, and the boxes of the models.
void drawSceneCheck(hal::Image& picture, const scene::Scene& scene,
                    const tracking::CameraModel& camera, const tracking::TrackingResult& tracking);

}  // namespace pleinair::app
