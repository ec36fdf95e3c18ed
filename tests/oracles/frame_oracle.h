#pragma once

#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/image.h"

namespace pleinair::oracles {

/// An image of plain doubles, coded in [0, 1].
struct Picture {
  hal::FrameSize size;
  std::vector<glm::dvec3> pixels;  ///< row by row

  explicit Picture(hal::FrameSize pictureSize);
  glm::dvec3& at(int x, int y);
  /// The pixel at (x, y), clamped to the border.
  glm::dvec3 clampedAt(int x, int y) const;
  /// Bilinear interpolation between pixel centres, which are at +0.5.
  glm::dvec3 bilinearAt(glm::dvec2 position) const;
};

/// A reference for gpu::FrameUploader, from the texts of BT.601-7 §2.5, BT.709-6 §3 and, for Bayer,
/// the 5×5 kernels of Malvar, He and Cutler (ICASSP 2004, figure 2).
Picture rgbOf(const hal::ImageView& image);

/// gpu::Resampler's formula: the mean of the smallest number of bilinear taps, at most 2 px apart,
/// spread evenly over the area of an output pixel.
Picture resampledByTaps(const Picture& picture, hal::FrameSize size);
/// The exact mean over the area of an output pixel, including fractions of pixels.
Picture resampledByArea(const Picture& picture, hal::FrameSize size);

/// An image in an output's format, as present::Readback documents it.
hal::Image packed(const Picture& picture, hal::FrameFormat format);

}  // namespace pleinair::oracles
