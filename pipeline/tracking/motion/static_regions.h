#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <opencv2/core.hpp>

#include "pipeline/tracking/motion/image_motion.h"
#include "pipeline/tracking/motion/static_block.h"

namespace pleinair::tracking {

class LumaPyramid;

/// Finds out which fields of a picture stand still, in spite of its noise. Each is compared with
/// how it looked when it came to rest and not with the frame before, so that creeping adds up and
/// is noticed. One thread at a time.
class StaticRegionDetector {
 public:
  /// Takes the next frame, and how most of the picture is known to have moved.
  void update(const LumaPyramid& now, const std::optional<PictureHomography>& picture);
  /// Valid until the next update().
  StaticRegions fields() const { return {.fields = grid_, .errorPx = errors_}; }
  /// Standard deviation of a pixel of the followed picture, levels; the mean of the last second or
  /// so.
  double noise() const { return noise_; }
  /// Whether the field that shows a place of the frame is still, and with what error.
  float errorAt(const glm::dvec2& px, hal::FrameSize size) const;
  /// The next frame is a first one.
  void reset();

 private:
  struct Rest {
    StaticBlock field;
    glm::dvec2 movedPx{0.0};  // smoothed
    int frames = 0;           // since it came to rest
    double variance = 0.0;    // what its pixels vary by, apart from that
    glm::dvec2 alongPx{0.0};  // how far the picture's motion would have taken it since then
    bool hasBegun = false;
    bool isStill = false;
    bool hasChanged = false;  // in this frame
    int waitFrames = 0;       // before it is looked at again
    // What this frame's pixels say of noise, levels²; nothing where negative.
    double temporal = -1.0;
    double spatial = -1.0;
  };

  static bool isDoubtful(const Rest& rest, double noticedPx);
  void resize(const LumaPyramid& now);
  cv::Point corner(std::size_t index, const cv::Size& size) const;
  float look(Rest& rest, const cv::Mat& picture, const cv::Point& corner, double scale);
  void restart(Rest& rest, const cv::Mat& picture, const cv::Point& corner);
  void measureNoise();
  /// Of what fields' pixels say, as many as say something; nothing of too few.
  std::optional<double> percentile(double Rest::*of, double part);

  hal::FrameSize grid_;
  cv::Size size_;
  std::vector<Rest> rests_;
  std::vector<float> errors_;
  std::vector<double> variances_;
  double noise_ = 2.0;
  bool knowsNoise_ = false;
};

}  // namespace pleinair::tracking
