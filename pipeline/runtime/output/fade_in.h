#pragma once

#include <memory>
#include <optional>

#include "hal/clock.h"
#include "hal/image.h"

namespace pleinair::runtime {

/// Lets the frames of an output appear over the picture that it showed before. One thread.
class FadeIn {
 public:
  static constexpr hal::Duration kDuration = std::chrono::milliseconds(700);

  /// From the next frame on. `from`: RGBA8, shown until then.
  void begin(std::shared_ptr<const hal::Image> from) {
    from_ = std::move(from);
    firstDue_.reset();
  }
  void end() { from_.reset(); }
  bool isOn() const { return from_ != nullptr; }

  /// Blends the picture into a frame of its format that is due at `due`, by how much of the time
  /// has passed since the first frame; with rising due times its share falls. Later frames, and
  /// those of another format, stay as they are to the bit, which ends it. Returns whether the frame
  /// is as it was.
  bool apply(hal::Image& frame, hal::TimePoint due);

 private:
  std::shared_ptr<const hal::Image> from_;
  std::optional<hal::TimePoint> firstDue_;
};

}  // namespace pleinair::runtime
