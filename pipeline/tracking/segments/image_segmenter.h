#pragma once

#include <memory>

#include "hal/image.h"
#include "pipeline/tracking/motion/image_motion.h"
#include "pipeline/tracking/segments/image_segments.h"

namespace pleinair::tracking {

/// Segments a camera image by its colours, on a coarse grid, and follows the segments (thesis
/// §6.2). Each frame is segmented anew, but the labels of the previous frame, carried along the
/// image motion, bias all decisions (SegmentMerger), and a segment takes the label that most of it
/// had. While the camera stands, a cell's colour is held until it changes by more than noise: a
/// still scene gives the same segments to the bit, and takes no time.
///
/// Costs a few milliseconds of one core, which hardly depends on the image's size or content. Keeps
/// its buffers from frame to frame; in steady state only OpenCV allocates. One thread at a time.
class ImageSegmenter {
 public:
  ImageSegmenter();
  ~ImageSegmenter();
  ImageSegmenter(const ImageSegmenter&) = delete;
  ImageSegmenter& operator=(const ImageSegmenter&) = delete;
  ImageSegmenter(ImageSegmenter&&) = delete;
  ImageSegmenter& operator=(ImageSegmenter&&) = delete;

  /// Takes the next frame and the motion that was measured in it. A cut, or another size, begins
  /// anew. Precondition: image.isComplete(). The result is valid until the next call.
  const ImageSegments& follow(const hal::ImageView& image, const ImageMotion& motion);
  /// Treats the next frame as the first one.
  void reset();

  /// Cells along the longer side of the grid, at most.
  static constexpr int kLongSide = 160;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pleinair::tracking
