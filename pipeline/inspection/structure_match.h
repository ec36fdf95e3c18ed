#pragma once

#include "hal/image.h"

namespace pleinair::inspection {

/// How alike the structure of two pictures of one place is, whatever the light.
struct StructureMatch {
  double mean = 0.0;        ///< of the agreement of all places, at most 1
  double worst = 0.0;       ///< the mean of the worst neighbourhood
  double structured = 0.0;  ///< share of places with structure in the first picture
  double brightness = 0.0;  ///< mean of the second picture, in grey levels
};

/// Compares grey pictures of equal size. The edges of each block of the first one are looked for in
/// the second one, within a few pixels of where both agree best on the whole: the mean cosine
/// between the directions of their gradients (as in Hinterstoisser et al., Gradient Response Maps,
/// PAMI 2012, but with one shift for a block). Light multiplies a picture and leaves directions as
/// they are, and the edge of a shadow is one more edge, which nothing looks for. So is a thing that
/// was added on a plain place. Only the disc that fills the picture counts. Precondition: equal
/// sizes of at least 64 px, PixelFormat::kGrey8.
StructureMatch matchStructure(const hal::ImageView& expected, const hal::ImageView& seen);

}  // namespace pleinair::inspection
