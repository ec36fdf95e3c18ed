#pragma once

#include <cstdint>
#include <string>

#include "hal/error.h"
#include "pipeline/measure/input/motion_map.h"

namespace pleinair::measure {

/// What kind of motion it is, which decides the gates (docs/measuring.md).
enum class MotionKind {
  kStill,  ///< nothing moves
  kPan,    ///< a constant vector
  kOther,  ///< known, but not one vector: zoom, roll, parallax, what moves before what
  kNone,   ///< not known
};

/// How a sequence truly moves.
class TrueMotion {
 public:
  virtual ~TrueMotion() = default;
  TrueMotion() = default;
  TrueMotion(const TrueMotion&) = delete;
  TrueMotion& operator=(const TrueMotion&) = delete;

  virtual MotionKind kind() const = 0;
  /// For people: "pan by (-1.5, -0.5) px a frame".
  virtual std::string description() const = 0;
  /// How what is seen in frame `from` has moved to frame `to`; both counted from the input's first.
  /// Errors: of files that it is read from. Precondition: from < to.
  virtual hal::Result<MotionMap> between(std::uint64_t from, std::uint64_t to) = 0;
};

}  // namespace pleinair::measure
