#pragma once

#include "pipeline/scene/models/model.h"

namespace pleinair::scene {

/// The same model without the triangles that cannot be seen: at rest, no surface is farther from
/// where it was than 1/1000 of the model's width (twice the radius of its bounding sphere), or
/// 1/250 of its own, whichever is less. Vertices that stay are as they were. What a surface shows
/// between vertices must not depend on them: those with a texture, several colours, normals that
/// are not its form's, a skin or morph targets are left alone.
Model simplified(Model model);

}  // namespace pleinair::scene
