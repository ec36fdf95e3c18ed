#pragma once

#include <cstddef>
#include <span>

#include <glm/mat3x3.hpp>

#include "hal/image.h"
#include "pipeline/overlay/overlay_content.h"
#include "pipeline/scene/models/model.h"

namespace pleinair::app {

/// What a picture of a model shows.
struct ModelPictureContent {
  std::span<const overlay::PartLook> looks;  ///< per part; hidden ones are left out
  /// Those that stand still lie over the picture; parts of others, which are on their way, are
  /// drawn in focus at home, also where they are hidden.
  std::span<const overlay::Ghost> ghosts;
  std::span<const overlay::Arrow> arrows;
  std::span<const std::size_t> parts;  ///< which the picture is about; empty: those with a look
};

/// A model drawn by the processor as `procedure preview` draws it (stepComposite), from the side
/// that shows most of the parts that it is about. RGBA8, opaque, with a frame. Parts are at rest;
/// skins and morph targets are not looked at. `uprightFromModel` turns the model so that its z is
/// up. Some 0.1 s for 60,000 triangles. Any thread.
hal::Image modelPicture(const scene::Model& model, const ModelPictureContent& content,
                        hal::FrameSize size, const glm::dmat3& uprightFromModel = glm::dmat3(1.0));

}  // namespace pleinair::app
