#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "firmware_app/overlay/step_content.h"
#include "hal/clock.h"
#include "hal/pixel_format.h"
#include "pipeline/overlay/overlay_content.h"
#include "pipeline/scene/description/scene.h"

namespace pleinair::app {

struct ProcedureFilmOptions {
  std::filesystem::path folder;
  std::string language;          ///< empty: the procedure's first
  std::string machine = "auto";  ///< machineIn()
  std::string step;              ///< its id or its number from 1; empty: one after the other
  double secondsPerStep = 4.0;
  bool showsInset = false;  ///< always
};

/// A procedure over a recording: one step, or each for a while, on the way of the good outcomes.
/// One thread.
class ProcedureFilm {
 public:
  /// Loads the procedure and puts its model in its place in the scene, which is changed. Throws
  /// hal::Failure and config::ConfigError.
  ProcedureFilm(ProcedureFilmOptions options, scene::Scene& scene);

  /// The model of the scene that it is about.
  std::size_t machine() const { return machine_; }
  /// What is shown at a time of the recording, for pictures of that size. Equal for all times of a
  /// step.
  std::shared_ptr<const overlay::OverlayContent> at(hal::Duration time, hal::FrameSize output);
  /// The steps in the order they are shown.
  std::size_t steps() const { return steps_.size(); }

 private:
  void findSteps();

  ProcedureFilmOptions options_;
  std::shared_ptr<const procedure::Procedure> procedure_;
  std::shared_ptr<const scene::Model> model_;
  std::size_t machine_ = 0;
  std::vector<StepShown> steps_;
  std::optional<std::size_t> shown_;  // in steps_
  std::shared_ptr<const overlay::OverlayContent> content_;
};

}  // namespace pleinair::app
