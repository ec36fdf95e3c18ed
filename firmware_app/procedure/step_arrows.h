#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "hal/image.h"
#include "pipeline/overlay/overlay_content.h"
#include "pipeline/procedure/procedure.h"
#include "pipeline/scene/models/model.h"
#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::app {

/// Arrows beyond these are left out: nobody reads them.
inline constexpr std::size_t kMostArrows = 12;

/// The arrows of a step: at the parts that it moves, or else at its parts. Along one axis one arrow
/// says it; around each part's own axis each has one.
std::vector<overlay::Arrow> arrowsOf(const procedure::Step& step, const scene::Model& machine);

/// Draws arrows into a picture of the machine, RGB8 of the camera's size, in the reserved colour
/// with its casing. `pxScale`: widths are for a picture 640 px wide.
void drawArrows(hal::Image& picture, std::span<const overlay::Arrow> arrows,
                const scene::Model& machine, const glm::dmat4& cameraFromModel,
                const tracking::CameraModel& camera, double pxScale);

/// Draws a part's own axes from its centre, x red, y green, z blue, each with its name: what `axis`
/// of a step chooses from. `picture` as above.
void drawAxes(hal::Image& picture, const scene::Model& machine, std::size_t part,
              const glm::dmat4& cameraFromModel, const tracking::CameraModel& camera);

}  // namespace pleinair::app
