#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "hal/image.h"

namespace pleinair::tracking {

/// A mean colour: luma and chroma (BT.601, full range, chroma about 0) in 8-bit levels.
struct CellColour {
  float luma = 0.0F;
  float cb = 0.0F;
  float cr = 0.0F;
};

/// How different two colours are, roughly as they are perceived: the weighted length of
/// marks/shaders/colour_difference.glsl, in levels (1.7 for a difference of one level of grey).
inline float distanceOf(const CellColour& a, const CellColour& b) {
  const float luma = a.luma - b.luma;
  const float cb = a.cb - b.cb;
  const float cr = a.cr - b.cr;
  return std::sqrt(3.0F * luma * luma + 2.2F * cb * cb + 2.3F * cr * cr);
}

/// Reduces images of any format to the mean colours of a grid's cells, without converting them
/// first. Keeps its buffers. One thread at a time.
class CellColours {
 public:
  /// Preconditions: image.isComplete(); the grid has no more cells than the image has px, either
  /// way.
  void reduce(const hal::ImageView& image, hal::FrameSize grid);
  /// Row by row; valid until the next call.
  const std::vector<CellColour>& colours() const { return colours_; }

 private:
  cv::Mat reducedPlane(int plane, const hal::ImageView& image, int channels, cv::Size size,
                       int firstRow = 0, int rowStep = 1);

  hal::FrameSize grid_;
  std::vector<cv::Mat> reduced_;
  std::vector<CellColour> colours_;
};

}  // namespace pleinair::tracking
