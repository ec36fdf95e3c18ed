#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include <glm/vec2.hpp>

#include "hal/image.h"

namespace pleinair::inspection {

/// How alike the structure of two pictures of one place is, whatever the light.
struct StructureMatch {
  double mean = 0.0;  ///< of the agreement of all places, at most 1
  /// The mean of the worst part of the relief; without relief, of the worst neighbourhood.
  double worst = 0.0;
  double structured = 0.0;  ///< share of places with structure in the first picture
  double brightness = 0.0;  ///< mean of the second picture, in grey levels
};

/// A pixel of what is compared.
struct ReliefPixel {
  float height = std::numeric_limits<float>::quiet_NaN();  ///< NaN: it does not count
  std::uint16_t part = 0;
};

/// Where edges of the first picture are looked for in the second one.
struct StructureSearch {
  /// The relief that counts, by rows, of the pictures' size. Empty: the disc that fills the
  /// picture, with unknown heights of -1 to 1.
  std::span<const ReliefPixel> relief;
  /// How far a point of height 1 moves where the second picture was taken from another place.
  glm::dvec2 reliefPx{0.0};
};

/// Compares grey pictures of equal size. The edges of each block of the first one are looked for in
/// the second one, within a few pixels of where both agree best on the whole: the mean cosine
/// between the directions of their gradients (as in Hinterstoisser et al., Gradient Response Maps,
/// PAMI 2012, but with one shift for a block). Light multiplies a picture and leaves directions as
/// they are, and the edge of a shadow is one more edge, which nothing looks for. So is a thing that
/// was added on a plain place. Only the disc that fills the picture counts. Precondition: equal
/// sizes of at least 64 px, PixelFormat::kGrey8.
StructureMatch matchStructure(const hal::ImageView& expected, const hal::ImageView& seen,
                              const StructureSearch& search = {});

}  // namespace pleinair::inspection
