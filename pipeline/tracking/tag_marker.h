#pragma once

#include <optional>

#include <glm/mat4x4.hpp>

namespace pleinair::tracking {

/// A tag that is expected.
struct TagMarker {
  int id = 0;
  double edgeMetres = 0.0;  ///< of the black square
  /// Where it is, in the frame of tagCorners(). A tag without one does not tell where the world is.
  std::optional<glm::dmat4> worldFromTag;
};

}  // namespace pleinair::tracking
