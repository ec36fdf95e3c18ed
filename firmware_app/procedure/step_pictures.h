#pragma once

#include <cstddef>
#include <memory>
#include <set>

#include "hal/image.h"
#include "pipeline/procedure/procedure.h"

namespace pleinair::app {

/// Draws steps of a procedure without a camera: the model as it is at the step, with the step's
/// parts in focus, from the side that shows them best. Makes a GL context; one thread.
class StepPictures {
 public:
  /// `procedure` outlives this. Throws hal::Failure without a GPU.
  /// `drawsAxes`: also those of the first part of each step.
  StepPictures(const procedure::Procedure& procedure, hal::FrameSize size, bool drawsAxes = false);
  ~StepPictures();
  StepPictures(const StepPictures&) = delete;
  StepPictures& operator=(const StepPictures&) = delete;

  /// RGB8. `off`: parts that are off when the step begins. Throws hal::Failure for a lost GPU.
  hal::Image draw(std::size_t step, const std::set<std::size_t>& off);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pleinair::app
