#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "hal/error.h"
#include "pipeline/measure/input/motion_map.h"

namespace pleinair::measure {

/// Kind of motion; it decides which gates apply (docs/measuring.md).
enum class MotionKind {
  kStill,  ///< nothing moves
  kPan,    ///< a constant vector
  kOther,  ///< known, but not one vector: zoom, roll, parallax, occlusion
  kNone,   ///< unknown
};

/// The true motion of a sequence.
class TrueMotion {
 public:
  virtual ~TrueMotion() = default;
  TrueMotion() = default;
  TrueMotion(const TrueMotion&) = delete;
  TrueMotion& operator=(const TrueMotion&) = delete;

  virtual MotionKind kind() const = 0;
  /// For people: "pan by (-1.5, -0.5) px a frame".
  virtual std::string description() const = 0;
  /// The motion from frame `from` to frame `to`; both are counted from the input's first. Errors:
  /// those of its files. Precondition: from < to.
  virtual hal::Result<MotionMap> between(std::uint64_t from, std::uint64_t to) = 0;
};

/// The true masks of movers, the things that move by themselves before the camera of a sequence.
class TrueMovers {
 public:
  virtual ~TrueMovers() = default;
  TrueMovers() = default;
  TrueMovers(const TrueMovers&) = delete;
  TrueMovers& operator=(const TrueMovers&) = delete;

  /// 255 where a frame, counted from the input's first, shows such a thing, also while it rests;
  /// else 0.
  virtual cv::Mat1b mask(std::uint64_t frame) = 0;
};

/// Every point moves by `perFrame` px from each frame to the next.
std::unique_ptr<TrueMotion> constantMotion(cv::Size frame, cv::Point2d perFrame);

/// `frameFromFirst(t)` maps pixels of frame 0 to frame t (pixel centres at whole numbers), in
/// homogeneous coordinates.
std::unique_ptr<TrueMotion> homographyMotion(
    cv::Size frame, std::string description,
    std::function<cv::Matx33d(std::uint64_t)> frameFromFirst);

}  // namespace pleinair::measure
