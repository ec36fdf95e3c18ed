#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/image.h"
#include "pipeline/scene/models/linear_light.h"

namespace pleinair::scene {

/// Reads single pixels of an image of any format as linear light in [0, 1], without converting the
/// rest. Assumes sRGB coding. A pixel of a mosaic is its 2 × 2 cell; chroma is that of the sample's
/// pixels. Refers to the image's memory.
class LinearImage {
 public:
  /// Precondition: image.isComplete().
  explicit LinearImage(const hal::ImageView& image);

  hal::FrameSize size() const { return image_.format.size; }
  /// Precondition: (x, y) lies within the image.
  glm::vec3 at(int x, int y) const;

 private:
  const std::uint8_t& byte(int plane, int x, int y) const;
  glm::vec3 fromYcbcr(int luma, int cb, int cr) const;
  glm::vec3 mosaicAt(int x, int y) const;

  hal::ImageView image_;
  glm::mat3 rgbFromYcbcr_{1.0F};
  glm::vec3 ycbcrOffset_{0.0F};
};

/// Statistics of an image's light, from 1200 pixels spread over it.
struct ImageStatistics {
  glm::dvec3 mean{0.0};  ///< linear RGB, above 0
  /// Gradient towards the brighter side: doublings of luminance from the centre to the edge, x
  /// right, y down.
  glm::dvec2 slope{0.0};
  double explained = 0.0;  ///< part of the brightness's variance that the slope explains: 0 … 1
};

ImageStatistics imageStatistics(const LinearImage& picture);

}  // namespace pleinair::scene
