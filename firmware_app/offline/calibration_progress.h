#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "pipeline/calibration/view_selection.h"

namespace pleinair::app {

/// The cells of the picture with how many views reach each (. none, o one, O more), beside it what
/// there is and what became of the last picture, below it what to do next. A line each.
std::vector<std::string> coveragePanel(const calibration::ViewSelector& selector,
                                       calibration::ViewOutcome last);

/// Says on standard error how far a calibration is: the panel where that is a terminal, else a line
/// every few seconds where something has changed. One thread.
class CalibrationProgress {
 public:
  explicit CalibrationProgress(const hal::Clock& clock);
  /// After each picture.
  void advance(const calibration::ViewSelector& selector, calibration::ViewOutcome outcome);
  /// Clears the panel, so that something else can be said.
  void interrupt();

 private:
  void draw(const std::vector<std::string>& lines);
  void tell(const calibration::ViewSelector& selector);

  const hal::Clock& clock_;
  hal::TimePoint told_;
  bool isTerminal_;
  std::size_t drawnLines_ = 0;
  std::string lastLine_;
};

}  // namespace pleinair::app
