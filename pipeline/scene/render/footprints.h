#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "pipeline/scene/description/scene.h"
#include "pipeline/scene/render/ar_frame.h"
#include "pipeline/scene/render/posed_geometry.h"
#include "pipeline/scene/render/scene_bodies.h"
#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::scene {

/// Replaces `footprints` by those of the virtual ones among `visible` models (indices in the
/// scene), as posed now: the rectangle on the plane z = 0 of their attach frame around all that is
/// above it, and the tag that they are attached to; kMaxFootprints at most. One with a corner
/// beside or behind the camera is left out.
void findFootprints(const Scene& scene, const PosedGeometry& geometry, const SceneBodies& bodies,
                    std::span<const std::size_t> visible, const tracking::CameraModel& camera,
                    std::vector<Footprint>& footprints);

}  // namespace pleinair::scene
