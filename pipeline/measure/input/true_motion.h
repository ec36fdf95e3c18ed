#pragma once

#include <cstdint>
#include <string>

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

}  // namespace pleinair::measure
